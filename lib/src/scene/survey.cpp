#include "survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "palpate/core/stop.h"

namespace palpate {
namespace {

constexpr int kStepsPerLine = 128;
constexpr std::size_t kMaxLines = 20000;  // in total, so that many layers do not take minutes
constexpr int kHalvings = 40;  // a step shrinks to 1e-12 of itself, about double precision

/// Whether the straight way from `from` to `to` meets `box`.
bool crosses(const Box3& box, const Vec3& from, const Vec3& to) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0.0) {
      if (from[axis] < box.lo[axis] || from[axis] > box.hi[axis]) return false;
      continue;
    }
    const double a = (box.lo[axis] - from[axis]) / way;
    const double b = (box.hi[axis] - from[axis]) / way;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

/// The regions along one straight line. Leaves whose bounds the line does not meet are outside all
/// along it; each of the others is evaluated again only where its Lipschitz bound allows its sign
/// to have changed.
class Line {
 public:
  explicit Line(const Partition& partition)
      : partition_(partition), signs_(partition.leaves().size()) {}

  void begin(const Vec3& from, const Vec3& to) {
    from_ = from;
    along_ = to - from;
    length_ = glm::length(along_);
    candidates_.clear();
    signs_.clear();
    is_known_ = false;
    const Vec3 middle = 0.5 * (from + to);
    // A little wider than the line, for rounding.
    const Vec3 margin(1e-9 * length_);
    partition_.tree().visit(middle, 0.5 * length_ * (1.0 + 1e-6), [&](std::uint32_t item) {
      const Leaf& leaf = partition_.leaves()[item];
      const Box3 bounds = leaf.field->bounds();
      if (!crosses({bounds.lo - margin, bounds.hi + margin}, from, to)) return;
      const Box3 domain = leaf.field->lipschitzDomain();
      const bool holds = domain.contains(from) && domain.contains(to);
      candidates_.push_back({static_cast<LeafId>(item), leaf.field.get(), bounds,
                             holds ? 1.0 / leaf.lipschitz : 0.0, kInfinity, -kInfinity});
    });
  }

  /// The region at `p`, a point of the line.
  RegionId at(const Vec3& p) {
    const double place = glm::dot(p - from_, along_) / std::max(length_, 1e-300);
    if (is_known_ && place > fixed_from_ && place < fixed_to_) return region_;
    bool is_changed = !is_known_;
    double from = -kInfinity;
    double to = kInfinity;
    for (Candidate& candidate : candidates_) {
      if (!(place > candidate.fixed_from && place < candidate.fixed_to)) {
        is_changed |= ask(candidate, p, place);
      }
      from = std::max(from, candidate.fixed_from);
      to = std::min(to, candidate.fixed_to);
    }
    fixed_from_ = from;
    fixed_to_ = to;
    if (is_changed) {
      region_ = regionHere();
      is_known_ = true;
    }
    return region_;
  }

 private:
  struct Candidate {
    LeafId leaf;
    const Field* field;
    Box3 bounds;
    double per_slope;             ///< 1 / Lipschitz bound; 0 where that does not hold
    double fixed_from, fixed_to;  ///< [m] along the line: its sign is the same in between
  };

  /// A cache: bisecting towards a wall visits the same few cells again and again.
  RegionId regionHere() {
    for (const Cell& cell : cells_) {
      if (cell.is_known && cell.signs == signs_) return cell.region;
    }
    Cell& oldest = cells_[next_cell_];
    next_cell_ = (next_cell_ + 1) % cells_.size();
    oldest = {signs_, partition_.regionOf(signs_), true};
    return oldest.region;
  }

  /// Evaluates the leaf at `p`; true if its sign changed.
  bool ask(Candidate& candidate, const Vec3& p, double place) {
    const double value = candidate.field->value(p);
    const bool inside = value < 0.0 && candidate.bounds.contains(p);
    // The length over which the sign is certain, reduced by a share of the line for rounding; not
    // positive if the value is not a number.
    const double fixed = std::fabs(value) * candidate.per_slope - 1e-9 * length_;
    candidate.fixed_from = fixed > 0.0 ? place - fixed : kInfinity;
    candidate.fixed_to = fixed > 0.0 ? place + fixed : -kInfinity;
    if (inside == signs_.inside(candidate.leaf)) return false;
    signs_.set(candidate.leaf, inside);
    return true;
  }

  struct Cell {
    Signs signs;
    RegionId region = kOutside;
    bool is_known = false;
  };

  const Partition& partition_;
  std::array<Cell, 4> cells_;  ///< the last ones looked up
  std::size_t next_cell_ = 0;
  Vec3 from_{0.0};
  Vec3 along_{0.0};
  double length_ = 0.0;
  std::vector<Candidate> candidates_;
  Signs signs_;
  double fixed_from_ = kInfinity;  ///< [m] along the line: no sign changes from here to fixed_to_
  double fixed_to_ = -kInfinity;
  bool is_known_ = false;
  RegionId region_ = kOutside;
};

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

  Line line_;
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
      // From a point of one face to a point of the opposite one.
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
