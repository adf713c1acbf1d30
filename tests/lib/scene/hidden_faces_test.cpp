// Which faces a port can name after blends, scale, offset and shell have made new ones.

#include <gtest/gtest.h>

#include "lib/scene/problems.h"
#include "palpate/interior/partition.h"
#include "palpate/scene/scene.h"

namespace palpate {
namespace {

// A bowl and its brim, combined into the liquid by `inside`, with a mouth that is `on` a field.
std::string text(const std::string& inside, const std::string& on) {
  return "palpate: 1\nlength: mm\nfields:\n"
         "  bowl: {sphere: {center: [0, 0, 0], radius: 40}}\n"
         "  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}\n"
         "  cup: {intersection: [bowl, brim]}\n"
         "  made: " +
         inside +
         "\n"
         "layers: [{name: liquid, inside: made}]\n"
         "ports: [{name: mouth, between: [outside, liquid], on: " +
         on + "}]\n";
}

Problem refusal(const std::string& inside, const std::string& on) {
  return problemOf([&] { (void)compile(parseScene(text(inside, on), "test.yaml")); });
}

TEST(HiddenFaces, AreExplained) {
  struct Case {
    const char* inside;
    const char* on;
    const char* kind;
  };
  for (const Case& c :
       {Case{"{smooth_intersection: {fields: [bowl, brim], radius: 3}}", "brim",
             "smooth_intersection"},
        // These shapes refer to a name that was defined before.
        Case{"{scale: {field: cup, factor: 2}}", "brim", "scale"},
        Case{"{offset: {field: {complement: {complement: cup}}, distance: 1}}", "brim", "offset"},
        Case{"{smooth_union: {fields: [cup, bowl], radius: 3}}", "cup", "smooth_union"}}) {
    const Problem problem = refusal(c.inside, c.on);
    SCOPED_TRACE(formatProblem(problem));
    EXPECT_EQ(problem.code, "scene.port_face");
    EXPECT_EQ(problem.line, 9);
    EXPECT_NE(
        problem.hint.find("'" + std::string(c.on) + "' is part of the " + c.kind + " in line 7"),
        std::string::npos);
    EXPECT_NE(problem.hint.find("where"), std::string::npos);
  }
}

TEST(HiddenFaces, WhatIsNowhereIsNotExplainedAway) {
  const Problem problem = problemOf([&] {
    (void)compile(parseScene(text("cup", "other") + "\nmaterials: {m: {}}\n", "test.yaml"));
  });
  EXPECT_EQ(problem.code, "scene.unknown_field");
}

// The fields that can be named: the whole result, and the outer faces of a shell.
TEST(HiddenFaces, TheWholeCanBeNamed) {
  for (const std::string inside :
       {"{smooth_intersection: {fields: [bowl, brim], radius: 3}}",
        "{scale: {field: cup, factor: 2}}", "{offset: {field: cup, distance: 1}}"}) {
    const ScenePtr scene = compile(parseScene(text(inside, "made"), "test.yaml"));
    EXPECT_FALSE(scene->ports()[0].on.empty()) << inside;
    EXPECT_TRUE(scene->regions()[1].reachable) << inside;
  }
  const ScenePtr shell =
      compile(parseScene(text("{shell: {field: cup, thickness: 3}}", "brim"), "test.yaml"));
  EXPECT_EQ(shell->ports()[0].on.size(), 1U);
}

TEST(HiddenFaces, ABlendIsOneLeaf) {
  const ScenePtr blend = compile(parseScene(
      text("{smooth_intersection: {fields: [bowl, brim], radius: 3}}", "made"), "test.yaml"));
  EXPECT_EQ(blend->partition().leaves().size(), 1U);
  const ScenePtr scaled =
      compile(parseScene(text("{scale: {field: cup, factor: 2}}", "made"), "test.yaml"));
  EXPECT_EQ(scaled->partition().leaves().size(), 2U);
  const ScenePtr shell =
      compile(parseScene(text("{shell: {field: cup, thickness: 3}}", "bowl"), "test.yaml"));
  EXPECT_EQ(shell->partition().leaves().size(), 4U);
}

// One name both inside and outside a blend: the face that still exists is found.
TEST(HiddenFaces, AFieldUsedTwiceKeepsItsOwnFace) {
  const ScenePtr scene = compile(parseScene(
      text("{intersection: [brim, {smooth_union: {fields: [cup, bowl], radius: 3}}]}", "brim"),
      "test.yaml"));
  EXPECT_EQ(scene->ports()[0].on.size(), 1U);
}

}  // namespace
}  // namespace palpate
