#pragma once
/// A virtual coupling: a spring and a damper between the hand and the tool that touches the scene,
/// so that the device never meets a stiffer or a more damped wall than it can hold.

#include <type_traits>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::devices {

/// The spring and the damper of a VirtualCoupling, at the hand.
struct CouplingSettings {
  double stiffness = 0.0;  ///< [N/m] K_c, above 0
  double damping = 0.0;    ///< [N s/m] B_c, 0 or more
};

/// The scene's force on the tool, and its derivatives by the tool's motion. A derivative that is
/// not known may be 0: the coupling then needs more ticks to settle, and settles as long as the
/// true slope is below K_c + B_c / T.
struct ToolForce {
  Vec3 force{0.0, 0.0, 0.0};   ///< [N] with all dampers
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit, out of the wall that holds the tool; zero: none
  double stiffness = 0.0;      ///< [N/m] against a motion along `normal`
  double sideways = 0.0;       ///< [N/m] against a motion across `normal`, from a wall that sticks
  double damping = 0.0;        ///< [N s/m] along `normal`
  double drag = 0.0;           ///< [N s/m] along any direction
};

/// Where the tool is and how it moves.
struct ToolMotion {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m]
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s]
};

/// The tool has no mass: at each tick it is at the place where the coupling's force equals that of
/// the scene. By backward Euler,
///   K_c (x - h_k) + B_c ((x - x_{k-1}) - (h_k - h_{k-1})) / T = F(x, (x - x_{k-1}) / T),
/// with h the hand and x the tool. reach() solves this with the scene's last answer, the scene is
/// evaluated at the result, and push() makes one more step of Newton's method with the new answer.
/// That is exact for a flat wall of any stiffness and damping, and for anything at rest. In free
/// motion the tool is at the hand, and no force is felt.
///
/// The price is that a wall of stiffness K is felt as 1 / (1 / K + 1 / K_c). A value type;
/// real-time safe.
class PALPATE_EXPORT VirtualCoupling {
 public:
  /// @throws Error (kUsage, coupling.*) for a value out of its range.
  explicit VirtualCoupling(const CouplingSettings& settings);

  /// The hand is at `hand` [m], `dt` [s] after the last time; if `dt` is not above 0, the one
  /// before is used again. Returns where the scene is to be evaluated.
  [[nodiscard]] ToolMotion reach(const Vec3& hand, double dt) noexcept;
  /// [N] The force on the hand, given the scene's answer at the result of reach(). It never pulls
  /// into the wall, against `answer.normal`.
  [[nodiscard]] Vec3 push(const ToolForce& answer) noexcept;

  /// [N/m] The stiffness that the hand feels at rest on a wall of `stiffness` [N/m].
  [[nodiscard]] double felt(double stiffness) const noexcept {
    return stiffness * settings_.stiffness / (stiffness + settings_.stiffness);
  }

  /// The scene was replaced: the next reach() begins anew, with the tool at the hand.
  void letGo() noexcept { has_begun_ = false; }

  /// [m] The position of the tool, after push().
  [[nodiscard]] const Vec3& tool() const noexcept { return tool_; }

 private:
  CouplingSettings settings_;
  bool has_begun_ = false;
  double per_time_ = 0.0;     ///< [1/s] 1 / T of this tick
  double slope_ = 0.0;        ///< [N/m] K_c + B_c / T
  double give_ = 0.0;         ///< [m/N] 1 / slope_
  double share_ = 0.0;        ///< [-] share of the slope that is due to the damper
  Vec3 hand_{0.0, 0.0, 0.0};  ///< [m]
  Vec3 free_{0.0, 0.0, 0.0};  ///< [m] where the tool would be without the scene's force
  Vec3 tool_{0.0, 0.0, 0.0};  ///< [m] after the last tick
  ToolMotion asked_;          ///< the last result of reach()
  ToolForce answer_;          ///< the answer to it, without dampers
};

static_assert(std::is_trivially_copyable_v<VirtualCoupling>);

}  // namespace palpate::devices
