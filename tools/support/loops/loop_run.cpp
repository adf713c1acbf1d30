#include "support/loops/loop_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "palpate/devices/simulated_device.h"
#include "palpate/devices/velocity.h"

namespace palpate::loops {
namespace {

/// The forces of some successive ticks.
class Window {
 public:
  void add(const Vec3& force) { forces_.push_back(force); }

  [[nodiscard]] Vec3 mean() const {
    Vec3 sum(0.0);
    for (const Vec3& force : forces_) sum += force;
    return forces_.empty() ? sum : sum / static_cast<double>(forces_.size());
  }
  /// The component with the largest oscillation, and its peak to peak value [N].
  [[nodiscard]] std::pair<int, double> swing() const {
    Box3 box;
    for (const Vec3& force : forces_) box.include(force);
    if (forces_.empty()) return {0, 0.0};
    const Vec3 size = box.size();
    int most = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (size[axis] > size[most]) most = axis;
    }
    return {most, size[most]};
  }
  /// [1/tick] How often a component crosses its mean upwards.
  [[nodiscard]] double turns(int axis) const {
    const double middle = mean()[axis];
    int count = 0;
    for (std::size_t k = 1; k < forces_.size(); ++k) {
      if (forces_[k - 1][axis] < middle && forces_[k][axis] >= middle) ++count;
    }
    return forces_.size() > 1 ? count / static_cast<double>(forces_.size() - 1) : 0.0;
  }

 private:
  std::vector<Vec3> forces_;
};

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LoopOutcome runLoop(HapticRenderer& renderer, const LoopSetting& setting, double wall) {
  renderer.reset();
  const devices::LoopModel& loop = setting.loop;
  devices::SimulatedDevice device(
      {.device = loop.device, .hand = loop.hand, .rate = 1.0 / loop.period, .delay = loop.delay},
      setting.hand, devices::DeviceFrame::kWorld);
  devices::VelocityTracker velocity(loop.velocity);
  LoopOutcome out;
  Window last;
  Window before;
  std::vector<double> times;
  const double end = setting.hand.back().t;
  std::size_t in_window = 0;
  Vec3 first(0.0);
  bool has_first = false;
  Vec3 position(0.0);
  Vec3 force(0.0);
  bool has_begun = false;
  double longest = 0.0;
  double strongest = 0.0;
  device.open();
  devices::DeviceState state;
  std::uint64_t ticks = 0;
  std::minstd_rand random(1);
  while (device.read(state) == devices::DeviceStatus::kOk) {
    for (int axis = 0; setting.is_noisy && axis < 3; ++axis) {
      state.position[axis] += (static_cast<double>(random() % 3) - 1.0) * loop.device.encoder;
    }
    if (setting.poll && ticks++ % LoopSetting::kPollTicks == 0) setting.poll();
    const HipState hip{state.position, velocity.add(state.time, state.position).value, loop.period};
    const auto begin = std::chrono::steady_clock::now();
    const TickResult result = renderer.update(hip);
    const auto done = std::chrono::steady_clock::now();
    const Vec3 now = setting.gain * result.force;
    if (!isFinite(now) || !isFinite(state.position) || glm::length(state.position) > 1.0) {
      out.is_lost = true;
      break;
    }
    (void)device.write(now);
    if (has_begun) {
      longest = std::max(longest, glm::distance(state.position, position));
      out.largest_step = std::max(out.largest_step, glm::distance(now, force));
    }
    has_begun = true;
    position = state.position;
    force = now;
    strongest = std::max(strongest, glm::length(now));
    const devices::DeviceWork work = device.work();
    out.to_hand = std::max(out.to_hand, work.given());
    out.by_motors = std::max(out.by_motors, work.motor);
    if (result.contact) {
      times.push_back(std::chrono::duration<double, std::nano>(done - begin).count());
      if (!has_first) first = state.position;
      has_first = true;
    }
    if (state.time > end - setting.window) {
      last.add(now);
      out.depth += glm::distance(state.position, first);
      ++in_window;
      out.touches = out.touches || now != Vec3(0.0);
    } else if (state.time > end - 2.0 * setting.window) {
      before.add(now);
    }
  }
  device.close();
  const auto [axis, swing] = last.swing();
  out.chatter = swing;
  out.before = before.swing().second;
  out.frequency = last.turns(axis) / loop.period;
  out.mean = glm::length(last.mean());
  out.depth = in_window > 0 ? out.depth / static_cast<double>(in_window) : 0.0;
  out.tick_cost = setting.gain * wall * longest * longest + strongest * longest;
  out.tick_ns = medianOf(std::move(times));
  return out;
}

double depthOfForce(const devices::LoopModel& loop, double stiffness, double force) {
  double give = 1.0 / stiffness;  // [m/N] compliance of wall, hand and grip in series
  if (loop.hand && loop.hand->stiffness > 0.0) give += 1.0 / loop.hand->stiffness;
  if (loop.hand && loop.hand->grip_stiffness > 0.0) give += 1.0 / loop.hand->grip_stiffness;
  return force * give;
}

devices::Path pressOn(const Vec3& at, const Vec3& out, double depth, double hold, Motion motion) {
  constexpr double kAbove = 2e-3;  // [m]
  constexpr double kSlow = 0.02;   // [m/s]
  constexpr double kFast = 0.5;    // [m/s]
  constexpr double kDrag = 10e-3;  // [m]
  const Vec3 goal = at - depth * out;
  double t = (kAbove + depth) / (motion == Motion::kTap ? kFast : kSlow);
  devices::Path path = {{0.0, at + kAbove * out}, {t, goal}};
  if (motion == Motion::kDrag) {
    const Vec3 along = unitOr(glm::cross(out, Vec3(0.0, 1.0, 0.0)), Vec3(1.0, 0.0, 0.0));
    path.push_back({t += 0.3, goal});
    path.push_back({t += kDrag / kFast, goal + kDrag * along});
    path.push_back({t += kDrag / kFast, goal});
  }
  path.push_back({t + hold, goal});
  return path;
}

double largestGain(const std::function<bool(double)>& is_stable, double low, double high) {
  if (!is_stable(low)) return 0.0;
  // First upwards in steps: a limit cycle may occur at some stiffness and vanish at a higher one.
  double good = low;
  double next = 1.5 * low;
  while (next < high && is_stable(next)) {
    good = next;
    next *= 1.5;
  }
  double bad = std::min(next, high);
  while (bad > 1.01 * good) {
    const double middle = std::sqrt(good * bad);
    (is_stable(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace palpate::loops
