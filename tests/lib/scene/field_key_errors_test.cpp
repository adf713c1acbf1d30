// Wrong values of the newer keys of scene files: each gives one clear error with its place and
// remedy.

#include <gtest/gtest.h>

#include "lib/scene/problems.h"

namespace palpate {
namespace {

std::string scene(const std::string& text) { return "palpate: 1\nlength: mm\n" + text; }
std::string field(const std::string& value) { return scene("fields:\n  f: " + value + "\n"); }
std::string metaballs(const std::string& value) { return field("{metaballs: {" + value + "}}"); }
std::string wall(const std::string& value) { return scene("materials:\n  m: " + value + "\n"); }
std::string sheet(const std::string& rest) {
  return scene(
      "fields: {ball: {sphere: {center: [0, 0, 0], radius: 5}}}\n"
      "materials: {steel: {stiffness: 2000 N/m}, fat: {viscosity: 2 N.s/m}}\n"
      "sheets:\n" +
      rest);
}
const std::string kBall = "{sphere: {center: [0, 0, 0], radius: 5}}";

class FieldKeyRefused : public ::testing::TestWithParam<Refusal> {};

TEST_P(FieldKeyRefused, WithItsPlaceAndRemedy) {
  const Refusal& refusal = GetParam();
  const Problem problem = problemOf([&] { (void)parseScene(refusal.text, "test.yaml"); });
  expectRefusal(refusal, problem);
  EXPECT_FALSE(problem.excerpt.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, FieldKeyRefused,
    ::testing::Values(
        marked("RoundingTooLarge",
               field("{rounded_box: {center: [0, 0, 0], size: [30, 20, 10], rounding: @5.1}}"),
               "scene.range", "half of the smallest 'size', 5 mm", "capsule"),
        marked("NoRounding",
               field("{rounded_box: {center: [0, 0, 0], size: [30, 20, 10], rounding: @0}}"),
               "scene.range", "'rounding' must be more than 0", ""),
        marked("RoundingForgotten", field("{rounded_box: @{center: [0, 0, 0], size: [3, 2, 1]}}"),
               "scene.missing_key", "'rounded_box' has no 'rounding'", "add rounding"),
        marked("ConeWithACenter",
               field("{cone: @{center: [0, 0, 0], axis: [0, 0, 1], radius: 1, height: 1}}"),
               "scene.missing_key", "'cone' has no 'base'", "add base"),
        marked("FlatCone",
               field("{cone: {base: [0, 0, 0], axis: [0, 0, 1], radius: 1, height: @-1}}"),
               "scene.range", "'height'", ""),
        marked("ConeWithoutDirection",
               field("{cone: {base: [0, 0, 0], axis: @[0, 0, 0], radius: 1, height: 1}}"),
               "scene.range", "'axis' has no direction", ""),
        marked("SpindleTorus",
               field("{torus: {center: [0, 0, 0], axis: [0, 0, 1], radius: 5, tube: @5}}"),
               "scene.range", "'tube' must be less than 'radius', 5 mm", "middle of the tube"),
        marked("TorusSlip",
               field("{torus: {center: [0, 0, 0], axis: [0, 0, 1], radius: 5, @tub: 1}}"),
               "scene.unknown_key", "'tub'", "'tube'"),
        marked("CapsuleOfAPoint", field("{capsule: {from: [1, 2, 3], to: @[1, 2, 3], radius: 5}}"),
               "scene.range", "the same point", "sphere"),
        marked("HeartWithARadius", field("{heart: @{center: [0, 0, 0], radius: 5}}"),
               "scene.missing_key", "'heart' has no 'width'", "add width"),
        marked("HeartWithoutWidth", field("{heart: {center: [0, 0, 0], width: @0 mm}}"),
               "scene.range", "'width'", ""),
        marked("QuadricWithUnits", field("{quadric: {center: [0, 0, 0], xx: @1 mm}}"),
               "scene.number", "'xx' must be a number", "without a unit"),
        marked("QuadricOfNothing", field("{quadric: @{center: [0, 0, 0], constant: -1}}"),
               "scene.missing_key", "no coefficient of x, y or z", "xx, yy"),
        marked("QuadricSlip", field("{quadric: {center: [0, 0, 0], @zx: 1}}"), "scene.unknown_key",
               "'zx'", ""),
        marked("QuadricTooSteep", field("{quadric: {center: [0, 0, 0], xx: @1e305}}"),
               "scene.range", "'xx' is too large", "the surface stays the same"),
        marked("QuadricWithoutSurface",
               field("{@quadric: {center: [0, 0, 0], xx: 1, yy: 1, zz: 1, constant: 1}}"),
               "field.no_surface", "same sign everywhere", "sign of the constant"),
        marked("QuadricReach", field("{quadric: {center: [0, 0, 0], x: 1, reach: @0}}"),
               "scene.range", "'reach'", ""),
        marked("GyroidTooThick",
               field("{gyroid: {center: [0, 0, 0], period: 10, thickness: @2.1}}"), "scene.range",
               "a fifth of 'period', 2 mm", "leave it out"),
        marked("GyroidWithoutPeriod", field("{gyroid: {center: [0, 0, 0], period: @0}}"),
               "scene.range", "'period'", ""),
        marked("FallOffUnknown",
               metaballs("fall_off: @gausian, iso: 1, balls: [{center: [0, 0, 0], radius: 1}]"),
               "scene.choice", "'gausian'", "'gaussian'"),
        marked("IsoZero",
               metaballs("fall_off: wyvill, iso: @0, balls: [{center: [0, 0, 0], radius: 1}]"),
               "scene.range", "'iso' must be more than 0", ""),
        marked("IsoNeverReached",
               metaballs("fall_off: wyvill, iso: @1, balls: [{center: [0, 0, 0], radius: 1}]"),
               "scene.range", "'iso' is never reached", "0.5"),
        marked("NoBalls", metaballs("fall_off: wyvill, iso: 1, balls: @[]"), "scene.length",
               "1 or more", ""),
        marked("BallWithoutRadius",
               metaballs("fall_off: wyvill, iso: 0.5, balls: [@{center: [0, 0, 0]}]"),
               "scene.missing_key", "a ball of 'metaballs' has no 'radius'", ""),
        marked("BallOfNoStrength",
               metaballs("fall_off: wyvill, iso: 0.5, balls: [{center: [0, 0, 0], radius: 1, "
                         "strength: @0}]"),
               "scene.range", "'strength' must not be 0", "takes away"),
        marked("BallKey",
               metaballs("fall_off: wyvill, iso: 0.5, balls: [{center: [0, 0, 0], radius: 1, "
                         "@weight: 1}]"),
               "scene.unknown_key", "'weight'", "strength")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Operations, FieldKeyRefused,
    ::testing::Values(
        marked("BlendOfAList", field("{smooth_union: @[" + kBall + "]}"), "scene.kind",
               "'smooth_union' must be a map", ""),
        marked("BlendWithoutRadius", field("{smooth_union: @{fields: [" + kBall + "]}}"),
               "scene.missing_key", "'smooth_union' has no 'radius'", ""),
        marked("BlendOfNothing", field("{smooth_difference: {fields: @[], radius: 1}}"),
               "scene.length", "'fields' must be a list of 1 or more", ""),
        marked("BlendRadius", field("{smooth_union: {fields: [" + kBall + "], radius: @-1}}"),
               "scene.range", "'radius'", ""),
        marked("BlendOfAnUnknown", field("{smooth_union: {fields: [@g], radius: 1}}"),
               "scene.unknown_field", "'g'", ""),
        marked("BlendOfItself", field("{smooth_union: {fields: [@f], radius: 1}}"), "scene.cycle",
               "'f'", "f -> f"),
        marked("ScaleByNothing", field("{scale: {field: " + kBall + ", factor: @0}}"),
               "scene.range", "'factor' must be more than 0", ""),
        marked("ScaleMirrors", field("{scale: {field: " + kBall + ", factor: @-1}}"), "scene.range",
               "'factor'", "mirrors"),
        marked("ScaleWithUnit", field("{scale: {field: " + kBall + ", factor: @2 mm}}"),
               "scene.number", "'factor'", "without a unit"),
        marked("ScaleTooLarge", field("{@scale: {field: " + kBall + ", factor: 1e7}}"),
               "field.out_of_range", "scale: factor", ""),
        marked("ScaleOfNothing", field("{scale: @{factor: 2}}"), "scene.missing_key",
               "'scale' has no 'field'", ""),
        marked("OffsetWithoutDistance", field("{offset: @{field: " + kBall + "}}"),
               "scene.missing_key", "'offset' has no 'distance'", ""),
        marked("OffsetUnit", field("{offset: {field: " + kBall + ", distance: @2 N}}"),
               "scene.unit", "must be a length; 'N'", ""),
        marked("ShellThickness", field("{shell: {field: " + kBall + ", thickness: @0}}"),
               "scene.range", "'thickness'", ""),
        marked("ShellKey", field("{shell: {field: " + kBall + ", @thicknes: 1}}"),
               "scene.unknown_key", "'thicknes'", "'thickness'")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Materials, FieldKeyRefused,
    ::testing::Values(
        marked("TextureTooHigh", wall("{texture: {amplitude: @1, wavelength: 6}}"), "scene.range",
               "'wavelength' / 2 pi, here 0.95493 mm", "lower or longer"),
        marked("TextureAmplitudeUnit", wall("{texture: {amplitude: @1 N, wavelength: 6}}"),
               "scene.unit", "must be a length; 'N'", ""),
        marked("TextureWithoutWaves", wall("{texture: @{amplitude: 1}}"), "scene.missing_key",
               "'texture' has no 'wavelength'", ""),
        marked("TextureFlat", wall("{texture: {amplitude: @0, wavelength: 6}}"), "scene.range",
               "'amplitude' must be more than 0", ""),
        marked("TextureIsAMap", wall("{texture: @1}"), "scene.kind", "a map", ""),
        marked("TextureKey", wall("{texture: {amplitude: 1, @wavelenght: 6}}"), "scene.unknown_key",
               "'wavelenght'", "'wavelength'"),
        marked("ShadingNegative", wall("{shading: @-1}"), "scene.range", "'shading'", ""),
        marked("ShadingUnit", wall("{shading: @1 N/m}"), "scene.unit", "a length", "")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Sheets, FieldKeyRefused,
    ::testing::Values(
        marked("NotAList", scene("sheets: @{name: a}\n"), "scene.kind", "a list", ""),
        marked("None", scene("sheets: @[]\n"), "scene.length", "1 or more", ""),
        marked("NoName", sheet("  - @{on: ball}\n"), "scene.missing_key", "'name'", ""),
        marked("NameWithComma", sheet("  - {name: @\"a,b\", on: ball}\n"), "scene.name", "','",
               "safe"),
        marked("SameName", sheet("  - {name: a, on: ball}\n  - {name: @a, on: ball}\n"),
               "scene.duplicate_name", "'a'", "line 6"),
        marked("OnNothing", sheet("  - @{name: a}\n"), "scene.missing_key", "'on'", ""),
        marked("OnUnknown", sheet("  - {name: a, on: @bal}\n"), "scene.unknown_field", "'bal'",
               "'ball'"),
        marked("WhereUnknown", sheet("  - {name: a, on: ball, where: @bal}\n"),
               "scene.unknown_field", "'bal'", "'ball'"),
        marked("WallUnknown", sheet("  - {name: a, on: ball, wall: @stel}\n"),
               "scene.unknown_material", "'stel'", "'steel'"),
        marked("WallSoft", sheet("  - {name: a, on: ball, wall: @fat}\n"), "scene.range", "'fat'",
               "stiffness"),
        marked("WallAbsent", sheet("  - {name: a, on: ball, wall: @absent}\n"), "scene.kind",
               "a sheet cannot be absent", "leave the sheet out"),
        marked("Key", sheet("  - {name: a, on: ball, @material: steel}\n"), "scene.unknown_key",
               "'material'", "keys here: name, on, where, wall")),
    refusalName);

}  // namespace
}  // namespace palpate
