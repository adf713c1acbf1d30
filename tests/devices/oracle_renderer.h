#pragma once
/// The brute-force oracle's proxy as a renderer, to be used in the same loop as the constraint
/// renderer.

#include <utility>
#include <vector>

#include "support/oracle/oracle.h"
#include "support/rivals/rival_renderer.h"

namespace palpate::loops {

/// The spring to the oracle's proxy, with the stiffness of the scene's first solid. Slow, and
/// allocates.
class OracleRenderer final : public rivals::RivalRenderer {
 public:
  /// The proxy stays outside all solids of the scene.
  explicit OracleRenderer(ScenePtr scene) : RivalRenderer(std::move(scene)) {
    std::vector<oracle::FeasibleSet> all;
    for (const rivals::Solid& solid : solids()) {
      all.push_back(oracle::FeasibleSet::outside(solid.field));
    }
    set_ = oracle::FeasibleSet::allOf(all);
  }

  /// The proxy stays in `set`.
  OracleRenderer(ScenePtr scene, oracle::FeasibleSet set)
      : RivalRenderer(std::move(scene)), set_(std::move(set)) {}

 private:
  void forget() noexcept override { has_begun_ = false; }

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    const bool has_begun = std::exchange(has_begun_, true);
    if (!has_begun) proxy_ = hip.position;
    // While the hand rests, the proxy is at its minimum already.
    if (!has_begun || hip.position != hand_) {
      proxy_ = oracle::solveOracle(set_, proxy_, hip.position).proxy;
    }
    hand_ = hip.position;
    if (glm::distance(proxy_, hip.position) < 1e-12) return untouched(hip);
    return spring(hip, proxy_, solids().front(), region());
  }

  oracle::FeasibleSet set_;
  Vec3 proxy_{0.0, 0.0, 0.0};  ///< [m]
  Vec3 hand_{0.0, 0.0, 0.0};   ///< [m] at the last tick
  bool has_begun_ = false;
};

}  // namespace palpate::loops
