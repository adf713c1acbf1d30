#pragma once
/// A virtual coupling: a spring and a damper between the hand and the tool that touches the scene,
/// so that the device never meets a stiffer or a more damped wall than it can hold.

#include <type_traits>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::devices {

struct CouplingSettings {
  double stiffness = 0.0;  ///< [N/m] K_c, above 0
  double damping = 0.0;    ///< [N s/m] B_c, 0 or more
};

/// The scene's force on the tool, and how it changes when the tool does. What is not known may be
/// 0: the coupling then needs more ticks to settle, and settles as long as the true slope is below
/// K_c + B_c / T.
struct ToolForce {
  Vec3 force{0.0, 0.0, 0.0};   ///< [N] with all dampers
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit, out of the wall that holds the tool; zero: none does
  double stiffness = 0.0;      ///< [N/m] against a motion along `normal`
  double sideways = 0.0;       ///< [N/m] against one across it: of a wall that sticks
  double damping = 0.0;        ///< [N s/m] along `normal`
  double drag = 0.0;           ///< [N s/m] along any direction
};

/// Where the tool is.
struct ToolMotion {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m]
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s]
};

/// The tool has no mass: at each tick it is where the coupling's force is that of the scene. That
/// is backward Euler,
///   K_c (x - h_k) + B_c ((x - x_{k-1}) - (h_k - h_{k-1})) / T = F(x, (x - x_{k-1}) / T),
/// with h the hand and x the tool. reach() solves it with what the scene answered last, the scene
/// is asked there, and push() takes one more step of Newton's with the new answer: exact for a flat
/// wall of any stiffness and damping, and for anything at rest. In free motion the tool is at the
/// hand, and no force is felt.
///
/// A wall K is felt as 1 / (1 / K + 1 / K_c): that is the price. A value; real-time safe.
class PALPATE_EXPORT VirtualCoupling {
 public:
  /// @throws Error (kUsage, coupling.*) for a value out of its range.
  explicit VirtualCoupling(const CouplingSettings& settings);

  /// The hand is at `hand` [m], `dt` [s] after the last time (of 0 or less: as long as then): where
  /// the scene is to be asked.
  [[nodiscard]] ToolMotion reach(const Vec3& hand, double dt) noexcept;
  /// [N] On the hand, for the scene's answer at what reach() said. It never pulls into
  /// `answer.normal`.
  [[nodiscard]] Vec3 push(const ToolForce& answer) noexcept;

  /// [N/m] What the hand feels of a wall of `stiffness` [N/m] at rest.
  [[nodiscard]] double felt(double stiffness) const noexcept {
    return stiffness * settings_.stiffness / (stiffness + settings_.stiffness);
  }

  /// The scene is another one: the next reach() begins anew, with the tool at the hand.
  void letGo() noexcept { has_begun_ = false; }

  /// [m] The tool, after push().
  [[nodiscard]] const Vec3& tool() const noexcept { return tool_; }

 private:
  CouplingSettings settings_;
  bool has_begun_ = false;
  double per_time_ = 0.0;     ///< [1/s] 1 / T of this tick
  double slope_ = 0.0;        ///< [N/m] K_c + B_c / T
  double give_ = 0.0;         ///< [m/N] 1 / slope_
  double share_ = 0.0;        ///< [-] of the slope that is the damper's
  Vec3 hand_{0.0, 0.0, 0.0};  ///< [m]
  Vec3 free_{0.0, 0.0, 0.0};  ///< [m] where the tool would be without a force of the scene
  Vec3 tool_{0.0, 0.0, 0.0};  ///< [m] after the last tick
  ToolMotion asked_;          ///< what reach() said
  ToolForce answer_;          ///< to it, without dampers
};

static_assert(std::is_trivially_copyable_v<VirtualCoupling>);

}  // namespace palpate::devices
