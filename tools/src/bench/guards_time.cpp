#include "bench/guards_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "palpate/devices/passivity.h"
#include "palpate/devices/virtual_coupling.h"

namespace palpate::tools {
namespace {

constexpr int kTicks = 4000;
constexpr double kTick = 1e-3;  // [s]

/// Runs the guards along the path; the sum that it returns depends on every tick.
double run(const std::vector<Vec3>& path) {
  devices::PassivityController guard(
      {.mass = 0.2, .damping = 0.5, .friction = 0.1, .encoder = 1e-5, .hand_force = 5.0});
  devices::VirtualCoupling coupling({800.0, 4.0});
  double sum = 0.0;
  double time = 0.0;
  for (const Vec3& hand : path) {
    // As with a clock, rounding makes successive periods differ in their last bits.
    const double dt = (time + kTick) - time;
    time += kTick;
    const devices::ToolMotion tool = coupling.reach(hand, dt);
    devices::ToolForce answer;
    if (tool.position.z < 0.0) {
      answer.normal = Vec3(0.0, 0.0, 1.0);
      answer.stiffness = 5000.0;
      answer.force.z = -5000.0 * tool.position.z;
    }
    sum +=
        guard.step(hand, dt, coupling.push(answer), coupling.felt(answer.stiffness), 0.0).force.z;
  }
  return sum;
}

}  // namespace

double guardsTime() {
  std::vector<Vec3> path;
  path.reserve(kTicks);
  for (int k = 0; k < kTicks; ++k) {
    path.emplace_back(1e-3 * std::sin(0.001 * k), 0.0, 1e-3 * std::sin(0.01 * k));
  }
  double least = kInfinity;
  volatile double kept = 0.0;
  for (int n = 0; n < 50; ++n) {
    const auto begin = std::chrono::steady_clock::now();
    kept = kept + run(path);
    const auto end = std::chrono::steady_clock::now();
    least = std::min(least, std::chrono::duration<double, std::nano>(end - begin).count() / kTicks);
  }
  return least;
}

}  // namespace palpate::tools
