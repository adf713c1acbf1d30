#include "support/loops/hard_scene.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "palpate/scene/scene_file.h"

namespace palpate::loops {
namespace {

std::string sceneText(const std::string& layers, const std::string& more_of_wall = {}) {
  return "palpate: 1\nlength: mm\nmaterials:\n  wall: {stiffness: 1000 N/m" + more_of_wall +
         "}\nlayers:\n" + layers;
}

std::string layer(const std::string& name, const std::string& inside) {
  return "  - {name: " + name + ", inside: " + inside + ", wall: wall}\n";
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

const std::string kBlock = "{box: {center: [0, 0, -25], size: [100, 100, 50]}}";

/// A groove along y whose walls enclose `degrees`, its bottom at the origin.
HardScene groove(double degrees) {
  const double half = 0.5 * degrees * std::numbers::pi / 180.0;
  const auto side = [&](double sign) {
    return "{half_space: {point: [0, 0, 0], normal: [" + number(sign * std::cos(half)) + ", 0, " +
           number(std::sin(half)) + "]}}";
  };
  const std::string cut =
      "{intersection: [{box: {center: [0, 0, 0], size: [200, 200, 60]}}, {union: [" + side(1.0) +
      ", " + side(-1.0) + "]}]}";
  return {"groove-" + number(degrees), "V-groove of " + number(degrees) + " degrees",
          sceneText(layer("groove", cut)), Vec3(0.0), Vec3(0.0, 0.0, 1.0)};
}

std::vector<HardScene> allScenes() {
  const Vec3 up(0.0, 0.0, 1.0);
  std::vector<HardScene> all;
  all.push_back({"flat", "flat wall", sceneText(layer("block", kBlock)), Vec3(0.0), up});
  for (const double radius : {50e-3, 20e-3, 5e-3, 1e-3, 0.5e-3}) {
    all.push_back(ballScene(radius, false));
    all.push_back(ballScene(radius, true));
  }
  all.push_back({"edge", "edge of a box from outside",
                 sceneText(layer("box", "{box: {center: [-20, 0, -20], size: [40, 100, 40]}}")),
                 Vec3(-1e-3, 0.0, 0.0), up});
  all.push_back({"corner-out", "corner of a box from outside",
                 sceneText(layer("box", "{box: {center: [-20, -20, -20], size: [40, 40, 40]}}")),
                 Vec3(-0.5e-3, -0.5e-3, 0.0), up});
  all.push_back(
      {"edge-within", "edge of a room from within",
       sceneText(layer("rock",
                       "{difference: [{box: {center: [0, 0, 0], size: [120, 120, 120]}}, {box: "
                       "{center: [20, 0, 20], size: [40, 60, 40]}}]}")),
       Vec3(0.0), Vec3(std::sqrt(0.5), 0.0, std::sqrt(0.5))});
  all.push_back(
      {"corner", "corner of three walls from within",
       sceneText(layer("rock",
                       "{difference: [{box: {center: [0, 0, 0], size: [120, 120, 120]}}, {box: "
                       "{center: [20, 20, 20], size: [40, 40, 40]}}]}")),
       Vec3(0.0), Vec3(1.0, 1.0, 1.0) / std::sqrt(3.0)});
  for (const double degrees : {2.0, 5.0, 10.0, 45.0}) all.push_back(groove(degrees));
  all.push_back(
      {"cone", "into a cone's apex",
       sceneText(
           layer("rock",
                 "{difference: [{box: {center: [0, 0, 0], size: [100, 100, 60]}}, {cone: {base: "
                 "[0, 0, 30], axis: [0, 0, -1], radius: 20, height: 30}}]}")),
       Vec3(0.0), up});
  all.push_back(
      {"saddle", "between the bumps of a ring",
       sceneText(
           layer("ring", "{torus: {center: [0, 0, 0], axis: [0, 0, 1], radius: 30, tube: 10}}")),
       Vec3(0.02, 0.0, 0.0), Vec3(-1.0, 0.0, 0.0)});
  all.push_back({"two-balls", "where two balls touch",
                 sceneText(layer("left", "{sphere: {center: [-15, 0, 0], radius: 15}}") +
                           layer("right", "{sphere: {center: [15, 0, 0], radius: 15}}")),
                 Vec3(0.5e-3, 0.0, 3.84e-3), up});
  all.push_back({"plate", "plate of 1 mm between two others",
                 sceneText(layer("lower", "{box: {center: [0, 0, -6], size: [100, 100, 6]}}") +
                           layer("plate", "{box: {center: [0, 0, -0.5], size: [100, 100, 1]}}") +
                           layer("upper", "{box: {center: [0, 40, 3], size: [100, 40, 6]}}")),
                 Vec3(0.0), up});
  all.push_back({"neck", "neck of two metaballs",
                 sceneText(layer("blob",
                                 "{metaballs: {fall_off: wyvill, iso: 0.4, balls: [{center: [-9, "
                                 "0, 0], radius: 20}, {center: "
                                 "[9, 0, 0], radius: 20}]}}")),
                 Vec3(0.0, 0.0, 9.2e-3), up});
  all.push_back({"cleft", "into the cleft of a heart",
                 sceneText(layer("heart", "{heart: {center: [0, 0, 0], width: 40}}")),
                 Vec3(0.0, 0.0, 17.4e-3), up});
  HardScene rim{
      "rim", "on the wall at the rim of an open port",
      sceneText(layer("block", kBlock)) +
          "ports:\n  - {name: hole, between: [outside, block], where: {cylinder: {center: "
          "[0, 0, 0], axis: [0, 0, 1], radius: 5, height: 20}}}\n",
      Vec3(5.0005e-3, 0.0, 0.0), up};
  rim.is_ours = true;
  all.push_back(rim);
  for (const double coefficient : {0.05, 0.8, 1.2}) {
    const std::string mu = number(coefficient);
    HardScene friction{
        "friction-" + mu, "flat wall with friction " + mu,
        sceneText(layer("block", kBlock), ", friction: {static: " + mu + ", kinetic: " + mu + "}"),
        Vec3(0.0), up};
    friction.friction = coefficient;
    friction.is_ours = true;
    all.push_back(friction);
  }
  HardScene texture{
      "texture", "textured wall with friction",
      sceneText(
          layer("block", kBlock),
          ", friction: {static: 0.3, kinetic: 0.2}, texture: {amplitude: 0.05, wavelength: 2}"),
      Vec3(0.0), up};
  texture.friction = 0.3;
  texture.is_ours = true;
  all.push_back(texture);
  return all;
}

}  // namespace

HardScene ballScene(double radius, bool is_hollow) {
  const std::string mm = number(1e3 * radius);
  const Vec3 up(0.0, 0.0, 1.0);
  if (!is_hollow) {
    return {"ball-" + mm,
            "ball of R " + mm + " mm",
            sceneText(layer("ball", "{sphere: {center: [0, 0, 0], radius: " + mm + "}}")),
            Vec3(0.0, 0.0, radius),
            up,
            1.0 / radius};
  }
  const std::string size = number(4e3 * radius + 60.0);
  return {"hollow-" + mm, "within a ball of R " + mm + " mm",
          sceneText(layer("rock", "{difference: [{box: {center: [0, 0, 0], size: [" + size + ", " +
                                      size + ", " + size +
                                      "]}}, {sphere: {center: [0, 0, 0], radius: " + mm + "}}]}")),
          Vec3(0.0, 0.0, -radius), up};
}

const std::vector<HardScene>& hardScenes() {
  static const std::vector<HardScene> all = allScenes();
  return all;
}

ScenePtr compileHardScene(const HardScene& scene) {
  return compile(parseScene(scene.text, scene.name + ".yaml"));
}

}  // namespace palpate::loops
