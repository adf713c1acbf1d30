#include "scan/label_partition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "scan/for_blocks.h"
#include "scan/smooth_mask.h"
#include "scan/volume.h"

namespace palpate::vdb {
namespace {

bool touch(const Mask& a, const Mask& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.first[axis] >= b.first[axis] + b.box[axis]) return false;
    if (b.first[axis] >= a.first[axis] + a.box[axis]) return false;
  }
  return true;
}

/// Whether both bands hold a common voxel: then their layers are near each other somewhere.
bool haveCommonVoxel(const Band& a, const Band& b) {
  for (const BandBlock& block : a.blocks) {
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      if (std::isnan(block.value[n])) continue;
      const auto place = static_cast<int>(n);
      const float other = b.valueAt(a.first[0] + block.first[0] + (place >> 6),
                                    a.first[1] + block.first[1] + (place >> 3 & 7),
                                    a.first[2] + block.first[2] + (place & 7));
      if (!std::isnan(other)) return true;
    }
  }
  return false;
}

/// [steps] How far a lapped layer reaches into its neighbors, per step of the longest spacing: more
/// than the grids of two layers differ at their wall, and at most half a step. A larger lap would
/// blur that wall near edges.
constexpr double kLap = 0.2;
constexpr double kMostLap = 0.5;
constexpr double kThick = 1.5;  // shortest spacings: slices are thick from here on
constexpr int kSlit = 4;        // [voxels] half of the widest slit that a lap might close
/// [steps] How far the outer wall of a lapped layer may lie inside the outer surface of all layers,
/// where it meets another layer.
constexpr float kMostGroove = 0.5F;

/// Whether a voxel of `a` has one of `b` beside it, across a face, an edge or a corner.
bool meet(const Mask& a, const Mask& b) {
  std::array<int, 3> lo{}, hi{};  // range of a's voxels that may have one of b's beside them
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lo[axis] = std::max(a.first[axis], b.first[axis] - 1);
    hi[axis] = std::min(a.first[axis] + a.box[axis], b.first[axis] + b.box[axis] + 1);
  }
  for (int k = lo[2]; k < hi[2]; ++k) {
    for (int j = lo[1]; j < hi[1]; ++j) {
      for (int i = lo[0]; i < hi[0]; ++i) {
        if (!a.holds(i, j, k)) continue;
        for (int n = 0; n < 27; ++n) {
          if (b.holds(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1)) return true;
        }
      }
    }
  }
  return false;
}

/// A layer's share of the space. `own`: the layer's value; `least`: the smallest value of its
/// neighbors (NaN: none is near); `united`: the value of all layers together (NaN: deep within
/// them).
float shared(float own, float least, float united) {
  const float other = std::fmin(least, -united);
  return std::isnan(other) ? own : 0.5F * (own - other);
}

float lapped(float own, float least, float united, float lap) {
  if (std::isnan(least)) return shared(own, least, united);
  const float wall = 0.5F * (own - least) - lap;
  if (std::isnan(united)) return wall;
  return std::max(std::min(0.5F * (own + united), united + kMostGroove), wall);
}

/// The value that lapped() gives where a layer's own value and those of its neighbors are 0.
float partingOf(float united, float lap) {
  return std::isnan(united) ? -lap : lapped(0.0F, 0.0F, std::min(united, 0.0F), lap);
}

/// [m] Edge lengths of a voxel.
Vec3 lengthsOf(const Image& image) {
  return {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])};
}

