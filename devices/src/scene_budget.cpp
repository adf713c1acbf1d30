#include "palpate/devices/scene_budget.h"

#include <cmath>
#include <functional>
#include <map>

#include "closed_loop.h"
#include "palpate/devices/device_presets.h"

namespace palpate::devices {
namespace {

constexpr double kHighestRate = 1e5;  // [Hz]

/// Whether a loop can hold the wall with the margin of the budget.
bool fits(const LoopModel& loop, const WallModel& wall) {
  const double spare = 1.0 / StabilityBudget::kShare;
  if (wall.stiffness == 0.0) return ClosedLoop(loop).isStable({0.0, spare * wall.damping});
  return wall.stiffness <= frictionStiffness(loop.device) &&
         ClosedLoop(loop).isStable({spare * wall.stiffness, wall.damping});
}

/// The value between `bad`, where `holds` is false, and `good`, where it is true, at which it
/// becomes true; to 0.1 %.
double between(double bad, double good, const std::function<bool(double)>& holds) {
  while (std::fabs(good - bad) > 1e-3 * std::fmax(good, bad)) {
    const double middle = std::sqrt(good * bad);
    (holds(middle) ? good : bad) = middle;
  }
  return good;
}

double rateFor(const LoopModel& loop, const WallModel& wall) {
  const auto holds = [&](double rate) {
    LoopModel faster = loop;
    faster.period = 1.0 / rate;
    return fits(faster, wall);
  };
  // A rate above a sufficient one need not be sufficient: the device dissipates less in each tick,
  // and may hold less drag.
  const double now = 1.0 / loop.period;
  double last = now;
  for (double rate = now; rate < kHighestRate;) {
    rate = std::fmin(1.25 * rate, kHighestRate);
    if (holds(rate)) return between(last, rate, holds);
    last = rate;
  }
  return kInfinity;
}

double forceFor(const LoopModel& loop, const WallModel& wall) {
  const auto holds = [&](double share) {
    return fits(loop, {share * wall.stiffness, share * wall.damping});
  };
  constexpr double kLeast = 1e-6;
  return holds(kLeast) ? between(1.0, kLeast, holds) : 0.0;
}

void cure(BudgetItem& each, const LoopModel& loop) {
  const WallModel& wall = each.item.most;
  each.rate = rateFor(loop, wall);
  each.force = forceFor(loop, wall);
  each.missing_damping = missingDamping(loop, wall);
  for (const HandPreset& hand : handPresets()) {
    if (loop.hand && loop.hand->name == hand.name) continue;
    LoopModel held = loop;
    held.hand = hand.model;
    if (fits(held, wall)) each.hands.emplace_back(hand.name);
  }
}

}  // namespace

std::vector<BudgetItem> sceneBudget(const Scene& scene, const LoopModel& loop) {
  std::map<double, StabilityBudget> budgets;  // by damping
  const double most_drag = StabilityBudget::kShare * largestDamping(loop);
  std::vector<BudgetItem> all;
  for (FeltItem& item : feltItems(scene, loop.device)) {
    BudgetItem each;
    each.item = std::move(item);
    const WallModel& wall = each.item.most;
    const auto [at, is_new] = budgets.try_emplace(wall.damping);
    if (is_new) at->second = budgetOf(loop, wall.damping);
    each.budget = at->second;
    const bool is_spring = wall.stiffness > 0.0;
    each.allowed = is_spring ? each.budget.stiffness() : most_drag;
    const double asked = is_spring ? wall.stiffness : wall.damping;
    each.share = each.allowed > 0.0 ? asked / each.allowed : kInfinity;
    if (each.isAbove()) {
      if (is_spring) each.quiet_speed = quietSpeed(loop, wall);
      cure(each, loop);
    }
    all.push_back(std::move(each));
  }
  return all;
}

}  // namespace palpate::devices
