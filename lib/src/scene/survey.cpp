#include "survey.h"

#include <algorithm>
#include <random>

#include "palpate/core/stop.h"
#include "region_line.h"

namespace palpate {
namespace {

constexpr int kStepsPerLine = 128;
constexpr std::size_t kMaxLines = 20000;  // in total, so that many layers do not take minutes
constexpr int kHalvings = 40;  // a step shrinks to 1e-12 of itself, about double precision

class Surveyor {
 public:
  explicit Surveyor(const Partition& partition) : line_(partition) {
    const std::size_t n = partition.regionCount();
    out_.regions = n;
    out_.touch.assign(n * n, false);
    out_.has_seed.assign(n, false);
    out_.seed.assign(n, Vec3(0.0));
    run_.assign(n, 0.0);
  }

  void walk(const Vec3& from, const Vec3& to) {
    // with hundreds of labels a line takes milliseconds, and there are thousands of lines
    pollStop();
    line_.begin(from, to);
    Vec3 last = from;
    RegionId region = line_.at(from);
    Vec3 entered = from;
    for (int i = 1; i <= kStepsPerLine; ++i) {
      const Vec3 here = glm::mix(from, to, static_cast<double>(i) / kStepsPerLine);
      const RegionId now = line_.at(here);
      if (now != region) {
        // One step may contain several walls: after the first is found, continue behind it.
        Vec3 a = last;
        RegionId ra = region;
        for (int walls = 0; ra != now && walls < 8; ++walls) {
          Vec3 b = here;
          RegionId rb = now;
          for (int k = 0; k < kHalvings; ++k) {
            const Vec3 middle = 0.5 * (a + b);
            const RegionId rm = line_.at(middle);
            if (rm == ra) {
              a = middle;
            } else {
              b = middle;
              rb = rm;
            }
          }
          meet(ra, rb);
          keepSeed(ra, entered, a);
          entered = b;
          a = b;
          ra = rb;
        }
        region = now;
      }
      last = here;
    }
    keepSeed(region, entered, to);
  }

  Survey take() { return std::move(out_); }

 private:
  void meet(RegionId a, RegionId b) {
    out_.touch[a * out_.regions + b] = true;
    out_.touch[b * out_.regions + a] = true;
  }
  /// The middle of the longest run through a region is the best guess at its depth.
  void keepSeed(RegionId region, const Vec3& from, const Vec3& to) {
    const Vec3 middle = 0.5 * (from + to);
    const double length = glm::length(to - from);
    if (length <= run_[region] || line_.at(middle) != region) return;
    run_[region] = length;
    out_.seed[region] = middle;
    out_.has_seed[region] = true;
  }

  RegionLine line_;
  Survey out_;
  std::vector<double> run_;
};

}  // namespace

Survey survey(const Partition& partition, std::span<const Box3> boxes, std::size_t lines_per_box) {
  Surveyor surveyor(partition);
  lines_per_box =
      std::clamp<std::size_t>(kMaxLines / std::max<std::size_t>(boxes.size(), 1), 3, lines_per_box);
  std::mt19937_64 random(20240229);  // fixed: the same scene gives the same survey
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Box3& bare : boxes) {
    if (!bare.isBounded()) continue;
    const Vec3 margin = 0.05 * bare.size() + Vec3(1e-9);
    const Box3 box{bare.lo - margin, bare.hi + margin};
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 from = box.center();
      Vec3 to = from;
      from[axis] = box.lo[axis];
      to[axis] = box.hi[axis];
      surveyor.walk(from, to);
    }
    for (std::size_t line = 0; line < lines_per_box; ++line) {
      // Each line goes from a point of one face of the box to a point of the opposite face.
      const int axis = static_cast<int>(line % 3);
      Vec3 from(unit(random), unit(random), unit(random));
      Vec3 to(unit(random), unit(random), unit(random));
      from[axis] = 0.0;
      to[axis] = 1.0;
      surveyor.walk(box.lo + from * box.size(), box.lo + to * box.size());
    }
  }
  return surveyor.take();
}

}  // namespace palpate
