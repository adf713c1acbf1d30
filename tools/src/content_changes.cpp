#include "content_changes.h"

#include <algorithm>
#include <string_view>

#include "json_parts.h"
#include "palpate/core/error.h"
#include "palpate/render/contents.h"
#include "palpate/scene/scene_file.h"
#include "palpate/scene/suggestion.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr const char* kOption = "--set";
constexpr std::string_view kKeys[] = {"viscosity", "flow", "lattice.force", "cutting"};

Error usageError(const std::string& text, const std::string& why) {
  return Error(ErrorKind::kUsage,
               {"usage.set", std::string(kOption) + ": '" + text + "' " + why,
                "write MATERIAL.KEY=VALUE@TIME, as in 'syrup.viscosity=9 N.s/m@0.5s'; KEY is "
                "viscosity, flow, lattice.force or cutting"});
}

/// "X,Y,Z", each a velocity.
Vec3 readFlow(std::string_view text, const std::string& whole) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) throw usageError(whole, "gives a flow that is not three velocities");
  Vec3 flow(0.0);
  for (int i = 0; i < 3; ++i) {
    flow[i] = parseSpeed(parts[static_cast<std::size_t>(i)], {"m", 1.0}, kOption);
  }
  return flow;
}

ContentSetting readSetting(const std::string& text) {
  const auto equals = text.find('=');
  const auto at = text.rfind('@');
  if (equals == std::string::npos || at == std::string::npos || at < equals) {
    throw usageError(text, "does not have the form MATERIAL.KEY=VALUE@TIME");
  }
  const std::string_view what(text.data(), equals);
  const std::string_view value(text.data() + equals + 1, at - equals - 1);
  ContentSetting setting;
  for (const std::string_view key : kKeys) {
    const std::string end = "." + std::string(key);
    if (what.size() <= end.size() || !what.ends_with(end)) continue;
    setting.material = what.substr(0, what.size() - end.size());
    setting.key = key;
  }
  if (setting.key.empty()) throw usageError(text, "names a key that cannot change");
  if (setting.key == "viscosity") {
    setting.number = parseDamping(value, kOption);
  } else if (setting.key == "flow") {
    setting.velocity = readFlow(value, text);
  } else {
    setting.number = parseForce(value, kOption);
  }
  setting.time = parseTime(std::string_view(text).substr(at + 1), kOption);
  if (setting.time < 0.0) throw usageError(text, "is set before the motion begins");
  return setting;
}

void apply(const ContentSetting& setting, ContentChange& change) {
  if (setting.key == "viscosity") change.viscosity = setting.number;
  if (setting.key == "flow") change.flow = setting.velocity;
  if (setting.key == "lattice.force") change.lattice_force = setting.number;
  if (setting.key == "cutting") change.cutting = setting.number;
}

Error unknownContent(const std::string& name, const Scene& scene) {
  std::vector<std::string_view> names;
  bool is_material = false;
  for (const Region& region : scene.regions()) {
    if (region.content >= 0) {
      names.push_back(scene.materials()[static_cast<std::size_t>(region.content)].name);
    }
  }
  for (const Material& material : scene.materials()) is_material |= material.name == name;
  return inputError(
      "set.unknown_content",
      std::string(kOption) + ": " +
          (is_material ? "no region is filled with the material '" + name + "'"
                       : "the scene has no material '" + name + "'"),
      suggestionFor(name, names, "name the content of a layer; `palpate explain` lists them"));
}

std::string rangeOf(const ContentSetting& setting) {
  if (setting.key == "lattice.force") {
    return "a force from 0 to stiffness times the shortest wavelength / 2 pi, in a material with "
           "a lattice";
  }
  if (setting.key == "cutting") return "0 N, or more in a material with a stiffness";
  return setting.key == "flow" ? "three velocities" : "0 N.s/m or more";
}

}  // namespace

std::vector<ContentSetting> readSettings(const std::vector<std::string>& texts) {
  std::vector<ContentSetting> settings;
  for (const std::string& text : texts) settings.push_back(readSetting(text));
  std::stable_sort(settings.begin(), settings.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  return settings;
}

std::vector<devices::ContentEvent> contentEvents(const std::vector<ContentSetting>& settings,
                                                 const Scene& scene, double end) {
  std::vector<devices::ContentEvent> events;
  std::vector<ContentChange> now(scene.regions().size());
  Contents tried(scene);
  for (const ContentSetting& setting : settings) {
    bool is_content = false;
    for (std::size_t i = 0; i < scene.regions().size(); ++i) {
      const Material* content = tried.material(static_cast<RegionId>(i));
      if (content == nullptr || content->name != setting.material) continue;
      is_content = true;
      apply(setting, now[i]);
      if (!tried.change(static_cast<RegionId>(i), now[i])) {
        throw inputError("set.range",
                         std::string(kOption) + ": " + setting.material + "." + setting.key +
                             " cannot be " + formatNumber(setting.number),
                         "it may be " + rangeOf(setting));
      }
      events.push_back({setting.time, static_cast<RegionId>(i), now[i]});
    }
    if (!is_content) throw unknownContent(setting.material, scene);
    if (setting.time > end) {
      throw inputError("set.time",
                       std::string(kOption) + ": " + setting.material + "." + setting.key +
                           " would change at " + formatSeconds(setting.time) +
                           ", and the motion ends at " + formatSeconds(end),
                       "set it earlier, or make the motion longer");
    }
  }
  return events;
}

Json settingsJson(const std::vector<ContentSetting>& settings) {
  Json all = Json::array();
  for (const ContentSetting& setting : settings) {
    all.push_back(
        {{"material", setting.material},
         {"key", setting.key},
         {"value", setting.key == "flow" ? vectorJson(setting.velocity) : Json(setting.number)},
         {"t", setting.time}});
  }
  return all;
}

}  // namespace palpate::tools
