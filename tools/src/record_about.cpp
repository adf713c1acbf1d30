#include "record_about.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <type_traits>

#include "palpate/core/error.h"
#include "palpate/devices/record.h"
#include "palpate/version.h"
#include "report.h"
#include "scene_hash.h"

namespace palpate::tools {
namespace {

constexpr const char* kSchema = "palpate.record/1";

Error badAbout(const std::string& message, const std::string& file) {
  return inputError("record.about", message,
                    "a record is three files that go together: FILE.npy, FILE.npy.json and "
                    "FILE.npy.states",
                    file);
}

/// Takes values from an object, and reports which one is wrong.
class Values {
 public:
  Values(const Json& object, std::string file) : object_(&object), file_(std::move(file)) {}

  void take(const char* key, std::string& out) const {
    if (const Json* value = find(key, &Json::is_string)) out = value->get<std::string>();
  }
  void take(const char* key, bool& out) const {
    if (const Json* value = find(key, &Json::is_boolean)) out = value->get<bool>();
  }
  void take(const char* key, double& out) const {
    if (const Json* value = find(key, &Json::is_number)) out = value->get<double>();
  }
  void take(const char* key, std::uint64_t& out) const {
    if (const Json* value = find(key, &Json::is_number_unsigned)) out = value->get<std::uint64_t>();
  }
  void take(const char* key, devices::DeviceFrame& out) const {
    std::string frame;
    take(key, frame);
    if (frame != "device" && frame != "world") throw bad(key);
    out = frame == "device" ? devices::DeviceFrame::kDevice : devices::DeviceFrame::kWorld;
  }
  void take(const char* key, std::optional<double>& out) const {
    if (isNull(key)) return;
    out.emplace();
    take(key, *out);
  }
  void take(const char* key, std::optional<int>& out) const {
    if (isNull(key)) return;
    double number = 0.0;
    take(key, number);
    constexpr double kMost = 1e6;
    if (!(std::fabs(number) <= kMost) || number != std::floor(number)) throw bad(key);
    out = static_cast<int>(number);
  }
  void take(const char* key, std::vector<std::string>& out) const {
    const Json* list = find(key, &Json::is_array);
    for (const Json& item : *list) {
      if (!item.is_string()) throw bad(key);
      out.push_back(item.get<std::string>());
    }
  }
  [[nodiscard]] bool has(const std::string& key) const { return object_->contains(key); }
  [[nodiscard]] Values part(const std::string& key) const {
    return {*find(key, &Json::is_object), file_};
  }
  [[nodiscard]] Error bad(const std::string& key) const {
    return badAbout("'" + key + "' is missing, or has a value that it cannot have", file_);
  }

 private:
  using Is = bool (Json::*)() const noexcept;
  [[nodiscard]] const Json* find(const std::string& key, Is is) const {
    const auto at = object_->find(key);
    if (at == object_->end() || !((*at).*is)()) throw bad(key);
    return &*at;
  }
  [[nodiscard]] bool isNull(const char* key) const {
    const auto at = object_->find(key);
    return at != object_->end() && at->is_null();
  }

