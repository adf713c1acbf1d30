#include "scan/label_partition.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

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

/// Whether both bands hold a voxel: their layers are near each other somewhere.
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

}  // namespace

LabelPartition::LabelPartition(const Image& image, std::vector<std::vector<int>> layers)
    : image_(image), layers_(std::move(layers)) {
  std::vector<int> all;
  for (std::vector<int>& layer : layers_) {
    std::sort(layer.begin(), layer.end());
    all.insert(all.end(), layer.begin(), layer.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  layers_.push_back(std::move(all));
  made_.resize(layers_.size());
}

std::shared_ptr<const MaskedBand> LabelPartition::smoothed(const std::vector<int>& labels,
                                                           const Progress& progress) const {
  auto result = std::make_shared<MaskedBand>();
  const auto is_label = [&](float value) {
    return std::any_of(labels.begin(), labels.end(),
                       [&](int label) { return static_cast<float>(label) == value; });
  };
  result->mask = maskOf(image_, is_label, kBandMargin);
  if (result->mask.inside.empty()) return result;
  const Vec3 lengths(glm::length(image_.axes[0]), glm::length(image_.axes[1]),
                     glm::length(image_.axes[2]));
  const double smallest = std::min({lengths.x, lengths.y, lengths.z});
  result->band = bandOf(result->mask, lengths / smallest);
  smoothBand(result->band, result->mask, image_.axes / smallest, progress);
  keepVolume(result->band, result->mask);
  result->band.bounds = {};
  return result;
}

std::shared_ptr<const MaskedBand> LabelPartition::cached(std::size_t index,
                                                         const Progress& progress) {
  if (!made_[index]) made_[index] = smoothed(layers_[index], progress);
  return made_[index];
}

bool LabelPartition::haveCommonLabel(std::size_t a, std::size_t b) const {
  std::vector<int> common;
  std::set_intersection(layers_[a].begin(), layers_[a].end(), layers_[b].begin(), layers_[b].end(),
                        std::back_inserter(common));
  return !common.empty();
}

MaskedBand LabelPartition::layer(std::size_t index, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  const std::size_t all = layers_.size() - 1;
  MaskedBand own = *cached(index, progress);
  if (own.mask.inside.empty()) return own;
  std::vector<const Band*> others;
  for (std::size_t n = 0; n < all; ++n) {
    if (n == index || haveCommonLabel(n, index)) continue;
    const auto other = cached(n, progress);
    if (!other->mask.inside.empty() && touch(own.mask, other->mask) &&
        haveCommonVoxel(own.band, other->band)) {
      others.push_back(&other->band);
    }
  }
  const Band* const whole = others.empty() ? nullptr : &cached(all, progress)->band;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, own.band.blocks.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t b = range.begin(); b != range.end(); ++b) {
                        BandBlock& block = own.band.blocks[b];
                        for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
                          float& value = block.value[n];
                          if (std::isnan(value)) continue;
                          const auto place = static_cast<int>(n);
                          const int i = block.first[0] + (place >> 6);
                          const int j = block.first[1] + (place >> 3 & 7);
                          const int k = block.first[2] + (place & 7);
                          if (whole != nullptr) {
                            const int x = own.band.first[0] + i;
                            const int y = own.band.first[1] + j;
                            const int z = own.band.first[2] + k;
                            // What is in no layer; NaN is less than nothing.
                            float least = -whole->valueAt(x, y, z);
                            for (const Band* const other : others)
                              least = std::fmin(least, other->valueAt(x, y, z));
                            if (!std::isnan(least)) value = 0.5F * (value - least);
                          }
                          const bool inside =
                              own.mask.inside[static_cast<std::size_t>(own.mask.at(i, j, k))] != 0;
                          value =
                              inside ? std::min(value, -kLeastValue) : std::max(value, kLeastValue);
                        }
                      }
                    });
  return own;
}

}  // namespace palpate::vdb
