#include "fields/fall_off.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>

namespace palpate::fields {
namespace {

/// Branch and bound over boxes: the box with the largest bound is halved, until the bound is tight
/// to a twentieth or enough work was done.
class SteepestSum {
 public:
  SteepestSum(const std::vector<Metaball>& balls, FallOff fall_off)
      : balls_(balls), fall_off_(fall_off) {}

  double find() {
    // Farther than a radius from every ball all slopes decrease with distance, so the steepest
    // point lies in the box around the balls.
    Part start;
    for (std::uint32_t i = 0; i < balls_.size(); ++i) {
      const Vec3 half(balls_[i].radius);
      start.box = start.box.unitedWith({balls_[i].center - half, balls_[i].center + half});
      start.balls.push_back(i);
    }
    std::priority_queue<Part> queue;
    queue.push(within(start.box, start));
    double found = 0.0;
    for (int i = 0; i < 20'000 && work_ < 20'000'000 && queue.top().bound > 1.05 * found; ++i) {
      const Part part = queue.top();
      queue.pop();
      const Vec3 middle = part.box.center();
      found = std::max(found, within({middle, middle}, part).bound);
      const Vec3 size = part.box.size();
      int axis = size.y > size.x ? 1 : 0;
      if (size.z > size[axis]) axis = 2;
      Box3 low = part.box;
      Box3 high = part.box;
      low.hi[axis] = high.lo[axis] = middle[axis];
      queue.push(within(low, part));
      queue.push(within(high, part));
    }
    return queue.top().bound;
  }

 private:
  struct Part {
    double bound = 0.0;
    Box3 box = {};
    std::vector<std::uint32_t> balls = {};  ///< those that matter in this box
    double rest = 0.0;                      ///< an upper bound on the slope of all others together
    bool operator<(const Part& other) const { return bound < other.bound; }
  };

  Part within(const Box3& box, const Part& whole) {
    // Balls with a smaller slope go into `rest`. The limit is so low that the error stays far below
    // a twentieth even if all balls go there at every halving.
    const double least = 1e-5 * whole.bound / static_cast<double>(balls_.size());
    Part part;
    part.box = box;
    part.rest = whole.rest;
    for (const std::uint32_t i : whole.balls) {
      const Metaball& ball = balls_[i];
      const double nearest = box.distanceTo(ball.center);
      const Vec3 far = glm::max(glm::abs(box.lo - ball.center), glm::abs(box.hi - ball.center));
      const double slope =
          std::fabs(ball.strength) / ball.radius *
          steepest(fall_off_, nearest / ball.radius, glm::length(far) / ball.radius);
      part.bound += slope;
      if (slope > least) {
        part.balls.push_back(i);
      } else {
        part.rest += slope;
      }
    }
    part.bound += whole.rest;
    work_ += whole.balls.size();
    return part;
  }

  const std::vector<Metaball>& balls_;
  FallOff fall_off_;
  std::size_t work_ = 0;
};

}  // namespace

double reachOf(FallOff fall_off, double value) {
  switch (fall_off) {
    case FallOff::kWyvill:
      return std::sqrt(1.0 - std::cbrt(value));
    case FallOff::kGaussian:
      return std::sqrt(-std::log(value));
    case FallOff::kInverseSquare:
      break;
  }
  return std::sqrt(1.0 / value - 1.0);
}

// Each kernel is steepest at one q; its slope decreases on both sides of it.
double steepest(FallOff fall_off, double lo, double hi) {
  if (fall_off == FallOff::kWyvill) {
    const double q = std::clamp(std::sqrt(0.2), lo, hi);
    return -2.0 * q * kernelAt<FallOff::kWyvill>(q * q).first;
  }
  if (fall_off == FallOff::kGaussian) {
    const double q = std::clamp(std::sqrt(0.5), lo, hi);
    return -2.0 * q * kernelAt<FallOff::kGaussian>(q * q).first;
  }
  const double q = std::clamp(std::sqrt(1.0 / 3.0), lo, hi);
  return -2.0 * q * kernelAt<FallOff::kInverseSquare>(q * q).first;
}

double steepestSum(const std::vector<Metaball>& balls, FallOff fall_off) {
  return SteepestSum(balls, fall_off).find();
}

}  // namespace palpate::fields
