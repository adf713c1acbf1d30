#include "bake/query_cost.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace palpate::vdb {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kPoints = 64;
constexpr auto kEnough = std::chrono::milliseconds(1);
constexpr int kFewestPasses = 3;

/// Points in `box`, evenly scattered (R. Roberts' additive recurrence), then moved towards the
/// surface.
std::array<Vec3, kPoints> pointsNearSurface(const Field& field, const Box3& box) {
  std::array<Vec3, kPoints> points{};
  Vec3 share(0.5);
  for (Vec3& p : points) {
    share = glm::fract(share + Vec3(0.8191725134, 0.6710436067, 0.5497004779));
    p = box.lo + share * box.size();
    for (int i = 0; i < 4; ++i) {
      const FieldSample s = field.sample(p);
      const double square = glm::dot(s.gradient, s.gradient);
      if (!(square > 0.0)) break;
      const Vec3 next = p - s.value / square * s.gradient;
      if (!box.contains(next)) break;
      p = next;
    }
  }
  return points;
}

}  // namespace

double queryNanoseconds(const Field& field, const Box3& box) {
  const std::array<Vec3, kPoints> points = pointsNearSurface(field, box);
  double least = kInfinity;
  const Clock::time_point start = Clock::now();
  Vec3 carried(0.0);
  for (int pass = 0; pass < kFewestPasses || Clock::now() - start < kEnough; ++pass) {
    const Clock::time_point before = Clock::now();
    for (const Vec3& p : points) {
      const FieldSample s = field.sample(p + carried);
      carried = 1e-30 * (s.value * s.gradient);
    }
    const std::chrono::duration<double, std::nano> took = Clock::now() - before;
    least = std::min(least, took.count() / static_cast<double>(kPoints));
  }
  // The carried value is too small to matter, but the compiler cannot know that.
  return carried.x > 1.0 ? 0.0 : least;
}

}  // namespace palpate::vdb
