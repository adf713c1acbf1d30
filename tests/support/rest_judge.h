#pragma once
// One renderer, judged tick by tick by what it says to the outside: where the proxy is and what the
// force is.

#include <array>
#include <string>

#include "palpate/render/haptic_renderer.h"
#include "support/rest_oracle.h"

namespace palpate::testing {

/// What is wrong with a tick, the gravest first.
enum class Fault {
  kNone,
  kNotFinite,
  kRegion,   ///< it left its region, though nothing is open
  kInside,   ///< the proxy is inside a wall
  kForce,    ///< the force is not K (x - P)
  kContact,  ///< `contact` does not say whether the proxy is off the hand
  kStep,     ///< not at the minimum, and the force is more than 10 mN off
  kPlace,    ///< not at the minimum, by more than 1e-6 of the depth
  kFrozen,   ///< the hand stood still: not settled after 30 ticks, or the force still changes by 1
             ///< mN
  kCount
};
[[nodiscard]] const char* nameOf(Fault fault);

struct Verdict {
  Fault fault = Fault::kNone;
  bool is_contact = false;
  bool is_ambiguous = false;  ///< several ends, of which it is near one or none
  bool is_unjudged = false;   ///< the oracle does not know
  bool ran_oracle = false;
  bool is_minimum = true;  ///< nothing near the proxy is nearer to the hand
  int touching = 0;        ///< walls that hold it
  bool has_kink = false;   ///< ... one of them at an apex or a crease of its own
  double off = 0.0;        ///< [m] from the minimum, or [N] of the force: what the fault is by
};

/// What a tick says about itself; true of a library whose ticks say nothing.
template <typename Result>
[[nodiscard]] bool saysSettled(const Result& result) {
  if constexpr (requires { result.settled; }) {
    return result.settled;
  } else {
    return true;
  }
}

/// Where it happened and in what way, for a list.
[[nodiscard]] std::string causeOf(const Verdict& verdict);

class RestJudge {
 public:
  /// [-] of the depth, of the proxy; and of the force.
  static constexpr double kTolerance = 1e-6;

  RestJudge(const RegionTree& tree, RegionId region, double stiffness)
      : tree_(tree), oracle_(tree), region_(region), stiffness_(stiffness) {}

  /// `previous`: of the tick before. `sampled`: looks at more than first-order conditions.
  [[nodiscard]] Verdict judge(const TickResult& before, const Vec3& previous_hip,
                              const TickResult& now, const Vec3& hip, bool sampled) const;

  /// [m] Nearer than this to the hand, the proxy is at the hand.
  [[nodiscard]] double atHand() const { return 4.0 * tree_.onSurface(); }

 private:
  [[nodiscard]] bool isDirect(const Vec3& from, const Vec3& to, double moved) const;

  const RegionTree& tree_;
  RestOracle oracle_;
  RegionId region_;
  double stiffness_;
};

}  // namespace palpate::testing
