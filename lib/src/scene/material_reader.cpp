#include "scene/material_reader.h"

#include "scene/messages.h"
#include "scene/shape_reader.h"
#include "scene/tissue_reader.h"
#include "scene/values.h"

namespace palpate {
namespace {

double notNegative(MapReader& reader, std::string_view key, Dimension dimension) {
  const double value = reader.quantityOr(key, dimension, 0.0);
  if (value < 0.0) throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be 0 or more");
  return value;
}

Friction readFriction(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'friction'");
  const double held = reader.requireNumber("static");
  const double slides = reader.numberOr("kinetic", held);
  reader.finish();
  if (held < 0.0) {
    throw reader.errorAt("static", "scene.range", "'static' must be 0 or more");
  }
  if (slides < 0.0) {
    throw reader.errorAt("kinetic", "scene.range", "'kinetic' must be 0 or more");
  }
  if (slides > held) {
    throw reader.errorAt("kinetic", "scene.range", "'kinetic' must not be more than 'static'",
                         "what slides is held less than what sticks");
  }
  return {held, slides};
}

Texture readTexture(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'texture'");
  const double amplitude = positiveLength(reader, "amplitude");
  const double wavelength = positiveLength(reader, "wavelength");
  reader.finish();
  const double highest = Texture::highestAmplitude(wavelength);
  if (amplitude > highest) {
    throw reader.errorAt(
        "amplitude", "scene.range",
        "'amplitude' must not be more than 'wavelength' / 2 pi, here " + inUnitOf(loader, highest),
        "steeper bumps push harder than the wall's own stiffness; make them lower "
        "or longer");
  }
  return {amplitude, wavelength};
}

Material readMaterial(const SceneLoader& loader, const Node::Entry& entry) {
  const Document& document = loader.document();
  MapReader reader(loader, entry.value, "the material " + inQuotes(entry.key));
  Material material;
  material.name = entry.key;
  material.stiffness = notNegative(reader, "stiffness", Dimension::kStiffness);
  material.damping = notNegative(reader, "damping", Dimension::kDamping);
  if (const Node* friction = reader.optional("friction")) {
    material.friction = readFriction(loader, *friction);
  }
  if (const Node* texture = reader.optional("texture")) {
    material.texture = readTexture(loader, *texture);
  }
  material.shading = reader.lengthOr("shading", 0.0);
  if (material.shading < 0.0) {
    throw reader.errorAt("shading", "scene.range", "'shading' must be 0 or more");
  }
  material.viscosity = notNegative(reader, "viscosity", Dimension::kDamping);
  if (const Node* flow = reader.optional("flow")) {
    const auto& items = readList(document, *flow, "'flow'", 3, 3);
    for (int i = 0; i < 3; ++i) {
      material.flow[i] = readQuantity(document, items[static_cast<std::size_t>(i)],
                                      Dimension::kVelocity, "a component of 'flow'");
    }
  }
  readTissue(reader, material);
  reader.finish();
  return material;
}

}  // namespace

std::vector<Material> readMaterials(const SceneLoader& loader, const Node& materials) {
  const Document& document = loader.document();
  requireMap(document, materials, "'materials'");
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
