// Invalid tissue and needle parameters, in scene files and in code.

#include <gtest/gtest.h>

#include "lib/scene/problems.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene.h"

namespace palpate {
namespace {

std::string material(const std::string& value) {
  return "palpate: 1\nlength: mm\nmaterials:\n  m: {" + value + "}\n";
}

class TissueRefuses : public ::testing::TestWithParam<Refusal> {};

TEST_P(TissueRefuses, WithItsPlaceAndRemedy) {
  const Refusal& refusal = GetParam();
  expectRefusal(refusal, problemOf([&] { (void)parseScene(refusal.text, "test.yaml"); }));
}

INSTANTIATE_TEST_SUITE_P(
    Materials, TissueRefuses,
    ::testing::Values(
        marked("NoUnit", material("cutting: @0.5"), "scene.unit", "unit", "N"),
        marked("CuttingWithoutStiffness", material("cutting: @0.5 N"), "scene.range", "'stiffness'",
               "300 N/m"),
        marked("NegativeCutting", material("stiffness: 1 N/m, cutting: @-0.5 N"), "scene.range",
               "0 or more", ""),
        marked("Exponent", material("stiffness: 1 N/m, curve: {exponent: @0.5, reference: 1}"),
               "scene.range", "from 1 to 4", "Hertz"),
        marked("NoReference", material("stiffness: 1 N/m, curve: {exponent: @1.5}"),
               "scene.missing_key", "'reference'", "1 mm"),
        marked("Stiffening", material("stiffness: 1 N/m, curve: {stiffening: @-1 N/m^2}"),
               "scene.range", "0 or more", ""),
        marked("StiffeningUnit", material("stiffness: 1 N/m, curve: {stiffening: @1 N/m}"),
               "scene.unit", "stiffness per length", "N/m^2"),
        marked("MaxwellTime", material("stiffness: 1 N/m, maxwell: {stiffness: 1 N/m, time: @0 s}"),
               "scene.range", "more than 0", ""),
        marked("MaxwellWithoutTime", material("stiffness: 1 N/m, maxwell: @{stiffness: 1 N/m}"),
               "scene.missing_key", "'time'", ""),
        marked("LatticeWithoutStiffness", material("lattice: {force: @1 N, wavelength: [8, 8, 8]}"),
               "scene.range", "'stiffness'", "wavelength"),
        marked("StrongLattice",
               material("stiffness: 100 N/m, lattice: {force: @1 N, wavelength: [8, 0, 12]}"),
               "scene.range", "here 0.127324 N", "weaker"),
        marked("NoWaves",
               material("stiffness: 1 N/m, lattice: {force: 1 mN, wavelength: @[0, 0, 0]}"),
               "scene.range", "not all of them 0", "no waves"),
        marked("NegativeWaves",
               material("stiffness: 1 N/m, lattice: {force: 1 mN, wavelength: @[8, -8, 8]}"),
               "scene.range", "0 or more", ""),
        marked("ShaftWithoutIn", material("shaft: @{stiffness: 1e5 N/m^2}"), "scene.missing_key",
               "'in'", ""),
        marked("ShaftKinetic",
               material("shaft: {stiffness: 1e5 N/m^2, in: {static: 5 N/m, kinetic: @6 N/m}}"),
               "scene.range", "'kinetic'", "raise 'static'"),
        marked("ShaftSlip",
               material("shaft: {stiffness: 1e5 N/m^2, in: {static: 5 N/m, @dampin: 1 N/m}}"),
               "scene.unknown_key", "'dampin'", "'damping'"),
        marked("ShaftStiffness", material("shaft: {stiffness: @0 N/m^2, in: {static: 5 N/m}}"),
               "scene.range", "more than 0", ""),
        marked("Lateral",
               material("shaft: {stiffness: 1 N/m^2, in: {static: 5 N/m}, lateral: {stiffness: @0 "
                        "N/m^2}}"),
               "scene.range", "more than 0", ""),
        marked("LateralUnit",
               material("shaft: {stiffness: 1 N/m^2, in: {static: 5 N/m}, lateral: {stiffness: @1 "
                        "N/m}}"),
               "scene.unit", "stiffness per length", "N/m^2"),
        marked("LateralStrength",
               material("shaft: {stiffness: 1 N/m^2, in: {static: 5 N/m}, lateral: {stiffness: 1 "
                        "N/m^2, strength: @0 N/m}}"),
               "scene.range", "more than 0", ""),
        marked("StickSpeed",
               material("shaft: {stiffness: 1 N/m^2, stick_speed: @-1 mm/s, in: {static: 5 N/m}}"),
               "scene.range", "0 or more", "")),
    refusalName);

TEST(TissueMaterials, AreReadAsWritten) {
  const SceneDescription scene = parseScene(
      material(
          "stiffness: 400 N/m, curve: {stiffening: 2 N/mm^2, exponent: 1.5, reference: 2}, "
          "maxwell: {stiffness: 200 N/m, time: 50 ms}, "
          "lattice: {force: 100 mN, wavelength: [4, 0, 8], origin: [1, 2, 3]}, cutting: 0.6 N, "
          "shaft: {stiffness: 1e5 N/m^2, in: {static: 18 N/m, kinetic: 10 N/m, damping: 290 "
          "N.s/m^2}, lateral: {stiffness: 0.04 N/mm^2, strength: 0.2 N/mm}}"),
      "test.yaml");
  const Material& m = scene.materials.at(0);
  const Vec3 o(0.0);
  EXPECT_EQ(m.curve.stiffening.at(o), 2e6);
  EXPECT_EQ(m.curve.exponent, 1.5);
  EXPECT_EQ(m.curve.reference, 0.002);
  EXPECT_EQ(m.maxwell.stiffness.at(o), 200.0);
  EXPECT_EQ(m.maxwell.time, 0.05);
  EXPECT_EQ(m.lattice.force.at(o), 0.1);
  EXPECT_EQ(m.lattice.wavelength, Vec3(0.004, 0.0, 0.008));
  EXPECT_EQ(m.lattice.origin, Vec3(0.001, 0.002, 0.003));
  EXPECT_EQ(m.cutting.at(o), 0.6);
  EXPECT_EQ(m.shaft.stiffness, 1e5);
  EXPECT_EQ(m.shaft.stick_speed, 1e-3);
  EXPECT_EQ(m.shaft.lateral.stiffness, 4e4);
  EXPECT_EQ(m.shaft.lateral.strength, 200.0);
  for (const ShaftFriction::Way* way : {&m.shaft.in, &m.shaft.out}) {
    EXPECT_EQ(way->static_force.at(o), 18.0);
    EXPECT_EQ(way->kinetic_force.at(o), 10.0);
    EXPECT_EQ(way->damping.at(o), 290.0);
  }
}

// Materials made in code must follow the same rules.
TEST(TissueMaterials, MadeInCodeAreChecked) {
  const auto refused = [](const std::function<void(Material&)>& spoil) {
    SceneDescription description;
    Material material;
    material.name = "m";
    material.stiffness = 100.0;
    spoil(material);
    description.materials.push_back(material);
    description.layers.push_back({.name = "a",
                                  .inside = std::make_shared<FieldSource>(sphere(Vec3(0.0), 0.01)),
                                  .content = "m",
                                  .wall = {false, "m"}});
    try {
      (void)compile(description);
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "scene.parameter") << error.what();
      EXPECT_NE(error.problem().message.find("'m'"), std::string::npos) << error.what();
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused([](Material&) {}));
  EXPECT_TRUE(refused([](Material& m) { m.curve.exponent = 0.5; }));
  EXPECT_TRUE(refused([](Material& m) { m.curve.reference = 0.0; }));
  EXPECT_TRUE(refused([](Material& m) { m.curve.stiffening = -1.0; }));
  EXPECT_TRUE(refused([](Material& m) { m.maxwell.stiffness = 10.0; }));
  EXPECT_TRUE(refused([](Material& m) { m.lattice.force = 0.01; }));
  EXPECT_TRUE(refused([](Material& m) {
    m.lattice.force = 1.0;
    m.lattice.wavelength = Vec3(0.008);
  }));
  EXPECT_TRUE(refused([](Material& m) { m.lattice.wavelength = Vec3(0.0, -1.0, 0.0); }));
  EXPECT_TRUE(refused([](Material& m) { m.cutting = kInfinity; }));
  EXPECT_TRUE(refused([](Material& m) { m.shaft.stiffness = -1.0; }));
  EXPECT_TRUE(refused([](Material& m) { m.shaft.in.kinetic_force = 1.0; }));
}

}  // namespace
}  // namespace palpate
