#include "scene/tissue_reader.h"

#include "palpate/core/text.h"
#include "scene/parameter_reader.h"

namespace palpate {
namespace {

std::string forceText(double newton) { return shortNumber(newton, 6) + " N"; }

SpringCurve readCurve(const MapReader& reader) {
  SpringCurve curve;
  curve.stiffening = readParameter(reader, "stiffening");
  curve.exponent = reader.value("exponent");
  if (reader.has("reference")) {
    curve.reference = reader.value("reference");
  } else if (curve.exponent != 1.0) {
    throw reader.errorAt("exponent", "scene.missing_key", "'exponent' needs 'reference'",
                         "the depth at which the wall pushes as a straight spring of its "
                         "'stiffness' would, such as reference: 1 mm");
  }
  return curve;
}

Lattice readLattice(const MapReader& reader, double stiffness) {
  const Lattice lattice{readParameter(reader, "force"), reader.point("wavelength"),
                        reader.point("origin")};
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

ShaftFriction::Way readWay(const MapReader& reader) {
  const auto [held, slides] = readFriction(reader);
  return {held, slides, readParameter(reader, "damping")};
}

ShaftFriction readShaft(const MapReader& reader) {
  ShaftFriction shaft;
  shaft.stiffness = reader.value("stiffness");
  shaft.stick_speed = reader.value("stick_speed");
  shaft.in = readWay(reader.map("in"));
  shaft.out = reader.has("out") ? readWay(reader.map("out")) : shaft.in;
  if (reader.has("lateral")) {
    const MapReader lateral = reader.map("lateral");
    shaft.lateral.stiffness = lateral.value("stiffness");
    if (lateral.has("strength")) shaft.lateral.strength = lateral.value("strength");
  }
  return shaft;
}

}  // namespace

std::pair<Parameter, Parameter> readFriction(const MapReader& reader) {
  const Parameter held = readParameter(reader, "static");
  const Parameter slides = readParameter(reader, "kinetic", held);
  if (slides.range().most > held.range().most || slides.range().least > held.range().least) {
    throw reader.errorAt("kinetic", "scene.range", "'kinetic' must not be more than 'static'",
                         "lower 'kinetic', or raise 'static'");
  }
  return {held, slides};
}

void readTissue(const MapReader& reader, Material& material) {
  const double stiffness = material.stiffness.range().least;
  if (reader.has("curve")) material.curve = readCurve(reader.map("curve"));
  if (reader.has("maxwell")) {
    const MapReader branch = reader.map("maxwell");
    material.maxwell = {readParameter(branch, "stiffness"), branch.value("time")};
  }
  if (reader.has("lattice")) material.lattice = readLattice(reader.map("lattice"), stiffness);
  material.cutting = readParameter(reader, "cutting");
  if (material.cutting.range().most > 0.0 && !(stiffness > 0.0)) {
    throw reader.errorAt("cutting", "scene.range", "a material with 'cutting' needs a 'stiffness'",
                         "with it the tip presses until it cuts; give one, such as 300 N/m");
  }
  if (reader.has("shaft")) material.shaft = readShaft(reader.map("shaft"));
}

}  // namespace palpate
