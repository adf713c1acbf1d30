#include "scene/device_reader.h"

#include "scene/values.h"

namespace palpate {

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
      throw reader.errorAt("workspace", "scene.range", "'workspace' has no end",
                           "give a box or a sphere, in the device's own coordinates");
    }
  }
  return device;
}

}  // namespace palpate
