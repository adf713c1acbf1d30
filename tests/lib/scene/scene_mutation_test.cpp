// Damaged scenes are either refused or read: no crash, no other exception, no hang.

#include <gtest/gtest.h>

#include <random>

#include "lib/scene/stand_in_readers.h"

namespace palpate {
namespace {

// Every key, and every form that a value can take.
constexpr std::string_view kScene = R"(# comment
palpate: 1
length: mm
renderer: constraint
memory: clear
description: |
  "text" of
  two lines
fields:
  ball: {sphere: {center: [0, 0, -1.5e1], radius: 40}}
  brim: {half_space: {point: [0, 0, 15 mm], normal: [0, 0, 1]}}
  part:
    difference:
      - ball
      - {box: {center: [0, 0, 0], size: [1, 2, 3]}}
      - {cylinder: {center: [0, 0, 0], axis: [1, 0, 0], radius: 2, height: 9}}
      - transform:
          field: {complement: {ellipsoid: {center: [0, 0, 0], radii: [1, 2, 3]}}}
          translate: [1, 2, 3]
          rotate: {axis: [0, 1, 0], degrees: -30}
  bone: {union: [{mesh: {file: bone.stl, units: mm, voxel: 0.5}}, {grid: {file: 'it''s.vdb', name: a}}]}
  knob:
    smooth_union:
      radius: 2
      fields:
        - {smooth_difference: {fields: [{cone: {base: [0, 0, 0], axis: [0, 0, 1], radius: 2, height: 3}}], radius: 1}}
        - {scale: {field: {offset: {field: {shell: {field: ball, thickness: 1}}, distance: -1}}, factor: 2}}
        - {rounded_box: {center: [0, 0, 0], size: [9, 9, 9], rounding: 1}}
        - {torus: {center: [0, 0, 0], axis: [0, 0, 1], radius: 9, tube: 2}}
        - {capsule: {from: [0, 0, 0], to: [0, 0, 9], radius: 1}}
        - {heart: {center: [0, 0, 0], width: 9}}
        - {quadric: {center: [0, 0, 0], xx: 1, z: 2, constant: -9, reach: 9 mm}}
        - {gyroid: {center: [0, 0, 0], period: 9, thickness: 1}}
        - {metaballs: {fall_off: gaussian, iso: 0.5, balls: [{center: [0, 0, 0], radius: 9, strength: 1}]}}
images: {scan: {file: "a\u00e9.nii.gz", names: names.txt}}
materials:
  glass: {stiffness: 1500 N/m, damping: 1 N.s/m, friction: {static: 0.2, kinetic: 0.15}, texture: {amplitude: 0.1, wavelength: 2}, shading: 1 mm}
  syrup: {viscosity: 4 N.s/m, flow: [1 mm/s, 0 m/s, 0 m/s]}
layers:
  - {name: liquid, inside: {intersection: [ball, brim]}, content: syrup, wall: glass}
  - {name: grain, labels: {image: scan, match: ["a*", 3]}, wall: absent}
  - {name: bright, threshold: {image: scan, above: 10, keep: largest, fill: true}}
walls:
  - {between: [liquid, "gr*"], wall: glass, felt_from: liquid}
ports:
  - {name: mouth, between: [outside, liquid], on: brim, direction: in, opens_at: 2.8 N, back: 1 N}
  - {name: deep, between: [liquid, grain], where: part, after: [mouth]}
sheets:
  - {name: foil, on: brim, where: ball, wall: glass}
start: {region: outside}
)";

// True if it is read, false if it is refused with a place: anything else leaves this function by an
// exception or a crash.
bool reads(std::string_view text, const SceneRegistry& registry) {
  try {
    (void)parseScene(text, "test.yaml", registry);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_GT(error.problem().line, 0) << error.what();
    EXPECT_GT(error.problem().column, 0) << error.what();
    EXPECT_FALSE(error.problem().code.empty());
    return false;
  }
}

TEST(DamagedScene, TheSceneItselfIsRead) {
  EXPECT_NO_THROW((void)parseScene(kScene, "test.yaml", standInReaders()));
}

TEST(DamagedScene, EveryTruncation) {
  const SceneRegistry registry = standInReaders();
  std::size_t refused = 0;
  for (std::size_t length = 0; length < kScene.size(); ++length) {
    if (!reads(kScene.substr(0, length), registry)) ++refused;
  }
  // The remaining text may well be a scene (if lines at the end of the file were cut off), but
  // rarely.
  EXPECT_GT(refused, kScene.size() * 8 / 10);
}

TEST(DamagedScene, EveryByteLeftOut) {
  const SceneRegistry registry = standInReaders();
  for (std::size_t i = 0; i < kScene.size(); ++i) {
    std::string text(kScene);
    text.erase(i, 1);
    (void)reads(text, registry);
  }
}

TEST(DamagedScene, EveryByteReplacedByWhatYamlCaresAbout) {
  const SceneRegistry registry = standInReaders();
  constexpr std::string_view kCared("[]{}:,-?*&!|>'\"%@`#~ \n\t\0\\0\xFF", 27);
  std::string text(kScene);
  for (std::size_t i = 0; i < kScene.size(); ++i) {
    // Two mutations at each place, in turn: all of them at each place take half a minute and never
    // found more.
    for (const std::size_t k : {2 * i, 2 * i + 1}) {
      text[i] = kCared[k % kCared.size()];
      (void)reads(text, registry);
    }
    text[i] = kScene[i];
  }
}

TEST(DamagedScene, RandomDamage) {
  const SceneRegistry registry = standInReaders();
  std::mt19937 random(5);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int round = 0; round < 2000; ++round) {
    std::string text(kScene);
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
      const std::size_t at = below(text.size());
      const std::size_t length = 1 + below(20);
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, text.substr(below(text.size()), length));
          break;
        default:
          text.insert(at, length, "[{- \n"[below(5)]);
          break;
      }
      if (text.empty()) text = "a";
    }
    (void)reads(text, registry);
  }
}

}  // namespace
}  // namespace palpate
