#ifdef PALPATE_INVERSE3

#include "inverse3/inverse3_messages.h"

#include <nlohmann/json.hpp>

namespace palpate::devices::inverse3 {
namespace {

using Json = nlohmann::json;

const Json* member(const Json& in, const char* name) {
  if (!in.is_object()) return nullptr;
  const auto at = in.find(name);
  return at == in.end() ? nullptr : &*at;
}

bool readVector(const Json* in, Vec3& out) {
  if (in == nullptr) return false;
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const Json* value = member(*in, kAxes[i]);
    if (value == nullptr || !value->is_number()) return false;
    out[i] = value->get<double>();
  }
  return true;
}

std::string idOf(const Json& device) {
  const Json* id = member(device, "device_id");
  if (id == nullptr) return "";
  return id->is_string() ? id->get<std::string>() : id->dump();
}

}  // namespace

std::optional<Message> readMessage(std::string_view text, const std::string& id) {
  const Json all = Json::parse(text, nullptr, false);
  const Json* devices = member(all, "inverse3");
  if (devices == nullptr || !devices->is_array()) return std::nullopt;
  for (const Json& device : *devices) {
    Message out;
    out.id = idOf(device);
    if (!id.empty() && out.id != id) continue;
    const Json* state = member(device, "state");
    if (state == nullptr || !readVector(member(*state, "cursor_position"), out.state.position)) {
      return std::nullopt;
    }
    (void)readVector(member(*state, "cursor_velocity"), out.state.velocity);
    return out;
  }
  return std::nullopt;
}

std::string forceMessage(const std::string& id, const Vec3& force) {
  const Json vector = {{"x", force.x}, {"y", force.y}, {"z", force.z}};
  const Json command = {{"set_cursor_force", {{"vector", vector}}}};
  const Json device = {{"device_id", id}, {"commands", command}};
  return Json{{"inverse3", Json::array({device})}}.dump();
}

}  // namespace palpate::devices::inverse3

#endif