  const Json* object_;
  std::string file_;
};

/// Calls `visit` with section ("" for the object itself), key and value for each member in a
/// record's file, so that writing and reading use the same names.
template <typename About, typename Visit>
void eachValue(About& about, const Visit& visit) {
  visit("", "version", about.version);
  visit("", "build", about.build);
  visit("", "scene", about.scene);
  visit("", "scene_text", about.scene_text);
  visit("", "scene_hash", about.scene_hash);
  visit("", "shows_all", about.shows_all);
  visit("", "renderer", about.renderer);
  visit("", "rate_Hz", about.rate);
  visit("", "realtime", about.realtime);
  visit("", "period_s", about.period);
  visit("", "states_every", about.states_every);
  visit("device", "name", about.device);
  visit("device", "frame", about.frame);
  visit("device", "max_force_N", about.max_force);
  auto& options = about.options;
  visit("options", "epsilon", options.epsilon);
  visit("options", "halvings", options.halvings);
  visit("options", "alpha", options.alpha);
  visit("options", "alpha_form", options.alpha_form);
  visit("options", "interior", options.interior);
  visit("options", "max_force", options.max_force);
  visit("options", "slew", options.slew);
  visit("options", "ramp", options.ramp);
  visit("options", "set", options.set);
  visit("options", "device", options.device.name);
  visit("options", "hand", options.device.hand);
  visit("options", "delay", options.device.delay);
  visit("options", "passivity", options.passivity);
  visit("options", "hand_force", options.hand_force);
  visit("options", "coupling", options.coupling);
  visit("", "regions", about.regions);
  visit("", "ports", about.ports);
}

/// Options that did not exist in records of version 0.1.
bool isLater(std::string_view key) {
  constexpr std::string_view kLater[] = {"device",    "hand",       "delay",
                                         "passivity", "hand_force", "coupling"};
  return std::find(std::begin(kLater), std::end(kLater), key) != std::end(kLater);
}

template <typename Value>
Json jsonOf(const Value& value) {
  return value;
}
template <typename Value>
Json jsonOf(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}
Json jsonOf(devices::DeviceFrame frame) {
  return frame == devices::DeviceFrame::kDevice ? "device" : "world";
}

/// Refuses what the command line would refuse; quantities are parsed later, for the scene that they
/// belong to.
void checkOptions(const TouchOptions& options, const Values& all) {
  const auto need = [&](bool may_be, const char* key) {
    if (!may_be) throw all.bad(key);
  };
  const auto is_one_of = [](const std::string& word, std::initializer_list<const char*> words) {
    return word.empty() || std::find(words.begin(), words.end(), word) != words.end();
  };
  const int halvings = options.halvings.value_or(1);
  const double alpha = options.alpha.value_or(0.0);
  need(halvings >= 1 && halvings <= 1000, "halvings");
  need(alpha >= 0.0 && alpha <= 1e6, "alpha");
  need(is_one_of(options.alpha_form, {"by_field", "printed", "newton"}), "alpha_form");
  need(is_one_of(options.interior, {"together", "wall"}), "interior");
  need(is_one_of(options.passivity, {"observe", "control"}), "passivity");
}

}  // namespace

void describe(RecordAbout& about, const TouchOptions& options, const devices::DeviceInfo& device,
              const Scene& scene, const std::string& scene_text) {
  about.version = PALPATE_VERSION_STRING;
  about.build = devices::stateBuild();
  about.scene = std::filesystem::absolute(options.scene).string();
  about.scene_text = scene_text;
  about.scene_hash = sceneHash(options.scene, scene_text);
  about.device = device.name;
  about.frame = device.frame;
  about.max_force = device.max_force;
  about.rate = options.rate;
  about.realtime = options.realtime;
  about.states_every = static_cast<std::uint64_t>(options.states);
  about.options = options;
  for (const Region& region : scene.regions()) about.regions.push_back(region.name);
  for (const Port& port : scene.ports()) about.ports.push_back(port.name);
}

std::string aboutFile(const std::string& record) { return record + ".json"; }
std::string statesFile(const std::string& record) { return record + ".states"; }

std::string aboutText(const RecordAbout& about) {
  Json json = {{"schema", kSchema}, {"seed", nullptr}};
  eachValue(about, [&](const std::string& section, const char* key, const auto& value) {
    Json& object = section.empty() ? json : json[section];
    object[key] = jsonOf(value);
  });
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ReadAbout readAbout(const std::string& record) {
  const std::string file = aboutFile(record);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw badAbout("there is no such file, or it cannot be read", file);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  ReadAbout out{.about = {}, .text = bytes.str()};
  const Json json = Json::parse(out.text, nullptr, false);
  if (!json.is_object() || json.value("schema", Json()) != Json(kSchema)) {
    throw badAbout("this is not the description (FILE.npy.json) of a record", file);
  }
  RecordAbout& about = out.about;
  const Values all(json, file);
  eachValue(about, [&](const std::string& section, const char* key, auto& value) {
    const Values part = section.empty() ? all : all.part(section);
    if (section == "options" && isLater(key) && !part.has(key)) return;
    part.take(key, value);
  });
  if (about.renderer != "paper" && about.renderer != "constraint") throw all.bad("renderer");
  if (!(about.rate >= 1.0 && about.rate <= 1e5)) throw all.bad("rate_Hz");
  if (!(about.period > 0.0)) throw all.bad("period_s");
  checkOptions(about.options, all);
  about.options.renderer = about.renderer;
  return out;
}

}  // namespace palpate::tools
