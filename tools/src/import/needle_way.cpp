#include "import/needle_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "import/crossings.h"
#include "import/region_sampler.h"
#include "import/way_target.h"
#include "palpate/core/error.h"
#include "slicer_markups.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr int kDirections = 10'000;  // 2 degrees apart
constexpr double kBefore = 0.02;     // [m] in front of the body
constexpr int kAround = 8;           // points around the way that must be clear, too
constexpr double kGrain = 1e-4;      // [m] ends of a way are rounded to tenths of a millimeter

/// The force it takes to go from one region into another.
class Borders {
 public:
  Borders(const ImportedScan& scan, const TissueTable& tissues) : scan_(scan) {
    const Crossings all = crossings(scan, tissues);
    for (const WallBetween& wall : all.walls) {
      auto& pairs = wall.wall != nullptr ? closed_ : free_;
      each(wall.outer, wall.inner, [&](auto a, auto b) { pairs.insert({{a, b}, {b, a}}); });
    }
    for (const Passage& port : all.ports) {
      each(port.outer, port.inner, [&](auto a, auto b) {
        forces_[{a, b}] = valueOf(port.in);
        forces_[{b, a}] = valueOf(port.out);
      });
    }
  }

  /// [N]; nothing where the wall is closed.
  [[nodiscard]] std::optional<double> force(std::size_t from, std::size_t to) const {
    const auto at = forces_.find({from, to});
    if (at != forces_.end()) return at->second;
    if (free_.contains({from, to})) return 0.0;
    const bool has_wall = closed_.contains({from, to}) || hasWall(std::max(rank(from), rank(to)));
    return has_wall ? std::nullopt : std::optional(0.0);
  }

 private:
  template <typename Use>
  static void each(const std::vector<std::size_t>& outer, const std::vector<std::size_t>& inner,
                   const Use& use) {
    for (const std::size_t a : outer) {
      for (const std::size_t b : inner) {
        if (a != b) use(a, b);
      }
    }
  }
  static double valueOf(const TissueForce& force) {
    return force.force != nullptr ? force.force->value : 0.0;
  }
  /// Rank of a region's layer: outside, the rest of the body, then the regions in their order.
  [[nodiscard]] std::size_t rank(std::size_t region) const {
    return region == scan_.survey.outside() ? 0 : region == scan_.survey.gap() ? 1 : region + 2;
  }
  [[nodiscard]] bool hasWall(std::size_t rank) const {
    return rank == 1 || (rank > 1 && scan_.plan.regions[rank - 2].tissue->hasWall());
  }

  const ImportedScan& scan_;
  std::set<std::pair<std::size_t, std::size_t>> free_;
  /// Closed by a wall other than the later layer's own
  std::set<std::pair<std::size_t, std::size_t>> closed_;
  std::map<std::pair<std::size_t, std::size_t>, double> forces_;
};

class NeedleWayFinder {
 public:
  NeedleWayFinder(const ImportedScan& scan, const TissueTable& tissues, WayTarget target,
                  bool through_bone)
      : scan_(scan),
        tissues_(tissues),
        borders_(scan, tissues),
        target_(std::move(target)),
        sampler_(scan),
        through_bone_(through_bone) {
    const Mat3& axes = scan.labels.axes;
    step_ = 0.5 * std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  }

  NeedleWay find() {
    std::optional<NeedleWay> best;
    const int directions = target_.entry ? 1 : kDirections;
    for (const double clearance : {kClearance, 0.0}) {
      closed_.clear();
      for (int n = 0; n < directions; ++n) {
        const Vec3 outwards =
            target_.entry ? glm::normalize(*target_.entry - target_.place) : direction(n);
        const std::optional<NeedleWay> way = along(target_.place, outwards, clearance);
        if (way && (!best || way->length() < best->length() - 1e-9)) best = way;
      }
      if (best) return rounded(*best);
    }
    if (target_.entry) {
      throw inputError("import.way",
                       "the straight way from the marked entry to '" + target_.name +
                           "' is closed: it meets " + nameOf(closed_.begin()->first),
                       "mark another entry, or leave it out: then the shortest open way is found",
                       scan_.labels.source);
    }
    throw inputError("import.way",
                     "every straight way to '" + target_.name + "' is closed: of " +
                         formatCount(kDirections) + " directions " + whatCloses(),
                     "choose another target, or open what closes it in the scene by a port of your "
                     "own",
                     scan_.labels.source);
  }