std::vector<int> together(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> result;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

bool haveCommonLabel(const std::vector<int>& a, const std::vector<int>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

/// Calls visit(index in the block, box index) for each voxel of a block that is in the band.
template <typename Visit>
void forVoxels(const BandBlock& block, const Visit& visit) {
  for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
    if (std::isnan(block.value[n])) continue;
    const auto place = static_cast<int>(n);
    visit(n, std::array{block.first[0] + (place >> 6), block.first[1] + (place >> 3 & 7),
                        block.first[2] + (place & 7)});
  }
}

/// The value, forced to the mask's side.
float onSide(float value, bool inside) {
  return inside ? std::min(value, -kLeastValue) : std::max(value, kLeastValue);
}

/// [steps] How far from a wall between layers a voxel's center is at least, by each layer's own
/// values: more than the grids of two layers differ at their wall, and so little that walls keep
/// their slopes.
constexpr float kOffWall = 0.02F;

/// `value` less `shift`, on the side of the mask: no voxel's center gets into another layer.
float shifted(float value, float shift, bool inside) {
  return inside ? std::min(value - shift, -kOffWall) : std::max(value - shift, kOffWall);
}

/// Whether a voxel that the mask does not hold lies in a slit of it: on some line through the voxel
/// the mask holds one on both sides, at most kSlit steps away.
bool isInSlit(const Mask& mask, int x, int y, int z) {
  constexpr int kHalf = 13;  // of the 26 directions to neighbors, one of each two opposite ones
  for (int d = 0; d < kHalf; ++d) {
    const std::array<int, 3> way = {d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
    const auto is_met = [&](int sense) {
      for (int n = 1; n <= kSlit; ++n) {
        const int by = sense * n;
        if (mask.holds(x + by * way[0], y + by * way[1], z + by * way[2])) return true;
      }
      return false;
    };
    if (is_met(1) && is_met(-1)) return true;
  }
  return false;
}

void keepSides(MaskedBand& layer) {
  forBlocks(layer.band.blocks.size(), [&](std::size_t b) {
    BandBlock& block = layer.band.blocks[b];
    forVoxels(block, [&](std::size_t n, const std::array<int, 3>& at) {
      const auto here = static_cast<std::size_t>(layer.mask.at(at[0], at[1], at[2]));
      block.value[n] = onSide(block.value[n], layer.mask.inside[here] != 0);
    });
  });
}

}  // namespace

LabelPartition::LabelPartition(const Image& image, std::vector<std::vector<int>> layers)
    : image_(image), layers_(std::move(layers)), shifts_(layers_.size()) {
  for (Labels& layer : layers_) std::sort(layer.begin(), layer.end());
}

std::shared_ptr<const MaskedBand> LabelPartition::smoothed(const Labels& labels,
                                                           const Progress& progress) const {
  auto result = std::make_shared<MaskedBand>();
  const auto is_label = [&](float value) {
    return std::any_of(labels.begin(), labels.end(),
                       [&](int label) { return static_cast<float>(label) == value; });
  };
  result->mask = maskOf(image_, is_label, kBandMargin);
  if (result->mask.inside.empty()) return result;
  const Vec3 lengths = lengthsOf(image_);
  const double smallest = std::min({lengths.x, lengths.y, lengths.z});
  result->band = bandOf(result->mask, lengths / smallest, /*is_open=*/true);
  smoothBand(result->band, result->mask, image_.axes / smallest, progress);
  result->excess = keepVolume(result->band, result->mask);
  result->band.dropBounds();
  return result;
}

const MaskedBand& LabelPartition::cached(const Labels& labels, const Progress& progress) {
  auto& made = made_[labels];
  if (!made) made = smoothed(labels, progress);
  return *made;
}

std::vector<std::size_t> LabelPartition::neighborsOf(std::size_t index, const Progress& progress) {
  std::vector<std::size_t> result;
  const MaskedBand& own = cached(layers_[index], progress);
  if (own.mask.inside.empty()) return result;
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    if (haveCommonLabel(layers_[n], layers_[index])) continue;
    const MaskedBand& other = cached(layers_[n], progress);
    if (!other.mask.inside.empty() && touch(own.mask, other.mask) &&
        haveCommonVoxel(own.band, other.band)) {
      result.push_back(n);
    }
  }
  return result;
}

float LabelPartition::Limits::leastAt(int x, int y, int z) const noexcept {
  float least = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [layer, shift] : others) {
    const float value = layer->band.valueAt(x, y, z);
    if (std::isnan(value)) continue;
    least = std::fmin(least, shifted(value, shift, layer->mask.holds(x, y, z)));
  }
  return least;
}

LabelPartition::Limits LabelPartition::limitsOf(std::size_t index,
                                                const std::vector<std::size_t>& neighbors,
                                                const Progress& progress) {
  // Layers that share labels with this one are not part of the rest, except by labels of other
  // layers.
  Labels labels = layers_[index];
  for (const Labels& other : layers_) {
    if (!haveCommonLabel(other, layers_[index])) labels = together(labels, other);
  }
  Limits limits;
  limits.whole = &cached(labels, progress);
  for (const std::size_t n : neighbors) {
    limits.others.emplace_back(&cached(layers_[n], progress), 0.0F);
  }
  return limits;
}

float LabelPartition::shiftOf(std::size_t index, const Progress& progress) {
  std::optional<float>& shift = shifts_[index];
  if (shift) return *shift;
  const std::vector<std::size_t> neighbors = neighborsOf(index, progress);
  if (neighbors.empty()) return *(shift = 0.0F);
  const Limits limits = limitsOf(index, neighbors, progress);
  const MaskedBand& own = cached(layers_[index], progress);
  // Subtracting a number from the layer's own values changes its share by half of the number, so
  // that the volume is corrected half-way only. More would not be better: lines through thin layers
  // give wrong volumes, and neighbors move as well.
  shift = shiftToVolumeOf(own.band, own.mask, own.excess, [&](float value, int x, int y, int z) {
    return shared(value, limits.leastAt(x, y, z), limits.whole->band.valueAt(x, y, z));
  });
  return *shift;
}

