#pragma once
// Judges one renderer tick by tick by its outputs alone: the place of the proxy, and the force.

#include <array>
#include <string>

#include "palpate/render/haptic_renderer.h"
#include "support/rest_oracle.h"

namespace palpate::testing {

/// The fault of a tick, the gravest first.
enum class Fault {
  kNone,
  kNotFinite,
  kRegion,   ///< the proxy left its region, though no port is open
  kInside,   ///< the proxy is inside a wall
  kForce,    ///< the force is not K (x - P)
  kContact,  ///< `contact` does not match whether the proxy is off the hand
  kStep,     ///< not at the minimum, and the force is more than 10 mN off
  kPlace,    ///< not at the minimum, by more than 1e-6 of the depth
  kFrozen,   ///< the hand stood still, but after 30 ticks the state is not settled, or the force
             ///< still changes by 1 mN
  kCount
};
[[nodiscard]] const char* nameOf(Fault fault);

struct Verdict {
  Fault fault = Fault::kNone;
  bool is_contact = false;
  /// There are several possible ends; the proxy is near one of them, or near none
  bool is_ambiguous = false;
  bool is_unjudged = false;  ///< the oracle cannot decide
  bool ran_oracle = false;
  bool is_minimum = true;  ///< no allowed point near the proxy is nearer to the hand
  int touching = 0;        ///< walls that hold it
  bool has_kink = false;   ///< ... one of them at an apex or a crease of its own
  double off = 0.0;        ///< [m] off the minimum, or [N] of the force: the size of the fault
};

/// Whether the tick reports that it settled; true for a library whose ticks do not report it.
template <typename Result>
[[nodiscard]] bool saysSettled(const Result& result) {
  if constexpr (requires { result.settled; }) {
    return result.settled;
  } else {
    return true;
  }
}

/// Place and kind of the fault, for a list.
[[nodiscard]] std::string causeOf(const Verdict& verdict);

class RestJudge {
 public:
  /// [-] Tolerance of the proxy, relative to the depth, and of the force.
  static constexpr double kTolerance = 1e-6;

  RestJudge(const RegionTree& tree, RegionId region, double stiffness)
      : tree_(tree), oracle_(tree), region_(region), stiffness_(stiffness) {}

  /// `previous`: of the tick before. `sampled`: also checks more than first-order conditions.
  [[nodiscard]] Verdict judge(const TickResult& before, const Vec3& previous_hip,
                              const TickResult& now, const Vec3& hip, bool sampled) const;

  /// [m] A proxy nearer to the hand than this counts as at the hand.
  [[nodiscard]] double atHand() const { return 4.0 * tree_.onSurface(); }

 private:
  [[nodiscard]] bool isDirect(const Vec3& from, const Vec3& to, double moved) const;

  const RegionTree& tree_;
  RestOracle oracle_;
  RegionId region_;
  double stiffness_;
};

}  // namespace palpate::testing
