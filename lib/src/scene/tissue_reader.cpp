#include "scene/tissue_reader.h"

#include <charconv>
#include <iterator>

#include "scene/messages.h"
#include "scene/parameter_reader.h"
#include "scene/shape_reader.h"
#include "scene/values.h"

namespace palpate {
namespace {

constexpr double kStickSpeed = 1e-3;  // [m/s] (documented in tools/docs/scene.md)

std::string forceText(double newton) {
  char digits[32];
  const auto end =
      std::to_chars(std::begin(digits), std::end(digits), newton, std::chars_format::general, 6);
  return std::string(std::begin(digits), end.ptr) + " N";
}

double positive(MapReader& reader, std::string_view key, Dimension dimension) {
  (void)reader.require(key);
  const double value = reader.quantityOr(key, dimension, 0.0);
  if (!(value > 0.0)) {
    throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be more than 0");
  }
  return value;
}

/// More than 0 somewhere.
Parameter positiveParameter(MapReader& reader, std::string_view key, Dimension dimension) {
  Parameter parameter = requireParameter(reader, key, dimension);
  if (!(parameter.range().most > 0.0)) {
    throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be more than 0");
  }
  return parameter;
}

SpringCurve readCurve(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'curve'");
  SpringCurve curve;
  curve.stiffening = readParameter(reader, "stiffening", Dimension::kStiffness2, {});
  curve.exponent = reader.numberOr("exponent", 1.0);
  const bool has_reference = reader.optional("reference") != nullptr;
  if (has_reference) curve.reference = positiveLength(reader, "reference");
  reader.finish();
  if (!(curve.exponent >= 1.0 && curve.exponent <= SpringCurve::kHighestExponent)) {
    throw reader.errorAt("exponent", "scene.range", "'exponent' must be from 1 to 4",
                         "1 is a straight spring, 1.5 the contact of a ball (Hertz)");
  }
  if (curve.exponent != 1.0 && !has_reference) {
    throw reader.errorAt("exponent", "scene.missing_key", "'exponent' needs 'reference'",
                         "the depth at which the wall pushes as a straight spring of its "
                         "'stiffness' would, such as reference: 1 mm");
  }
  return curve;
}

Maxwell readMaxwell(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'maxwell'");
  Maxwell branch;
  branch.stiffness = positiveParameter(reader, "stiffness", Dimension::kStiffness);
  branch.time = positive(reader, "time", Dimension::kTime);
  reader.finish();
  return branch;
}

Lattice readLattice(const SceneLoader& loader, const Node& node, double stiffness) {
  MapReader reader(loader, node, "'lattice'");
  Lattice lattice;
  lattice.force = positiveParameter(reader, "force", Dimension::kForce);
  lattice.wavelength = reader.requirePoint("wavelength");
  if (reader.optional("origin") != nullptr) lattice.origin = reader.requirePoint("origin");
  reader.finish();
  const Vec3& waves = lattice.wavelength;
  if (waves.x < 0.0 || waves.y < 0.0 || waves.z < 0.0 || !lattice.hasWaves()) {
    throw reader.errorAt("wavelength", "scene.range",
                         "'wavelength' must be three lengths of 0 or more, not all of them 0",
                         "0 means no waves along that axis");
  }
  if (!(stiffness > 0.0)) {
    throw reader.errorAt(
        "force", "scene.range", "a material with 'lattice' needs a 'stiffness'",
        "it says how stiff the lattice may be at most: 2 pi 'force' / 'wavelength'");
  }
  const double highest = lattice.highestForce(stiffness);
  if (lattice.force.range().most > highest) {
    throw reader.errorAt("force", "scene.range",
                         "'force' must not be more than 'stiffness' times the shortest "
                         "'wavelength' / 2 pi, here " +
                             forceText(highest),
                         "a stronger lattice would be stiffer than its material; make it weaker "
                         "or longer, or the material stiffer");
  }
  return lattice;
}

ShaftFriction::Way readWay(const SceneLoader& loader, const Node& node, const std::string& what) {
  MapReader reader(loader, node, what);
  const Parameter held = requireParameter(reader, "static", Dimension::kStiffness);
  const Parameter slides = readParameter(reader, "kinetic", Dimension::kStiffness, held);
  const Parameter damping = readParameter(reader, "damping", Dimension::kDamping2, {});
  reader.finish();
  if (slides.range().most > held.range().most || slides.range().least > held.range().least) {
    throw reader.errorAt("kinetic", "scene.range", "'kinetic' must not be more than 'static'",
                         "what slides is held less than what sticks");
  }
  return {held, slides, damping};
}

ShaftFriction::Lateral readLateral(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'lateral'");
  ShaftFriction::Lateral lateral;
  lateral.stiffness = positive(reader, "stiffness", Dimension::kStiffness2);
  if (reader.optional("strength") != nullptr) {
    lateral.strength = positive(reader, "strength", Dimension::kStiffness);
  }
  reader.finish();
  return lateral;
}

ShaftFriction readShaft(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "'shaft'");
  ShaftFriction shaft;
  shaft.stiffness = positive(reader, "stiffness", Dimension::kStiffness2);
  shaft.stick_speed = reader.quantityOr("stick_speed", Dimension::kVelocity, kStickSpeed);
  if (shaft.stick_speed < 0.0) {
    throw reader.errorAt("stick_speed", "scene.range", "'stick_speed' must be 0 or more");
  }
  shaft.in = readWay(loader, reader.require("in"), "'in' of 'shaft'");
  const Node* out = reader.optional("out");
  shaft.out = out != nullptr ? readWay(loader, *out, "'out' of 'shaft'") : shaft.in;
  if (const Node* lateral = reader.optional("lateral")) {
    shaft.lateral = readLateral(loader, *lateral);
  }
  reader.finish();
  return shaft;
}

}  // namespace

void readTissue(MapReader& reader, Material& material) {
  const SceneLoader& loader = reader.loader();
  const double stiffness = material.stiffness.range().least;
  if (const Node* curve = reader.optional("curve")) material.curve = readCurve(loader, *curve);
  if (const Node* branch = reader.optional("maxwell")) {
    material.maxwell = readMaxwell(loader, *branch);
  }
  if (const Node* lattice = reader.optional("lattice")) {
    material.lattice = readLattice(loader, *lattice, stiffness);
  }
  material.cutting = readParameter(reader, "cutting", Dimension::kForce, {});
  if (material.cutting.range().most > 0.0 && !(stiffness > 0.0)) {
    throw reader.errorAt("cutting", "scene.range", "a material with 'cutting' needs a 'stiffness'",
                         "with it the tip presses until it cuts; give one, such as 300 N/m");
  }
  if (const Node* shaft = reader.optional("shaft")) material.shaft = readShaft(loader, *shaft);
}

}  // namespace palpate