MaskedBand LabelPartition::layer(std::size_t index, LabelEdge edge, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  const std::vector<std::size_t> neighbors = neighborsOf(index, progress);
  MaskedBand own = cached(layers_[index], progress);
  if (neighbors.empty()) {
    keepSides(own);
    own.parting.resize(own.band.blocks.size());  // at 0
    closeBand(own.band, own.mask);
    return own;
  }
  Limits limits = limitsOf(index, neighbors, progress);
  for (std::size_t n = 0; n < neighbors.size(); ++n) {
    limits.others[n].second = shiftOf(neighbors[n], progress);
  }
  const float shift = shiftOf(index, progress);
  const bool is_lapped = edge == LabelEdge::kLapped;
  const Vec3 lengths = lengthsOf(image_);
  // Between thick slices a layer one slice thin has small values. A lap over its centers from both
  // sides would close the slit that it lies in.
  const bool is_thick = std::max({lengths.x, lengths.y, lengths.z}) >
                        kThick * std::min({lengths.x, lengths.y, lengths.z});
  const Mask& voxels = cached(layers_[index], progress).mask;
  const auto lap =
      static_cast<float>(std::min(kMostLap, kLap * std::max({lengths.x, lengths.y, lengths.z}) /
                                                std::min({lengths.x, lengths.y, lengths.z})));
  if (is_lapped) {
    own.neighbors = own.mask;
    std::fill(own.neighbors.inside.begin(), own.neighbors.inside.end(), std::uint8_t{0});
    own.parting.resize(own.band.blocks.size());
  }
  forBlocks(own.band.blocks.size(), [&](std::size_t b) {
    BandBlock& block = own.band.blocks[b];
    forVoxels(block, [&](std::size_t n, const std::array<int, 3>& at) {
      const int x = own.band.first[0] + at[0];
      const int y = own.band.first[1] + at[1];
      const int z = own.band.first[2] + at[2];
      const float least = limits.leastAt(x, y, z);
      const float united = limits.whole->band.valueAt(x, y, z);
      float& value = block.value[n];
      const auto here = static_cast<std::size_t>(own.mask.at(at[0], at[1], at[2]));
      std::uint8_t& inside = own.mask.inside[here];
      value = shifted(value, shift, inside != 0);
      value = is_lapped ? lapped(value, least, united, lap) : shared(value, least, united);
      const bool is_within = limits.whole->mask.holds(x, y, z);
      if (is_lapped && is_thick && inside == 0 && value < kOffWall && isInSlit(voxels, x, y, z)) {
        value = kOffWall;
      }
      if (is_lapped) own.parting[b][n] = is_within ? partingOf(united, lap) : 0.0F;
      if (is_lapped && inside == 0 && is_within) {
        own.neighbors.inside[here] = 1;
        inside = value < 0.0F ? 1 : 0;
      }
      value = onSide(value, inside != 0);
    });
  });
  closeBand(own.band, own.mask);
  return own;
}

std::optional<MaskedBand> LabelPartition::unite(const Progress& progress) {
  const std::lock_guard lock(mutex_);
  Labels all;
  bool any = false;
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    all = together(all, layers_[n]);
    if (any) continue;
    const std::vector<std::size_t> neighbors = neighborsOf(n, progress);
    any = std::any_of(neighbors.begin(), neighbors.end(), [&](std::size_t other) {
      return other > n &&
             meet(cached(layers_[n], progress).mask, cached(layers_[other], progress).mask);
    });
  }
  if (!any) return {};
  Limits members;
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    const MaskedBand& member = cached(layers_[n], progress);
    if (!member.mask.inside.empty()) {
      members.others.emplace_back(&member, shiftOf(n, progress));
    }
  }
  MaskedBand result = cached(all, progress);
  forBlocks(result.band.blocks.size(), [&](std::size_t b) {
    BandBlock& block = result.band.blocks[b];
    forVoxels(block, [&](std::size_t n, const std::array<int, 3>& at) {
      const float least = members.leastAt(
          result.band.first[0] + at[0], result.band.first[1] + at[1], result.band.first[2] + at[2]);
      // The value of the rest is the negative of that of all layers together.
      const float value = std::isnan(least) ? block.value[n] : 0.5F * (block.value[n] + least);
      const auto here = static_cast<std::size_t>(result.mask.at(at[0], at[1], at[2]));
      block.value[n] = onSide(value, result.mask.inside[here] != 0);
    });
  });
  closeBand(result.band, result.mask);
  return result;
}

}  // namespace palpate::vdb
