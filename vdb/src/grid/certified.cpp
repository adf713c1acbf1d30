#include <algorithm>
#include <cmath>
#include <utility>

#include "brick/bricks.h"
#include "grid/grid_tally.h"
#include "grid/rebuilt.h"
#include "grid/voxel_steps.h"
#include "keep/grid_cache.h"
#include "palpate/core/text.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/grid_error.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

/// If the mean of |gradient| differs from 1 by more than this, values are not distances in the
/// grid's own unit.
constexpr double kMostSlope = 0.25;
/// [voxels] Beside the surface, a larger contradiction is damage.
constexpr double kMostStep = 0.25;
/// [voxels] Errors below this can stay unseen, because they contradict no neighbor by more than
/// kSmallStep: sqrt(3) - sqrt(2) where one half of a grid is off against the other half, and half
/// of that at a single voxel.
constexpr double kUnseen = 0.4;
/// With fewer active voxels, widening the grid again is faster than keeping it is worth.
constexpr std::uint64_t kLeastKept = 100'000;
/// [voxels] Rounding error of a bound that was computed in floats.
constexpr double kRounding = 1e-4;

class Certifier {
 public:
  Certifier(LevelSet grid, const CertifyOptions& options, const Progress& progress)
      : grid_(std::move(grid)),
        options_(options),
        progress_(progress),
        cache_(options.cache_folder) {}

