#pragma once
/// Hard cases for a hand in the loop: a shape, the place where it is pressed, and the direction.

#include <string>
#include <vector>

#include "palpate/scene/scene.h"

namespace palpate::loops {

struct HardScene {
  std::string name;
  std::string about;  ///< for people
  std::string text;   ///< of the scene file, in mm; every wall has 1000 N/m
  Vec3 at{0.0};       ///< [m] on the surface
  Vec3 out{0.0};      ///< [-] unit vector out of the surface; the hand presses against it
  /// [1/m] Curvature of a frictionless convex surface: the hand has to resist sliding off with a
  /// lateral stiffness of F / (R - d), R = 1 / curvature. 0: flat, hollow, or held by an edge.
  double curvature = 0.0;
  /// [-] Static and kinetic friction of the wall.
  double friction = 0.0;
  /// Uses features that only the constraint renderer has: friction, texture, ports
  bool is_ours = false;
};

/// The stiffness of every wall of hardScenes() [N/m].
inline constexpr double kHardStiffness = 1000.0;

[[nodiscard]] const std::vector<HardScene>& hardScenes();
/// @throws Error (kInput) if the text has a mistake.
[[nodiscard]] ScenePtr compileHardScene(const HardScene& scene);

/// A ball of `radius` [m], felt from outside, or with `is_hollow` from within.
[[nodiscard]] HardScene ballScene(double radius, bool is_hollow);

}  // namespace palpate::loops