 private:
  /// The n-th of evenly spread directions (a spiral from pole to pole with steps of the golden
  /// angle).
  static Vec3 direction(int n) {
    const double z = 1.0 - (2.0 * n + 1.0) / kDirections;
    const double angle = n * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

  /// The way from `to` outwards; nothing if a region closes it, which then counts in closed_.
  std::optional<NeedleWay> along(const Vec3& to, const Vec3& outwards, double clearance) {
    const std::optional<std::vector<Stretch>> stretches = walk(to, outwards);
    if (!stretches) return std::nullopt;
    const double body = stretches->back().end;
    if (clearance > 0.0 && !isClear(to, outwards, body, clearance)) return std::nullopt;
    NeedleWay way;
    way.target = target_.name;
    way.is_given = target_.entry.has_value();
    way.to = to;
    way.entry = to + body * outwards;
    way.from = to + (body + kBefore) * outwards;
    way.clearance = clearance;
    fill(*stretches, way);
    return way;
  }

  struct Stretch {
    std::size_t region;
    double end;  // [m] from the target
  };

  std::optional<std::vector<Stretch>> walk(const Vec3& to, const Vec3& outwards) {
    const std::size_t outside = scan_.survey.outside();
    std::vector<Stretch> found;
    const double reach = glm::length(sampler_.box().hi - sampler_.box().lo) + step_;
    const auto steps = static_cast<int>(reach / step_);
    bool is_at_border = false;
    for (int n = 0; n <= steps; ++n) {
      const RegionSampler::Sample here = sampler_.at(to + (n * step_) * outwards);
      if (here.region != outside && isForbidden(here.region)) return closedBy(here.region);
      if (found.empty() || found.back().region != here.region) {
        // The needle will go the opposite way: from outside to the target.
        if (!found.empty() && !isOpen(here.region, found.back().region)) {
          return closedBy(here.region == outside ? found.back().region : here.region);
        }
        // The image's border is a closed wall.
        if (here.region == outside && is_at_border) return closedBy(outside);
        found.push_back({here.region, 0.0});
      }
      found.back().end = (n + 0.5) * step_;
      is_at_border = here.is_at_border;
    }
    if (found.back().region != outside) return closedBy(outside);
    found.pop_back();
    if (found.empty()) return closedBy(outside);
    return found;
  }

  std::nullopt_t closedBy(std::size_t region) {
    ++closed_[region];
    return std::nullopt;
  }

  [[nodiscard]] const Tissue* tissueOf(std::size_t region) const {
    if (region == scan_.survey.outside()) return nullptr;
    if (region == scan_.survey.gap()) return tissues_.find("fat");
    return scan_.plan.regions[region].tissue;
  }

  [[nodiscard]] bool isRigid(std::size_t region) const {
    const Tissue* tissue = tissueOf(region);
    return tissue != nullptr && tissue->kind == TissueClass::kRigid;
  }

  [[nodiscard]] bool isOpen(std::size_t from, std::size_t to) const {
    if (through_bone_ && (isRigid(from) || isRigid(to))) return true;
    return borders_.force(from, to).has_value();
  }

  [[nodiscard]] bool isForbidden(std::size_t region) const {
    if (region == target_.region) return false;
    const Tissue* tissue = tissueOf(region);
    return tissue != nullptr && ((isRigid(region) && !through_bone_) || tissue->is_spared);
  }

  /// Whether nothing forbidden lies around the way at the distance `clearance`.
  bool isClear(const Vec3& to, const Vec3& outwards, double body, double clearance) {
    const Vec3 other = std::abs(outwards.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    const Vec3 u = glm::normalize(glm::cross(outwards, other));
    const Vec3 v = glm::cross(outwards, u);
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kAround;
      const Vec3 aside = clearance * (std::cos(angle) * u + std::sin(angle) * v);
      const auto steps = static_cast<int>(body / step_);
      for (int n = 0; n <= steps; ++n) {
        const std::size_t region = sampler_.at(to + aside + (n * step_) * outwards).region;
        if (!isForbidden(region)) continue;
        ++closed_[region];
        return false;
      }
    }
    return true;
  }

  /// Fills in the parts in the order in which the needle meets them, with the predicted forces.
  void fill(const std::vector<Stretch>& stretches, NeedleWay& way) const {
    double friction = 0.0;
    std::size_t last = scan_.survey.outside();
    for (std::size_t n = stretches.size(); n-- > 0;) {
      WayPart part;
      part.region = stretches[n].region;
      part.length = stretches[n].end - (n > 0 ? stretches[n - 1].end : 0.0);
      part.rupture = borders_.force(last, part.region).value_or(0.0);
      way.peak = std::max(way.peak, part.rupture + friction);
      const Tissue* tissue = tissueOf(part.region);
      if (tissue != nullptr && tissue->shaft) friction += tissue->shaft->value * part.length;
      part.force = friction + (tissue != nullptr && tissue->cutting ? tissue->cutting->value : 0.0);
      way.peak = std::max(way.peak, part.force);
      last = part.region;
      way.parts.push_back(part);
    }
  }

  /// The way with its ends rounded to tenths of a millimeter, if that way is open too.
  NeedleWay rounded(const NeedleWay& way) {
    const auto grain = [](const Vec3& p) { return glm::round(p / kGrain) * kGrain; };
    const Vec3 from = grain(way.from);
    const Vec3 to = grain(way.to);
    std::optional<NeedleWay> nearby = along(to, glm::normalize(from - to), way.clearance);
    if (!nearby) return way;
    nearby->from = from;
    return *nearby;
  }

  [[nodiscard]] std::string nameOf(std::size_t region) const {
    const Tissue* tissue = tissueOf(region);
    if (tissue == nullptr) return "the image's border";
    return "'" + scan_.nameOf(region) + "' (" + tissue->name + ")";
  }

  [[nodiscard]] std::string whatCloses() const {
    std::vector<std::pair<int, std::size_t>> most;
    for (const auto& [region, count] : closed_) most.emplace_back(count, region);
    std::sort(most.begin(), most.end(), std::greater<>());
    std::string text;
    constexpr std::size_t kTold = 3;
    for (std::size_t n = 0; n < std::min(most.size(), kTold); ++n) {
      const auto& [count, region] = most[n];
      text += (n > 0 ? ", " : "") + formatCount(count) + " meet " + nameOf(region);
    }
    return text + (most.size() > kTold ? ", the rest others" : "");
  }

  const ImportedScan& scan_;
  const TissueTable& tissues_;
  Borders borders_;
  WayTarget target_;
  RegionSampler sampler_;
  bool through_bone_ = false;
  double step_ = 1e-3;
  /// Number of directions, by the region that closes them first
  std::map<std::size_t, int> closed_;
};

}  // namespace

double NeedleWay::length() const {
  double sum = 0.0;
  for (const WayPart& part : parts) sum += part.length;
  return sum;
}

NeedleWay needleWay(const ImportedScan& scan, const TissueTable& tissues, const WayTarget& target,
                    bool through_bone) {
  return NeedleWayFinder(scan, tissues, target, through_bone).find();
}

SuggestedWay suggestedWay(const NeedleWay& way) {
  return {"to " + way.target +
              (way.is_given ? " from the marked entry" : " by the shortest way that is open"),
          way.from, way.to};
}

std::string wayMarkups(const NeedleWay& way) {
  return markupsText({{"Line",
                       "way to " + way.target,
                       {{"entry", way.entry}, {"target: " + way.target, way.to}}}});
}

}  // namespace palpate::tools