  CertifiedGrid run() {
    if (const auto stored = storedCertificate(grid_, sampler())) return {grid_, *stored, {}};
    const std::string key = needsWork() ? contentHash(grid_) + "-6" : "";
    if (!key.empty() && findKept(key)) return std::move(out_);
    if (options_.is_foreign) lookAtVoxels();
    if (sampler() == Sampler::kCubic && isTooNarrow(grid_.info())) widen();
    BandCertificate certificate = survey();
    if (!holds(certificate) && options_.is_foreign && !is_rebuilt_) {
      rebuild("values near the band's rim do not fit together");
      certificate = survey();
    }
    if (!holds(certificate)) refuse(certificate);
    certificate.content = contentHash(grid_);
    out_.grid = withCertificate(grid_, certificate);
    out_.certificate = std::move(certificate);
    if (!key.empty() && out_.grid.info().active_voxels >= kLeastKept) {
      cache_.keep(key, noted(out_.grid));
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] Sampler sampler() const noexcept {
    return options_.sampler == Sampler::kAccessor ? Sampler::kTrilinear : options_.sampler;
  }
  [[nodiscard]] bool needsWork() const {
    return options_.is_foreign && sampler() == Sampler::kCubic && !options_.cache_folder.empty();
  }

  static constexpr const char* kNotes = "palpate:notes";

  /// The same grid, with the notes on it in its metadata.
  [[nodiscard]] LevelSet noted(const LevelSet& grid) const {
    std::string all;
    for (const std::string& note : out_.notes) all += note + "\n";
    return grid.named(grid.info().name, {{kNotes, all}});
  }

  bool findKept(const std::string& key) {
    const std::optional<LevelSet> kept = cache_.find(key, sampler());
    if (!kept) return false;
    const auto certificate = storedCertificate(*kept, sampler());
    if (!certificate) return false;
    const auto notes = kept->info().metadata.find(kNotes);
    std::string all = notes == kept->info().metadata.end() ? "" : notes->second;
    for (std::size_t end = all.find('\n'); end != std::string::npos; end = all.find('\n')) {
      out_.notes.push_back(all.substr(0, end));
      all.erase(0, end + 1);
    }
    out_.grid = kept->named(grid_.info().name, grid_.info().metadata);
    out_.certificate = *certificate;
    return true;
  }

  [[nodiscard]] Vec3 place(const Coord& at) const {
    return grid_.impl().origin + grid_.info().voxel_size * Vec3(at.x(), at.y(), at.z());
  }
  [[nodiscard]] std::string placeText(const Coord& at) const { return inMillimeters(place(at)); }
  [[nodiscard]] std::string name() const { return "grid '" + grid_.info().name + "'"; }

  [[noreturn]] void no(const char* code, const std::string& what, const char* hint) const {
    throw inputError(code, name() + " " + what, hint, options_.path);
  }

  void lookAtVoxels() {
    report(progress_, "look at the voxels", 0.0);
    refuseBySigns(tallyOf(*grid_.impl().grid));
    report(progress_, "look at the voxels", 0.5);
    const VoxelSteps steps = stepsOf(grid_);
    if (steps.near_holes.voxels > 0) {
      no("vdb.torn",
         "has a hole in its band by the surface: " + std::to_string(steps.near_holes.voxels) +
             " voxels lack a neighbor, one at " + placeText(steps.near_holes.at),
         "write it again with a whole band all around the surface");
    }
    if (steps.near.by > kMostStep) {
      no("vdb.jump",
         "has neighboring voxels beside the surface that cannot both be distances, one at " +
             placeText(steps.near.at) + ": they differ by " + shortNumber(steps.near.by, 2) +
             " voxels more than they are apart",
         "the file may be damaged: write it again; or make distances of its values, with "
         "OpenVDB's sdfToSdf or vdb_tool -normalize");
    }
    step_ = steps.near.by;
    if (steps.far_holes.voxels > 0) {
      rebuild("its band has holes, one at " + placeText(steps.far_holes.at));
    } else if (std::max(steps.far.by, steps.near.by) > kSmallStep) {
      const bool by_far = steps.far.by > steps.near.by;
      rebuild("voxels differ by up to " + shortNumber(by_far ? steps.far.by : steps.near.by, 2) +
              " voxels more than they are apart, one at " +
              placeText(by_far ? steps.far.at : steps.near.at));
    }
  }

  void refuseBySigns(const GridTally& tally) const {
    if (tally.gradients > 0) {
      const double mean = tally.sum / static_cast<double>(tally.gradients);
      if (!(std::fabs(mean - 1.0) <= kMostSlope)) {
        no("vdb.gradient",
           "has a |gradient| of " + shortNumber(mean, 3) +
               " on average, so that its values are not distances in its own unit",
           "the unit may be wrong, or the values are in voxels or densities: write it again with "
           "distances");
      }
    }
    if (tally.inside_voxels == 0) {
      no("vdb.no_inside", "has no negative voxel in its band, so it has no inside to touch",
         "distances without sign become a shell by offset");
    }
    if (tally.sign_breaks.voxels > 0) {
      no("vdb.torn",
         "has " + std::to_string(tally.sign_breaks.voxels) +
             " voxels where inside and outside meet without a band in between, one at " +
             placeText(tally.sign_breaks.first),
         "palpate convert FILE.vdb -o OTHER.vdb marks the inside, if the band is whole");
    }
  }

  void rebuild(const std::string& why) {
    requireMemory();
    grid_ = withDistancesRebuilt(grid_, progress_);
    is_rebuilt_ = true;
    out_.notes.push_back("distances of " + name() + " away from the surface were rebuilt: " + why);
  }

  void widen() {
    requireMemory();
    grid_ = widened(grid_, kCubicHalfWidth, progress_);
  }

  /// Memory for a copy with a wider band and for the vectors to the surface: some eight times the
  /// grid.
  void requireMemory() const {
    constexpr double kShare = 8.0;
    const double bytes = kShare * static_cast<double>(grid_.info().memory);
    const auto limit = static_cast<double>(options_.max_memory);
    if (options_.max_memory == 0 || bytes <= limit) return;
    throw Error(ErrorKind::kOperation,
                {"vdb.memory",
                 name() + " needs about " + inGigabytes(bytes) + " to widen its band; " +
                     inGigabytes(limit) + " are allowed",
                 "allow more, or write it with a half width of 6 voxels", options_.path});
  }

  [[nodiscard]] BandCertificate survey() {
    report(progress_, "bound the samples", 0.0);
    const BrickSurvey found = surveyBricks(grid_, sampler(), kLeastWithin + kRounding);
    const double voxel = grid_.info().voxel_size;
    BandCertificate c;
    c.sampler = sampler();
    c.lipschitz = found.lipschitz;
    c.steepest = found.bounds.steepest_near;
    c.within = std::max(0.0, found.bounds.within() - kRounding) * voxel;
    unknown_at_ = {found.bounds.unknown_at[0], found.bounds.unknown_at[1],
                   found.bounds.unknown_at[2]};
    has_surface_ = found.bounds.surface_cells > 0;
    if (has_surface_) {
      c.slope = found.bounds.least_slope - kRounding;
      c.slope_place =
          place({found.bounds.slope_at[0], found.bounds.slope_at[1], found.bounds.slope_at[2]});
      c.rough = static_cast<double>(found.bounds.rough_cells) /
                static_cast<double>(found.bounds.surface_cells);
    }
    c.off = smoothGridError(options_.sampler, voxel).off;
    if (options_.is_foreign) c.off += (kUnseen + step_) * voxel;
    return c;
  }

  [[nodiscard]] bool holds(const BandCertificate& c) const noexcept {
    return has_surface_ && c.within >= kLeastWithin * grid_.info().voxel_size &&
           c.steepest <= kMostSteep;
  }

  [[noreturn]] void refuse(const BandCertificate& c) const {
    if (!has_surface_) {
      no("vdb.no_surface",
         "has voxels inside, but samples of it are outside everywhere: the whole shape is smaller "
         "than a voxel of " +
             inMillimeters(grid_.info().voxel_size, 3),
         "use smaller voxels; also check the length unit");
    }
    if (c.steepest > kMostSteep) {
      no("vdb.uncertified",
         "is too steep beside its surface: its values change by up to " +
             shortNumber(c.steepest, 2) + " times the distance, and at most " +
             shortNumber(kMostSteep, 2) + " times can be touched",
         "its values are not distances: write it again, or bake the shape that it is of");
    }
    no("vdb.uncertified",
       "has no values at points only " + shortNumber(c.within / grid_.info().voxel_size, 2) +
           " voxels from its surface, one near " + placeText(unknown_at_),
       "its band is too narrow there, or has a hole: write it again with a half width of 6 voxels");
  }

  LevelSet grid_;
  const CertifyOptions& options_;
  const Progress& progress_;
  GridCache cache_;
  CertifiedGrid out_;
  Coord unknown_at_;
  double step_ = 0.0;  // [voxels] beside the surface
  bool is_rebuilt_ = false;
  bool has_surface_ = false;
};

}  // namespace

CertifiedGrid certified(const LevelSet& grid, const CertifyOptions& options,
                        const Progress& progress) {
  return Certifier(grid, options, progress).run();
}

std::string roughNote(const LevelSet& grid, const BandCertificate& c) {
  if (!(c.rough > kMostRough)) return {};
  return shortNumber(100.0 * c.rough, 3) +
         " % of its surface has edges, or bends within a voxel of " +
         inMillimeters(grid.info().voxel_size, 3) + ", one place at " +
         inMillimeters(c.slope_place) +
         "; there the surface that is felt is off by a large share of a voxel; smaller voxels hold "
         "it";
}

}  // namespace palpate::vdb
