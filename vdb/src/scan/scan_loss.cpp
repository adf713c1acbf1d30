#include "scan/scan_loss.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "palpate/core/text.h"
#include "palpate/vdb/text.h"
#include "scan/single_walls.h"

namespace palpate::vdb {
namespace {

/// [grid voxels] Centers may lie on the surface, and edges are rounded off; a larger deviation
/// counts as lost.
constexpr double kLost = 0.2;

constexpr const char* kLostKey = "lost_voxels";
constexpr const char* kFilledKey = "filled_voxels";
constexpr const char* kPlaceKey = "lost_at";  // [m]

struct Found {
  ScanLoss loss;
  double depth = 0.0;  ///< [m] how far loss.place is on the wrong side
};

/// Whether the grid has a hole where the voxel is a single wall: the straight line through it,
/// between the centers of its two neighbors on the other side, does not meet the surface. `sign`: 1
/// for inside voxels, -1 for those of a gap.
bool isOpen(const Field& field, const Mask& mask, const Image& image, const std::array<int, 3>& at,
            double sign) {
  constexpr int kParts = 16;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!isSingleWall(mask, at, axis)) continue;
    bool is_met = false;
    for (int n = 1; n < kParts && !is_met; ++n) {
      Vec3 place(mask.first[0] + at[0], mask.first[1] + at[1], mask.first[2] + at[2]);
      place[static_cast<int>(axis)] += 2.0 * n / kParts - 1.0;
      is_met = sign * field.value(image.toWorld(place)) < 0.0;
    }
    if (!is_met) return true;
  }
  return false;
}

std::uint64_t countAt(const LevelSetInfo& info, const char* key) {
  const auto at = info.metadata.find(key);
  return at == info.metadata.end() ? 0 : std::strtoull(at->second.c_str(), nullptr, 10);
}

}  // namespace

ScanLoss findLoss(const LevelSet& grid, const Band& band, const Mask& mask, const Mask& apart,
                  const Image& image) {
  const FieldPtr field = gridField(grid, Sampler::kAccessor);
  const double enough = kLost * grid.info().voxel_size;
  std::vector<Found> found(band.blocks.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, found.size()),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
          const BandBlock& block = band.blocks[b];
          for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
            if (std::isnan(block.value[n])) continue;
            const auto place = static_cast<int>(n);
            const int i = block.first[0] + (place >> 6);
            const int j = block.first[1] + (place >> 3 & 7);
            const int k = block.first[2] + (place & 7);
            const auto here = static_cast<std::size_t>(mask.at(i, j, k));
            if (!apart.inside.empty() && apart.inside[here] != 0) continue;
            const bool inside = mask.inside[here] != 0;
            const Vec3 p =
                image.toWorld(Vec3(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k));
            const double depth = field->value(p) * (inside ? 1.0 : -1.0);
            const bool is_open = depth > 0.0 && depth <= enough &&
                                 isOpen(*field, mask, image, {i, j, k}, inside ? 1.0 : -1.0);
            if (!(depth > enough) && !is_open) continue;
            Found& block_found = found[b];
            ++(inside ? block_found.loss.lost : block_found.loss.filled);
            if (depth <= block_found.depth) continue;
            block_found.depth = depth;
            block_found.loss.place = p;
          }
        }
      });
  Found all;
  for (const Found& one : found) {
    all.loss.lost += one.loss.lost;
    all.loss.filled += one.loss.filled;
    if (one.depth <= all.depth) continue;
    all.depth = one.depth;
    all.loss.place = one.loss.place;
  }
  return all.loss;
}

std::map<std::string, std::string> metadataOf(const ScanLoss& loss) {
  std::map<std::string, std::string> result;
  if (loss.lost > 0) result[kLostKey] = std::to_string(loss.lost);
  if (loss.filled > 0) result[kFilledKey] = std::to_string(loss.filled);
  if (result.empty()) return result;
  result[kPlaceKey] = shortNumber(loss.place.x, 6) + " " + shortNumber(loss.place.y, 6) + " " +
                      shortNumber(loss.place.z, 6);
  return result;
}

ScanLoss scanLoss(const LevelSetInfo& info) {
  ScanLoss loss;
  loss.lost = countAt(info, kLostKey);
  loss.filled = countAt(info, kFilledKey);
  if (const auto at = info.metadata.find(kPlaceKey); at != info.metadata.end()) {
    std::istringstream text(at->second);
    text >> loss.place.x >> loss.place.y >> loss.place.z;
  }
  return loss;
}

std::string scanLossNote(const LevelSetInfo& info) {
  const ScanLoss loss = scanLoss(info);
  if (loss.lost + loss.filled == 0) return {};
  const auto voxels = [](std::uint64_t count) {
    return std::to_string(count) + (count == 1 ? " voxel" : " voxels");
  };
  std::string what;
  if (loss.lost > 0) what = voxels(loss.lost) + " of the scan lost";
  if (loss.filled > 0) {
    what += (what.empty() ? "" : ", ") + voxels(loss.filled) + " of the scan around it filled";
  }
  return what + ", where parts or gaps are thinner than voxels of " +
         inMillimeters(info.voxel_size, 4) + " hold; most at " + inMillimeters(loss.place, 4) +
         "; smaller voxels keep them";
}

}  // namespace palpate::vdb
