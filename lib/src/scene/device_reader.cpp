#include "scene/device_reader.h"

#include "scene/values.h"

namespace palpate {

DeviceMapping readDevice(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'device'");
  DeviceMapping device;
  if (reader.optional("offset") != nullptr) device.offset = reader.requirePoint("offset");
  if (const Node* rotate = reader.optional("rotate"))
    device.rotation = readRotation(loader, *rotate);
  device.scale = reader.numberOr("scale", 1.0);
  device.force = reader.numberOr("force", 1.0);
  for (const auto& [key, value] : {std::pair("scale", device.scale), {"force", device.force}}) {
    if (value > 0.0) continue;
    throw reader.errorAt(key, "scene.range", "'" + std::string(key) + "' must be more than 0");
  }
  device.clutch = reader.boolOr("clutch", false);
  if (const Node* workspace = reader.optional("workspace")) {
    device.workspace = loader.field(*workspace)->get()->bounds();
    if (!device.workspace.isBounded()) {
      throw reader.errorAt("workspace", "scene.range", "'workspace' has no end",
                           "give a box or a sphere, in the device's own coordinates");
    }
  }
  reader.finish();
  return device;
}

}  // namespace palpate
