// One refusal for each rule of the scene file, with its exact place and remedy.

#include <gtest/gtest.h>

#include "lib/scene/problems.h"
#include "lib/scene/stand_in_readers.h"

namespace palpate {
namespace {

const std::string kHead = "palpate: 1\nlength: mm\n";

// `text` after two header lines: its first line is line 3.
std::string scene(const std::string& text) { return kHead + text; }

std::string field(const std::string& value) { return scene("fields:\n  f: " + value + "\n"); }
std::string material(const std::string& value) { return scene("materials:\n  m: " + value + "\n"); }

// Two layers and a port whose line is 9: columns below count from its start.
std::string port(const std::string& rest) {
  return scene(
      "fields:\n"
      "  ball: {sphere: {center: [0, 0, 0], radius: 5}}\n"
      "layers:\n"
      "  - {name: skin, inside: ball}\n"
      "  - {name: skull, inside: ball}\n"
      "ports:\n" +
      rest);
}
std::string layer(const std::string& rest) {
  return scene(
      "fields: {ball: {sphere: {center: [0, 0, 0], radius: 5}}}\n"
      "materials: {bone: {stiffness: 2000 N/m}, fat: {viscosity: 2 N.s/m}}\n"
      "layers:\n" +
      rest);
}

class SceneRefuses : public ::testing::TestWithParam<Refusal> {};

TEST_P(SceneRefuses, WithItsPlaceAndRemedy) {
  const Refusal& refusal = GetParam();
  const SceneRegistry registry = standInReaders();
  const Problem problem = problemOf([&] { (void)parseScene(refusal.text, "test.yaml", registry); });
  expectRefusal(refusal, problem);
  // Every refusal shows its line.
  EXPECT_FALSE(problem.excerpt.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Head, SceneRefuses,
    ::testing::Values(
        marked("NotAMap", "@- 1\n", "scene.kind", "map", "palpate: 1"),
        marked("NoVersion", "@length: mm\n", "scene.version", "scene", "palpate: 1"),
        marked("VersionSlip", "length: mm\n@palpte: 1\n", "scene.unknown_key", "'palpte'",
               "'palpate'"),
        marked("LaterVersion", "palpate: @2\nnew: 1\n", "scene.version", "'2'", "newer"),
        marked("FractionalVersion", "palpate: @1.0\n", "scene.version", "'1.0'", "palpate: 1"),
        marked("QuotedVersion", "palpate: @\"1\"\n", "scene.kind", "number", "remove the quotes"),
        marked("EmptyVersion", "@palpate:\nlength: mm\n", "scene.empty", "'palpate'", "value"),
        marked("NoLength", "@palpate: 1\n", "scene.missing_key", "'length'", "length"),
        marked("LengthSlip", "palpate: 1\n@lenght: mm\n", "scene.unknown_key", "'lenght'",
               "'length'"),
        marked("UnknownLengthUnit", "palpate: 1\nlength: @mmm\n", "scene.choice", "'mmm'", "'mm'"),
        marked("NoLengthUnit", "palpate: 1\nlength: @parsec\n", "scene.choice", "m, mm, cm, um, in",
               ""),
        marked("UnknownKey", scene("@color: red\n"), "scene.unknown_key", "'color'",
               "keys here: palpate, length"),
        marked("KeySlip", scene("@layer: []\n"), "scene.unknown_key", "'layer'", "'layers'"),
        marked("MergeKey", scene("@<<: {a: 1}\n"), "scene.unknown_key", "'<<'", "keys here"),
        marked("EmptyValue", scene("@fields:\n"), "scene.empty", "'fields'", "remove it"),
        marked("NullValue", scene("@fields: null\n"), "scene.empty", "'fields'", "remove it"),
        marked("NoSpaceBehindColon", scene("start: {@region:outside}\n"), "scene.unknown_key",
               "'region:outside'", "space behind"),
        marked("UnknownKeyWithoutValue", scene("@layerz:\n"), "scene.unknown_key", "'layerz'",
               "'layers'"),
        marked("Renderer", scene("renderer: @papper\n"), "scene.choice", "'papper'", "'paper'"),
        marked("Memory", scene("memory: @forget\n"), "scene.choice", "'forget'", "clear, keep"),
        marked("MemoryAsBoolean", scene("memory: @true\n"), "scene.choice", "'true'",
               "clear, keep"),
        marked("DescriptionIsText", scene("description: @[a]\n"), "scene.kind", "a list", ""),
        marked("DescriptionIsNotANumber", scene("description: @12\n"), "scene.kind", "'12'",
               "quote it: \"12\""),
        marked("ForceOfNothing", scene("force: {max: @0 N}\n"), "scene.range", "'max'", ""),
        marked("ForceThatGrowsByAForce", scene("force: {slew: @20 N}\n"), "scene.unit", "'slew'",
               "N/s (also mN/s, kN/s)"),
        marked("DeviceWithoutScale", scene("device: {scale: @0}\n"), "scene.range", "'scale'", ""),
        marked("DeviceWithForceAgainstTheHand", scene("device: {force: @-1}\n"), "scene.range",
               "'force'", ""),
        marked("DeviceOfNoScaleThereIs", scene("device: {scale: @1e200}\n"), "scene.range",
               "'scale'", ""),
        marked("DeviceOfNoForceThereIs", scene("device: {force: @1e-200}\n"), "scene.range",
               "'force'", ""),
        marked("DeviceTurnedWithoutEnd",
               scene("device: {rotate: {axis: [0, 0, 1], degrees: @1e308}}\n"), "scene.range",
               "'degrees'", ""),
        marked("DeviceTurnedAboutNoAxis",
               scene("device: {rotate: {axis: @[0, 0, 0], degrees: 90}}\n"), "scene.range",
               "'axis'", ""),
        marked("DeviceTurnedByNoAngle", scene("device: {rotate: @{axis: [0, 0, 1]}}\n"),
               "scene.missing_key", "'degrees'", "degrees"),
        marked("EndlessWorkspace",
               scene("device: {workspace: @{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}}\n"),
               "scene.range", "'workspace'", "box or a sphere"),
        marked("PassivityOfNoMass", scene("device: {passivity: {mass: @0 kg}}\n"), "scene.range",
               "'mass'", ""),
        marked("PassivityOfNegativeDamping", scene("device: {passivity: {damping: @-1 N.s/m}}\n"),
               "scene.range", "'damping'", ""),
        marked("PassivityMassWithoutUnit", scene("device: {passivity: {mass: @0.2}}\n"),
               "scene.unit", "'mass'", "kg"),
        marked("CouplingOfNoStiffness", scene("device: {coupling: {stiffness: @0 N/m}}\n"),
               "scene.range", "'stiffness'", ""),
        marked("CouplingOfADamperAlone", scene("device: {coupling: {damping: @1 N.s/m}}\n"),
               "scene.coupling", "'damping'", "both"),
        marked("CouplingDesignedAndGiven",
               scene("device: {coupling: {stiffness: 1 N/m, for: @springs}}\n"), "scene.coupling",
               "'stiffness'", "leave out"),
        marked("CouplingForWhat", scene("device: {coupling: {for: @walls}}\n"), "scene.choice",
               "'walls'", "springs"),
        marked("ClutchIsABoolean", scene("device: {clutch: @yes}\n"), "scene.kind", "'clutch'", ""),
        marked("GridsWithoutTolerance", scene("grids: @{voxel: 1}\n"), "scene.missing_key",
               "'tolerance'", "tolerance"),
        marked("GridsOfNoTolerance", scene("grids: {tolerance: @0}\n"), "scene.range",
               "'tolerance'", ""),
        marked("StartNowhere", scene("start: {region: @outsid}\n"), "scene.unknown_region",
               "'outsid'", "'outside'"),
        marked("StartIsNoGlob", scene("start: {region: @\"out*\"}\n"), "scene.kind",
               "not a pattern", "outside"),
        marked("StartIsAMap", scene("start: @outside\n"), "scene.kind", "a map", "")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Numbers, SceneRefuses,
    ::testing::Values(
        marked("Octal", field("{sphere: {center: [0, 0, 0], radius: @010}}"), "scene.number",
               "'010'", "write 10"),
        marked("NegativeOctal", field("{sphere: {center: [@-007, 0, 0], radius: 1}}"),
               "scene.number", "'-007'", "write -7"),
        marked("ZeroBeforePoint", field("{sphere: {center: [0, 0, 0], radius: @00.5}}"),
               "scene.number", "'00.5'", "write 0.5"),
        marked("Hex", field("{sphere: {center: [0, 0, 0], radius: @0x1F}}"), "scene.number",
               "'0x1F'", "decimal"),
        marked("Infinity", field("{sphere: {center: [0, 0, 0], radius: @.inf}}"), "scene.number",
               "'.inf'", "finite"),
        marked("NegativeInfinity", field("{sphere: {center: [@-.Inf, 0, 0], radius: 1}}"),
               "scene.number", "'-.Inf'", "finite"),
        marked("Nan", field("{sphere: {center: [0, @.nan, 0], radius: 1}}"), "scene.number",
               "'.nan'", "finite"),
        marked("Underscore", field("{sphere: {center: [0, 0, 0], radius: @1_000}}"), "scene.number",
               "'1_000'", "without '_'"),
        marked("DecimalComma", field("\n    sphere:\n      center: [0, 0, 0]\n      radius: @1,5"),
               "scene.number", "'1,5'", "decimal point"),
        marked("Quoted", field("{sphere: {center: [0, 0, 0], radius: @\"5\"}}"), "scene.kind",
               "not digits in quotes", "remove the quotes: 5"),
        marked("QuotedPlain", material("{friction: {static: @\"0.3\"}}"), "scene.kind", "quoted",
               "remove the quotes: 0.3"),
        marked("Word", field("{sphere: {center: [0, 0, 0], radius: @big}}"), "scene.number",
               "'big'", "a number in mm"),
        marked("TooLarge", field("{sphere: {center: [0, 0, 0], radius: @1e999}}"), "scene.number",
               "'1e999'", ""),
        marked("NoBreakSpace", field("{sphere: {center: [0, 0, 0], radius: @5\xC2\xA0mm}}"),
               "scene.number", "must be a length", "no-break space"),
        marked("UnitSlip", field("{sphere: {center: [0, 0, 0], radius: @5 mmm}}"), "scene.unit",
               "'mmm'", "'mm'"),
        marked("UnknownUnit", field("{sphere: {center: [0, 0, 0], radius: @5 ells}}"), "scene.unit",
               "'ells'", "m (also mm"),
        marked("WrongUnit", field("{sphere: {center: [0, 0, 0], radius: @5 N}}"), "scene.unit",
               "must be a length; 'N'", "m (also mm"),
        marked("MissingUnit", material("{stiffness: @1500}"), "scene.unit", "needs its unit",
               "write 1500 N/m (also N/mm"),
        marked("MissingDampingUnit", material("{damping: @1}"), "scene.unit", "needs its unit",
               "write 1 N.s/m"),
        marked("MissingForceUnit", port("  - {name: p, between: [outside, skin], opens_at: @3}"),
               "scene.unit", "needs its unit", "write 3 N"),
        marked("WrongStiffnessUnit", material("{stiffness: @5 N}"), "scene.unit",
               "must be a stiffness; 'N'", "N/m"),
        marked("StiffnessUnitSlip", material("{stiffness: @5 N/n}"), "scene.unit", "'N/n'",
               "'N/m'"),
        marked("QuantityIsAList", material("{stiffness: @[5 N/m]}"), "scene.kind", "a list", ""),
        marked("RatioWithUnit", material("{friction: {static: @0.2 N}}"), "scene.number", "'0.2 N'",
               "without a unit"),
        marked("NegativeStiffness", material("{stiffness: @-1 N/m}"), "scene.range", "'stiffness'",
               ""),
        marked("NegativeDamping", material("{damping: @-1 N.s/m}"), "scene.range", "'damping'", ""),
        marked("NegativeViscosity", material("{viscosity: @-1 N.s/m}"), "scene.range",
               "'viscosity'", ""),
        marked("NegativeFriction", material("{friction: {static: @-0.1}}"), "scene.range",
               "'static'", ""),
        marked("NegativeKinetic", material("{friction: {static: 0.1, kinetic: @-0.1}}"),
               "scene.range", "'kinetic'", ""),
        marked("KineticAboveStatic", material("{friction: {static: 0.1, kinetic: @0.2}}"),
               "scene.range", "'kinetic'", "raise 'static'"),
        marked("FrictionWithoutStatic", material("{friction: @{kinetic: 0.2}}"),
               "scene.missing_key", "'static'", "static"),
        marked("FrictionIsANumber", material("{friction: @0.2}"), "scene.kind", "a map", ""),
        marked("FlowOfTwo", material("{flow: @[1 m/s, 0 m/s]}"), "scene.length",
               "list of 3, not of 2", ""),
        marked("FlowWithoutUnit", material("{flow: [1 m/s, 0 m/s, @0]}"), "scene.unit",
               "a velocity", "write 0 m/s"),
        marked("MaterialKey", material("{@stifness: 5 N/m}"), "scene.unknown_key",
               "'stifness' in the material 'm'", "'stiffness'"),
        marked("MaterialCalledAbsent", scene("materials: {@absent: {}}\n"), "scene.name",
               "'absent'", "no wall"),
        marked("MaterialIsAMap", material("@glass"), "scene.kind", "a map", ""),
        marked("MaterialsAreAMap", scene("materials: @[a]\n"), "scene.kind", "a map", "")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Fields, SceneRefuses,
    ::testing::Values(
        marked("PointOfTwo", field("{sphere: {center: @[0, 0], radius: 1}}"), "scene.length",
               "list of 3, not of 2", ""),
        marked("PointOfFour", field("{sphere: {center: @[0, 0, 0, 0], radius: 1}}"), "scene.length",
               "not of 4", ""),
        marked("PointIsANumber", field("{sphere: {center: @0, radius: 1}}"), "scene.kind", "a list",
               ""),
        marked("PointWithAHole", field("{sphere: {center: [0@, , 0], radius: 1}}"), "scene.empty",
               "empty entry", "fill it in"),
        marked("NoDirection", field("{half_space: {point: [0, 0, 0], normal: @[0, 0, 0]}}"),
               "scene.range", "'normal'", "differ from 0"),
        marked("DirectionWithUnit",
               field("{half_space: {point: [0, 0, 0], normal: [0, 0, @1 mm]}}"), "scene.number",
               "'1 mm'", "without a unit"),
        marked("MissingKey", field("{sphere: @{center: [0, 0, 0]}}"), "scene.missing_key",
               "'sphere' has no 'radius'", "radius"),
        marked("MissingKeyIsASlip", field("{sphere: {center: [0, 0, 0], @raduis: 5}}"),
               "scene.unknown_key", "'raduis'", "'radius'"),
        marked("SurplusKey", field("{sphere: {center: [0, 0, 0], radius: 5, @height: 2}}"),
               "scene.unknown_key", "'height' in 'sphere'", "keys here: center, radius"),
        marked("ZeroRadius", field("{sphere: {center: [0, 0, 0], radius: @0}}"), "scene.range",
               "'radius'", ""),
        marked("FlatBox", field("{box: {center: [0, 0, 0], size: @[1, 0, 1]}}"), "scene.range",
               "'size'", ""),
        marked("NegativeRadii", field("{ellipsoid: {center: [0, 0, 0], radii: @[1, 1, -1]}}"),
               "scene.range", "'radii'", ""),
        marked("ZeroHeight",
               field("{cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 1, height: @0 mm}}"),
               "scene.range", "'height'", ""),
        marked("KindSlip", field("{@shpere: {center: [0, 0, 0], radius: 1}}"), "scene.unknown_kind",
               "'shpere'", "'sphere'"),
        marked("UnknownKind", field("{@pyramid: {}}"), "scene.unknown_kind", "'pyramid'",
               "half_space, sphere, box"),
        marked("RegisteredKindSlip", field("{@mehs: {}}"), "scene.unknown_kind", "'mehs'",
               "'mesh'"),
        marked("TwoKinds", field("{sphere: {center: [0, 0, 0], radius: 1}, @union: [f]}"),
               "scene.kind", "'sphere' and 'union'", "combine"),
        marked("NoKind", field("@{}"), "scene.empty", "empty", "sphere"),
        marked("EmptyKind", field("{@sphere: }"), "scene.empty", "'sphere'", ""),
        marked("List", field("@[a, b]"), "scene.kind", "a name, or a map", "union"),
        marked("UnionIsAList", field("{union: @f}"), "scene.kind", "a list", "write [f]"),
        marked("EmptyUnion", field("{union: @[]}"), "scene.length", "1 or more, not of 0", ""),
        marked("UnknownField",
               scene("fields:\n  ball: {sphere: {center: [0, 0, 0], radius: 1}}\n  f: {union: "
                     "[@bal]}\n"),
               "scene.unknown_field", "'bal'", "'ball'"),
        marked("NumberAsField", field("{union: [@12]}"), "scene.kind", "'12'", "quote it"),
        marked("Itself", field("@f"), "scene.cycle", "'f'", "f -> f"),
        marked("Cycle", scene("fields:\n  a: {union: [b]}\n  b: {complement: c}\n  c: @a\n"),
               "scene.cycle", "'a'", "a -> b -> c -> a"),
        marked("TransformMovesNothing",
               field("{@transform: {field: g}}\n  g: {sphere: {center: [0, 0, 0], radius: 1}}"),
               "scene.missing_key", "moves nothing", "translate, rotate"),
        marked("RotateWithoutAxis",
               field("{transform: {field: g, rotate: @{degrees: 3}}}\n  g: {sphere: {center: [0, "
                     "0, 0], radius: 1}}"),
               "scene.missing_key", "'axis'", ""),
        marked("RotateKey",
               field("{transform: {field: g, rotate: {axis: [1, 0, 0], @degree: 3}}}\n  g: "
                     "{sphere: {center: [0, 0, 0], radius: 1}}"),
               "scene.unknown_key", "'degree'", "'degrees'"),
        marked("MeshKey", field("{mesh: {file: a.stl, @fiel: b}}"), "scene.unknown_key",
               "'fiel' in 'mesh'", "'file'"),
        marked("FileIsANumber", field("{mesh: {file: @7}}"), "scene.kind", "'7'",
               "quote it: \"7\""),
        marked("FieldsAreAMap", scene("fields: @[a]\n"), "scene.kind", "a map", "")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Layers, SceneRefuses,
    ::testing::Values(
        marked("NotAList", scene("layers: @{a: 1}\n"), "scene.kind", "a list", ""),
        marked("NoLayers", scene("layers: @[]\n"), "scene.length", "1 or more", ""),
        marked("EmptyItem", scene("layers:\n  @-\n"), "scene.empty", "empty entry", ""),
        marked("NoName", layer("  - @{inside: ball}\n"), "scene.missing_key", "'name'", ""),
        marked("NoSurface", layer("  - @{name: a}\n"), "scene.missing_key", "'a'", "inside"),
        marked("SurfaceSlip", layer("  - {name: a, @insid: ball}\n"), "scene.unknown_key",
               "'insid'", "'inside'"),
        marked("TwoSurfaces", layer("  - {name: a, inside: ball, @labels: {image: i}}\n"),
               "scene.kind", "'inside' and 'labels'", "one of them"),
        marked("CalledOutside", layer("  - {name: @outside, inside: ball}\n"), "scene.name",
               "'outside'", "no layer"),
        marked("GlobInName", layer("  - {name: @\"a*\", inside: ball}\n"), "scene.name", "'*'",
               "safe"),
        marked("CommaInName", layer("  - {name: @\"a,b\", inside: ball}\n"), "scene.name", "','",
               "safe"),
        marked("SlashInName", layer("  - {name: @a/b, inside: ball}\n"), "scene.name", "'/'",
               "safe"),
        marked("ControlInName", layer("  - {name: @\"a\\x01\", inside: ball}\n"), "scene.kind",
               "control", ""),
        marked("SpaceAroundName", layer("  - {name: @\" a\", inside: ball}\n"), "scene.name",
               "space", ""),
        marked("EmptyName", layer("  - {name: @\"\", inside: ball}\n"), "scene.empty", "empty", ""),
        marked("SameName", layer("  - {name: a, inside: ball}\n  - {name: @a, inside: ball}\n"),
               "scene.duplicate_name", "'a'", "line 6"),
        marked("UnknownContent", layer("  - {name: a, inside: ball, content: @fatt}\n"),
               "scene.unknown_material", "'fatt'", "'fat'"),
        marked("UnknownWall", layer("  - {name: a, inside: ball, wall: @steel}\n"),
               "scene.unknown_material", "'steel'", "bone, fat"),
        marked("SoftWall", layer("  - {name: a, inside: ball, wall: @fat}\n"), "scene.range",
               "'fat'", "stiffness"),
        marked("UnknownField2", layer("  - {name: a, inside: @bal}\n"), "scene.unknown_field",
               "'bal'", "'ball'"),
        marked("YesIsNoBoolean",
               layer("  - {name: a, threshold: {image: scan, above: 1, fill: @yes}}\n") +
                   "images: {scan: {file: a.nii}}\n",
               "scene.kind", "'yes'", "true and false"),
        marked("NoIsNoBoolean",
               layer("  - {name: a, threshold: {image: scan, above: 1, fill: @no}}\n") +
                   "images: {scan: {file: a.nii}}\n",
               "scene.kind", "'no'", "true and false"),
        marked("QuotedIsNoBoolean",
               layer("  - {name: a, threshold: {image: scan, above: 1, fill: @\"true\"}}\n") +
                   "images: {scan: {file: a.nii}}\n",
               "scene.kind", "'true'", "true and false"),
        marked("UnknownImage",
               layer("  - {name: a, labels: {image: @scam, match: [x]}}\n") +
                   "images: {scan: {file: a.nii}}\n",
               "scene.unknown_image", "'scam'", "'scan'"),
        marked("ImageKey", scene("images: {scan: {@fil: a.nii}}\n"), "scene.unknown_key",
               "'fil' in the image 'scan'", "'file'")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Ports, SceneRefuses,
    ::testing::Values(
        marked("UnknownRegion", port("  - {name: p, between: [outside, @skul]}\n"),
               "scene.unknown_region", "'skul'", "'skull'"),
        marked("FarRegion", port("  - {name: p, between: [outside, @thalamus]}\n"),
               "scene.unknown_region", "'thalamus'", "regions: outside, skin, skull"),
        marked("GlobOfNothing", port("  - {name: p, between: [outside, @\"mus*\"]}\n"),
               "scene.unknown_region", "matches no region", "outside, skin, skull"),
        marked("UnknownInAList", port("  - {name: p, between: [[outside, @skul], skin]}\n"),
               "scene.unknown_region", "'skul'", "'skull'"),
        marked("NoRegionInAList", port("  - {name: p, between: [@[], skin]}\n"), "scene.length",
               "a list of regions", ""),
        marked("OneRegion", port("  - {name: p, between: @[skin]}\n"), "scene.length",
               "list of 2, not of 1", ""),
        marked("RegionAndItself", port("  - {name: p, between: [skin, @skin]}\n"), "scene.kind",
               "'skin'", ""),
        marked("NoBetween", port("  - @{name: p}\n"), "scene.missing_key", "'between'", ""),
        marked("SameName",
               port("  - {name: p, between: [outside, skin]}\n  - {name: @p, between: [skin, "
                    "skull]}\n"),
               "scene.duplicate_name", "'p'", "line 9"),
        marked("SemicolonInName", port("  - {name: @a;b, between: [outside, skin]}\n"),
               "scene.name", "';'", ""),
        marked("OnUnknown", port("  - {name: p, between: [outside, skin], on: @bal}\n"),
               "scene.unknown_field", "'bal'", "'ball'"),
        marked("OnInline",
               port("  - {name: p, between: [outside, skin], on: @{sphere: {center: [0, 0, 0], "
                    "radius: 1}}}\n"),
               "scene.kind", "name of a field", "`fields`"),
        marked("WhereUnknown", port("  - {name: p, between: [outside, skin], where: @bal}\n"),
               "scene.unknown_field", "'bal'", "'ball'"),
        marked("Direction", port("  - {name: p, between: [outside, skin], direction: @inn}\n"),
               "scene.choice", "'inn'", "'in'"),
        marked("AfterUnknown",
               port("  - {name: hole, between: [outside, skin]}\n  - {name: p, between: [skin, "
                    "skull], after: [@hola]}\n"),
               "scene.unknown_port", "'hola'", "'hole'"),
        marked("AfterItself", port("  - {name: p, between: [outside, skin], after: [@p]}\n"),
               "scene.cycle", "'p'", ""),
        marked("AfterTwice",
               port("  - {name: p, between: [outside, skin], after: [q, @q]}\n  - {name: q, "
                    "between: [skin, skull]}\n"),
               "scene.duplicate_name", "'q'", ""),
        marked("AfterIsAList", port("  - {name: p, between: [outside, skin], after: @q}\n"),
               "scene.kind", "a list", "write [q]"),
        marked("NegativeForce", port("  - {name: p, between: [outside, skin], opens_at: @-1 N}\n"),
               "scene.range", "'opens_at'", ""),
        marked("HoleInAnOpenPort",
               port("  - {name: p, between: [outside, skin], hole: @{radius: 1}}\n"),
               "scene.no_opening_force", "always open", "opens_at"),
        marked("RateOfAnOpenPort",
               port("  - {name: p, between: [outside, skin], rate: @{ratio: 1, speed: 1 mm/s}}\n"),
               "scene.no_opening_force", "'rate'", "opens_at"),
        marked(
            "RateRatio",
            port(
                "  - {name: p, between: [outside, skin], opens_at: 1 N, rate: {ratio: @0, speed: 1 "
                "mm/s}}\n"),
            "scene.range", "'ratio'", "fast hand"),
        marked(
            "RateSpeed",
            port(
                "  - {name: p, between: [outside, skin], opens_at: 1 N, rate: {ratio: 2, speed: @0 "
                "mm/s}}\n"),
            "scene.range", "'speed'", ""),
        marked("RateWithoutSpeed",
               port("  - {name: p, between: [outside, skin], opens_at: 1 N, rate: @{ratio: 2}}\n"),
               "scene.missing_key", "'speed'", ""),
        marked("RearmOfAnOpenPort", port("  - {name: p, between: [outside, skin], rearm: @0.5}\n"),
               "scene.no_opening_force", "'rearm'", "opens_at"),
        marked("HoleWithoutRadius",
               port("  - {name: p, between: [outside, skin], opens_at: 1 N, hole: @{reopens_at: "
                    "0 N}}\n"),
               "scene.missing_key", "'radius'", "radius"),
        marked("HoleOfNoSize",
               port("  - {name: p, between: [outside, skin], opens_at: 1 N, hole: {radius: @0}}\n"),
               "scene.range", "'radius'", ""),
        marked("HoleHarderThanTheWall",
               port("  - {name: p, between: [outside, skin], opens_at: 1 N, back: 2 N, hole: "
                    "{radius: 1, reopens_at: @3 N}}\n"),
               "scene.range", "'reopens_at'", "less"),
        marked("NegativeReopening",
               port("  - {name: p, between: [outside, skin], opens_at: 1 N, hole: {radius: 1, "
                    "reopens_at: @-1 N}}\n"),
               "scene.range", "'reopens_at'", ""),
        marked("NegativeRearm",
               port("  - {name: p, between: [outside, skin], opens_at: 1 N, rearm: @-1 mm}\n"),
               "scene.range", "'rearm'", ""),
        marked("NegativeBack", port("  - {name: p, between: [outside, skin], back: @-1 N}\n"),
               "scene.range", "'back'", ""),
        marked("PortKey", port("  - {name: p, between: [outside, skin], @open_at: 1 N}\n"),
               "scene.unknown_key", "'open_at' in a port", "'opens_at'"),
        marked("DuplicateKey", port("  - {name: p, between: [outside, skin], @name: q}\n"),
               "document.duplicate_key", "'name'", "line 9"),
        marked("UnquotedGlob", port("  - {name: p, between: [outside, @*kull]}\n"),
               "document.alias", "'*'", "quote globs")),
    refusalName);

INSTANTIATE_TEST_SUITE_P(
    Walls, SceneRefuses,
    ::testing::Values(
        marked("UnknownRegion",
               layer("  - {name: a, inside: ball}\nwalls:\n  - {between: [a, @b], wall: bone}\n"),
               "scene.unknown_region", "'b'", "outside, a"),
        marked("NoWall",
               layer("  - {name: a, inside: ball}\nwalls:\n  - @{between: [a, outside]}\n"),
               "scene.missing_key", "'wall'", ""),
        marked(
            "UnknownMaterial",
            layer(
                "  - {name: a, inside: ball}\nwalls:\n  - {between: [a, outside], wall: @absnt}\n"),
            "scene.unknown_material", "'absnt'", "'absent'"),
        marked("FeltFromElsewhere",
               layer("  - {name: a, inside: ball}\nwalls:\n  - {between: [a, outside], wall: "
                     "bone, felt_from: @b}\n"),
               "scene.choice", "'b'", "a, outside"),
        marked("HalfAbsent",
               layer("  - {name: a, inside: ball}\nwalls:\n  - {between: [a, outside], wall: "
                     "absent, felt_from: @a}\n"),
               "scene.kind", "absent", "direction")),
    refusalName);

TEST(SceneWithoutReaders, SaysThatItReadsNoMeshes) {
  const Problem problem =
      problemOf([] { (void)parseScene(field("{mesh: {file: a.stl}}"), "test.yaml"); });
  expectRefusal({"", "", 4, 7, "scene.no_reader", "cannot read 'mesh' fields", "palpate::vdb"},
                problem);
}

TEST(SceneWithoutReaders, SaysThatItReadsNoImages) {
  const Problem image =
      problemOf([] { (void)parseScene(scene("images: {scan: {file: a.nii}}\n"), "test.yaml"); });
  expectRefusal({"", "", 3, 10, "scene.no_reader", "cannot read images", "palpate::vdb"}, image);
  const Problem labels = problemOf([] {
    (void)parseScene(layer("  - {name: a, labels: {image: i, match: [x]}}\n"), "test.yaml");
  });
  expectRefusal({"", "", 6, 15, "scene.no_reader", "'labels'", "palpate::vdb"}, labels);
}

TEST(SceneWithoutReaders, SaysThatItReadsNoMaps) {
  const Problem problem = problemOf([] {
    (void)parseScene(scene("materials: {skin: {stiffness: {grid: {file: a.vdb}}}}\n"), "test.yaml");
  });
  expectRefusal({"", "", 3, 31, "scene.no_reader", "maps of parameters", "palpate::vdb"}, problem);
}

// A chain of names uses stack when it is read and when it is evaluated; names that double take
// time.
TEST(SceneBombs, LongChainsOfNamesAreRefusedInEitherOrder) {
  const auto chain = [](bool forward) {
    std::string text = "fields:\n  f0: {sphere: {center: [0, 0, 0], radius: 1}}\n";
    std::string rest;
    for (int i = 1; i < 1000; ++i) {
      const std::string line =
          "  f" + std::to_string(i) + ": {complement: f" + std::to_string(i - 1) + "}\n";
      rest = forward ? rest + line : rest;
      if (!forward) rest.insert(0, line);
    }
    return scene(forward ? text + rest : "fields:\n" + rest + text.substr(8));
  };
  for (const bool forward : {true, false}) {
    EXPECT_EQ(problemOf([&] { (void)parseScene(chain(forward), "test.yaml"); }).code,
              "scene.depth");
  }
}

TEST(SceneBombs, DoublingNamesAreRefused) {
  std::string text = "fields:\n  f0: {sphere: {center: [0, 0, 0], radius: 1}}\n";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "f" + std::to_string(i - 1);
    text += "  f" + std::to_string(i) + ": {union: [" + before + ", " + before + "]}\n";
  }
  EXPECT_EQ(problemOf([&] { (void)parseScene(scene(text), "test.yaml"); }).code,
            "scene.too_many_fields");
}

}  // namespace
}  // namespace palpate
