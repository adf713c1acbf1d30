#include "material_checks.h"

#include <cmath>

#include "scene_compiler.h"

namespace palpate {
namespace {

/// A parameter must be a number, and not negative, wherever the hand may come.
void checkParameter(const Parameter& parameter, const std::string& name, const std::string& of) {
  const MaterialMap::Range range = parameter.range();
  if (range.least >= 0.0 && range.least <= range.most && std::isfinite(range.most)) return;
  throw inputError("scene.parameter",
                   "the " + name + " of " + of + " is negative or not finite somewhere",
                   "it must be finite and 0 or more everywhere");
}

void checkTexture(const Material& material) {
  const Texture& texture = material.texture;
  const MaterialMap::Range amplitude = texture.amplitude.range();
  if (amplitude.least == 0.0 && amplitude.most == 0.0) return;
  if (amplitude.least >= 0.0 && amplitude.least <= amplitude.most &&
      amplitude.most <= Texture::highestAmplitude(texture.wavelength)) {
    return;
  }
  throw inputError("scene.texture",
                   "the texture of material " + inQuotes(material.name) + " is too high",
                   "its amplitude must be from 0 to its wavelength / 2 pi");
}

void checkTissue(const Material& material, const std::string& of) {
  const auto refuse = [&](bool is_wrong, const char* what, const char* hint) {
    if (is_wrong) throw inputError("scene.parameter", of + ": " + what, hint);
  };
  const SpringCurve& curve = material.curve;
  checkParameter(curve.stiffening, "stiffening", of);
  refuse(!(curve.exponent >= 1.0 && curve.exponent <= SpringCurve::kHighestExponent),
         "the exponent of its curve is out of range", "it must be from 1 to 4");
  refuse(!(curve.reference > 0.0 && std::isfinite(curve.reference)),
         "the reference depth of its curve is out of range", "it must be more than 0");
  checkParameter(material.maxwell.stiffness, "Maxwell stiffness", of);
  refuse(material.maxwell.stiffness.range().most > 0.0 &&
             !(material.maxwell.time > 0.0 && std::isfinite(material.maxwell.time)),
         "the time of its Maxwell branch is out of range", "it must be more than 0");

  const double stiffness = material.stiffness.range().least;
  const Lattice& lattice = material.lattice;
  checkParameter(lattice.force, "lattice force", of);
  const Vec3& waves = lattice.wavelength;
  refuse(!isFinite(waves) || !isFinite(lattice.origin) || waves.x < 0.0 || waves.y < 0.0 ||
             waves.z < 0.0,
         "the wavelengths or the origin of its lattice are not valid",
         "the wavelengths must be finite and 0 or more, the origin finite");
  refuse(lattice.force.range().most > 0.0 &&
             !(lattice.hasWaves() && lattice.force.range().most <= lattice.highestForce(stiffness)),
         "its lattice is stiffer than the material",
         "its force must not be more than the material's stiffness times the shortest wavelength / "
         "2 pi");
  checkParameter(material.cutting, "cutting force", of);
  refuse(material.cutting.range().most > 0.0 && !(stiffness > 0.0),
         "it has a cutting force and no stiffness", "give it one, such as 300 N/m");

  const ShaftFriction& shaft = material.shaft;
  refuse(!(shaft.stiffness >= 0.0 && std::isfinite(shaft.stiffness) && shaft.stick_speed >= 0.0),
         "its shaft friction is out of range", "stiffness and stick speed must be 0 or more");
  refuse(!(shaft.lateral.stiffness >= 0.0 && std::isfinite(shaft.lateral.stiffness) &&
           shaft.lateral.strength > 0.0),
         "a value that holds its shaft sideways is out of range",
         "the lateral stiffness must be 0 or more, the strength more than 0");
  refuse(shaft.lateral.stiffness > 0.0 && !(shaft.stiffness > 0.0),
         "its shaft is held sideways but has no stiffness along its way",
         "give the shaft's friction a stiffness too");
  for (const ShaftFriction::Way* way : {&shaft.in, &shaft.out}) {
    checkParameter(way->static_force, "static shaft friction", of);
    checkParameter(way->kinetic_force, "kinetic shaft friction", of);
    checkParameter(way->damping, "damping of the shaft", of);
    refuse(way->kinetic_force.range().least > way->static_force.range().least ||
               way->kinetic_force.range().most > way->static_force.range().most,
           "its kinetic shaft friction is more than its static one",
           "lower the kinetic friction, or raise the static one");
  }
}

void checkComposite(const Material& material) {
  const Composite& composite = material.composite;
  if (!(composite.radius >= 0.0) || (composite.radius > 0.0 && !(composite.depth > 0.0)) ||
      !std::isfinite(composite.radius + composite.depth)) {
    throw inputError(
        "scene.parameter",
        "the composite of material " + inQuotes(material.name) + " lacks a radius or a depth",
        "both must be more than 0; a radius of 0 means no composite");
  }
}

}  // namespace

void checkMaterial(const Material& material) {
  const std::string of = "material " + inQuotes(material.name);
  checkParameter(material.stiffness, "stiffness", of);
  checkParameter(material.damping, "damping", of);
  checkParameter(material.viscosity, "viscosity", of);
  for (const Parameter& along : {material.flow.x, material.flow.y, material.flow.z}) {
    const MaterialMap::Range range = along.range();
    if (std::isfinite(range.least) && range.least <= range.most && std::isfinite(range.most))
      continue;
    throw inputError("scene.parameter", "the flow of " + of + " is not finite everywhere",
                     "all its values must be finite numbers");
  }
  checkParameter(material.friction.static_ratio, "static friction", of);
  checkParameter(material.friction.kinetic_ratio, "kinetic friction", of);
  // If kinetic is below static everywhere, both ranges are too; otherwise the loop clamps.
  const MaterialMap::Range held = material.friction.static_ratio.range();
  const MaterialMap::Range slides = material.friction.kinetic_ratio.range();
  if (slides.least > held.least || slides.most > held.most) {
    throw inputError("scene.parameter",
                     "the kinetic friction of " + of + " is more than its static one",
                     "lower the kinetic friction, or raise the static one");
  }
  checkTexture(material);
  checkComposite(material);
  checkTissue(material, of);
}

}  // namespace palpate
