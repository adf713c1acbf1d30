#include "scene/device_reader.h"

#include "scene/values.h"

namespace palpate {
namespace {

std::optional<double> given(const MapReader& reader, std::string_view key) {
  if (!reader.has(key)) return std::nullopt;
  return reader.value(key);
}

PassivityRequest readPassivity(const MapReader& reader) {
  PassivityRequest passivity;
  passivity.controls = reader.flag("control");
  passivity.mass = given(reader, "mass");
  passivity.damping = given(reader, "damping");
  passivity.friction = given(reader, "friction");
  passivity.encoder = given(reader, "encoder");
  passivity.hand_force = given(reader, "hand_force");
  return passivity;
}

CouplingRequest readCoupling(const MapReader& reader) {
  CouplingRequest coupling;
  coupling.stiffness = given(reader, "stiffness");
  if (reader.has("damping") && !coupling.stiffness) {
    throw reader.errorAt("damping", "scene.coupling", "'damping' needs a 'stiffness' beside it",
                         "give both; or neither, and the coupling is designed for the device");
  }
  if (reader.has("for") && coupling.stiffness) {
    throw reader.errorAt(
        "for", "scene.coupling",
        "'for' and 'stiffness' cannot be used together: a coupling whose stiffness is "
        "given is not designed",
        "leave out one of the two");
  }
  coupling.damping = reader.value("damping");
  if (reader.choice("for") == 1) coupling.design = CouplingRequest::For::kAnyScene;
  return coupling;
}

}  // namespace

DeviceMapping readDevice(const MapReader& reader) {
  DeviceMapping device;
  device.offset = reader.point("offset");
  if (reader.has("rotate")) device.rotation = readRotation(reader.map("rotate"));
  device.scale = reader.value("scale");
  device.force = reader.value("force");
  device.clutch = reader.flag("clutch");
  if (const Node* workspace = reader.find("workspace")) {
    device.workspace = reader.loader().field(*workspace)->get()->bounds();
    if (!device.workspace.isBounded()) {
      throw reader.errorAt("workspace", "scene.range", "'workspace' reaches to infinity",
                           "give a box or a sphere, in the device's own coordinates");
    }
  }
  if (reader.has("passivity")) device.passivity = readPassivity(reader.map("passivity"));
  if (reader.has("coupling")) device.coupling = readCoupling(reader.map("coupling"));
  return device;
}

}  // namespace palpate
