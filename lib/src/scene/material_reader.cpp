#include "scene/material_reader.h"

#include "scene/messages.h"
#include "scene/parameter_reader.h"
#include "scene/shape_reader.h"
#include "scene/tissue_reader.h"
#include "scene/values.h"

namespace palpate {
namespace {

Texture readTexture(const MapReader& reader) {
  const Parameter amplitude = readParameter(reader, "amplitude");
  const double wavelength = reader.value("wavelength");
  const double highest = Texture::highestAmplitude(wavelength);
  if (amplitude.range().most > highest) {
    throw reader.errorAt("amplitude", "scene.range",
                         "'amplitude' must not be more than 'wavelength' / 2 pi, here " +
                             inUnitOf(reader.loader(), highest),
                         "steeper bumps would be stiffer than the wall; make them lower or longer");
  }
  return {amplitude, wavelength};
}

Material readMaterial(const SceneLoader& loader, const Node::Entry& entry) {
  const MapReader reader(loader, entry.value, "the material " + inQuotes(entry.key), "material");
  Material material;
  material.name = entry.key;
  material.stiffness = readParameter(reader, "stiffness");
  material.damping = readParameter(reader, "damping");
  if (reader.has("friction")) {
    std::tie(material.friction.static_ratio, material.friction.kinetic_ratio) =
        readFriction(reader.map("friction"));
  }
  if (reader.has("texture")) material.texture = readTexture(reader.map("texture"));
  if (reader.has("composite")) {
    const MapReader composite = reader.map("composite");
    material.composite = {composite.value("radius"), composite.value("depth")};
  }
  material.shading = reader.value("shading");
  material.viscosity = readParameter(reader, "viscosity");
  material.flow = readFlow(reader, "flow");
  readTissue(reader, material);
  return material;
}

}  // namespace

std::vector<Material> readMaterials(const SceneLoader& loader, const Node& materials) {
  const Document& document = loader.document();
  std::vector<Material> all;
  for (const Node::Entry& entry : materials.entries) {
    refuseEmpty(document, entry);
    if (entry.key == "absent") {
      throw document.error(entry.key_mark, "scene.name", "a material cannot be called 'absent'",
                           "wall: absent means no wall");
    }
    all.push_back(readMaterial(loader, entry));
  }
  return all;
}

}  // namespace palpate
