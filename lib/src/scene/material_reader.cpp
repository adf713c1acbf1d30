#include "scene/material_reader.h"

#include "scene/messages.h"
#include "scene/parameter_reader.h"
#include "scene/shape_reader.h"
#include "scene/tissue_reader.h"
#include "scene/values.h"

namespace palpate {
namespace {

Friction readFriction(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'friction'");
  Friction friction;
  friction.static_ratio = requireParameter(reader, "static", {});
  friction.kinetic_ratio = readParameter(reader, "kinetic", {}, friction.static_ratio);
  reader.finish();
  const MaterialMap::Range held = friction.static_ratio.range();
  const MaterialMap::Range slides = friction.kinetic_ratio.range();
  if (slides.most > held.most || slides.least > held.least) {
    throw reader.errorAt("kinetic", "scene.range", "'kinetic' must not be more than 'static'",
                         "what slides is held less than what sticks");
  }
  return friction;
}

Texture readTexture(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'texture'");
  const Parameter amplitude = requireParameter(reader, "amplitude", Dimension::kLength);
  if (!(amplitude.range().most > 0.0)) {
    throw reader.errorAt("amplitude", "scene.range", "'amplitude' must be more than 0");
  }
  const double wavelength = positiveLength(reader, "wavelength");
  reader.finish();
  const double highest = Texture::highestAmplitude(wavelength);
  if (amplitude.range().most > highest) {
    throw reader.errorAt(
        "amplitude", "scene.range",
        "'amplitude' must not be more than 'wavelength' / 2 pi, here " + inUnitOf(loader, highest),
        "steeper bumps push harder than the wall's own stiffness; make them lower "
        "or longer");
  }
  return {amplitude, wavelength};
}

Composite readComposite(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'composite'");
  Composite composite;
  composite.radius = positiveLength(reader, "radius");
  composite.depth = positiveLength(reader, "depth");
  reader.finish();
  return composite;
}

Material readMaterial(const SceneLoader& loader, const Node::Entry& entry) {
  const Document& document = loader.document();
  MapReader reader(loader, entry.value, "the material " + inQuotes(entry.key));
  Material material;
  material.name = entry.key;
  material.stiffness = readParameter(reader, "stiffness", Dimension::kStiffness, {});
  material.damping = readParameter(reader, "damping", Dimension::kDamping, {});
  if (const Node* friction = reader.optional("friction")) {
    material.friction = readFriction(loader, *friction);
  }
  if (const Node* texture = reader.optional("texture")) {
    material.texture = readTexture(loader, *texture);
  }
  if (const Node* composite = reader.optional("composite")) {
    material.composite = readComposite(loader, *composite);
  }
  material.shading = reader.lengthOr("shading", 0.0);
  if (material.shading < 0.0) {
    throw reader.errorAt("shading", "scene.range", "'shading' must be 0 or more");
  }
  material.viscosity = readParameter(reader, "viscosity", Dimension::kDamping, {});
  if (const Node* flow = reader.optional("flow")) {
    const auto& items = readList(document, *flow, "'flow'", 3, 3);
    material.flow = {readVelocity(loader, items[0], "flow"), readVelocity(loader, items[1], "flow"),
                     readVelocity(loader, items[2], "flow")};
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
