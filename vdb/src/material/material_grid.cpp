#include "palpate/vdb/material_grid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "material/blocks.h"
#include "material/fill.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

/// [SI unit] The value of a voxel of `count` steps, rounded to the float that files hold.
float stepped(const Quantisation& how, double count) noexcept {
  return static_cast<float>(how.least + how.step * count);
}

double countOf(const Quantisation& how, float value) noexcept {
  const double most = std::exp2(how.bits) - 1.0;
  return std::clamp(std::round((static_cast<double>(value) - how.least) / how.step), 0.0, most);
}

double errorOf(const Quantisation& how, const std::vector<float>& values) {
  double most = 0.0;
  for (const float value : values) {
    const double stored = how.least + how.step * countOf(how, value);
    most = std::max(most, std::fabs(static_cast<double>(value) - stored));
  }
  return most;
}

/// The fewest bits whose error stays within `tolerance`.
Quantisation chooseBits(const std::vector<float>& values, MaterialMap::Range range,
                        double tolerance) {
  if (range.least == range.most) return {};
  for (const int bits : {8, 16}) {
    Quantisation how;
    how.bits = bits;
    how.least = range.least;
    how.step = (range.most - range.least) / (std::exp2(bits) - 1.0);
    // The error is half a step, or less if there are few distinct values: try if the step is not
    // far too large.
    if (tolerance > 0.0 && how.step <= 4096.0 * tolerance) {
      how.error = errorOf(how, values);
      if (how.error <= tolerance) return how;
    }
  }
  return {};
}

bool isMadeOf(const Quantisation& known, const std::vector<float>& values) {
  if (known.bits == 32 || !(known.step > 0.0)) return false;
  return std::all_of(values.begin(), values.end(),
                     [&](float value) { return stepped(known, countOf(known, value)) == value; });
}

/// Weights of the three nearest voxels along an axis, and the derivatives of the weights per voxel,
/// at `t` from the middle one.
struct Weights {
  std::array<double, 3> value;
  std::array<double, 3> slope;

  explicit Weights(double t) noexcept
      : value{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
        slope{t - 0.5, -2.0 * t, t + 0.5} {}
};

/// Interpolates stored counts (or values), with the gradient per voxel.
template <typename T>
MaterialMap::Sample spline(const T* corner, int row, const Weights& x, const Weights& y,
                           const Weights& z) noexcept {
  MaterialMap::Sample out;
  for (std::size_t k = 0; k < 3; ++k) {
    double plane = 0.0;
    Vec3 slope(0.0);
    for (std::size_t j = 0; j < 3; ++j) {
      const T* const line = corner + (static_cast<int>(k) * row + static_cast<int>(j)) * row;
      const auto a = static_cast<double>(line[0]);
      const auto b = static_cast<double>(line[1]);
      const auto c = static_cast<double>(line[2]);
      const double value = x.value[0] * a + x.value[1] * b + x.value[2] * c;
      plane += y.value[j] * value;
      slope.x += y.value[j] * (x.slope[0] * a + x.slope[1] * b + x.slope[2] * c);
      slope.y += y.slope[j] * value;
    }
    out.value += z.value[k] * plane;
    out.gradient.x += z.value[k] * slope.x;
    out.gradient.y += z.value[k] * slope.y;
    out.gradient.z += z.slope[k] * plane;
  }
  return out;
}

/// The same without the gradient.
template <typename T>
double splineValue(const T* corner, int row, const Weights& x, const Weights& y,
                   const Weights& z) noexcept {
  double out = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double plane = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      const T* const line = corner + (static_cast<int>(k) * row + static_cast<int>(j)) * row;
      plane += y.value[j] * (x.value[0] * static_cast<double>(line[0]) +
                             x.value[1] * static_cast<double>(line[1]) +
                             x.value[2] * static_cast<double>(line[2]));
    }
    out += z.value[k] * plane;
  }
  return out;
}

/// Copies the counts (or values) of a block with its border; beyond the grid the outermost voxels
/// are repeated.
template <typename T, typename Count>
void fillBlock(const Image& voxels, const std::array<int, 3>& first, T* out, const Count& count) {
  constexpr int kRow = 10;
  for (int k = 0; k < kRow; ++k) {
    for (int j = 0; j < kRow; ++j) {
      for (int i = 0; i < kRow; ++i) {
        const float value = voxels.at(std::clamp(first[0] + i - 1, 0, voxels.size[0] - 1),
                                      std::clamp(first[1] + j - 1, 0, voxels.size[1] - 1),
                                      std::clamp(first[2] + k - 1, 0, voxels.size[2] - 1));
        *out++ = static_cast<T>(count(value));
      }
    }
  }
}

/// Fills all blocks of a grid; a block of one value is not stored.
template <typename T, typename Blocks, typename Count>
void fillBlocks(const Image& voxels, Blocks& blocks, std::vector<T>& data, const Count& count) {
  const auto& n = blocks.count;
  const auto first_of = [&](std::size_t b) {
    const auto at = static_cast<int>(b);
    return std::array<int, 3>{8 * (at % n[0]), 8 * ((at / n[0]) % n[1]), 8 * (at / (n[0] * n[1]))};
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.table.size()), [&](const auto& r) {
    std::array<T, Blocks::kVolume> block;
    for (std::size_t b = r.begin(); b != r.end(); ++b) {
      fillBlock(voxels, first_of(b), block.data(), count);
      const bool alike =
          std::all_of(block.begin(), block.end(), [&](T v) { return v == block[0]; });
      blocks.table[b].first = alike ? Blocks::kUniform : 0;
      blocks.table[b].uniform = static_cast<float>(block[0]);
    }
  });
  std::uint32_t stored = 0;
  for (auto& block : blocks.table) {
    if (block.first != Blocks::kUniform) block.first = stored++;
  }
  data.resize(stored * Blocks::kVolume);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.table.size()), [&](const auto& r) {
    for (std::size_t b = r.begin(); b != r.end(); ++b) {
      if (blocks.table[b].first == Blocks::kUniform) continue;
      fillBlock(voxels, first_of(b), data.data() + blocks.table[b].first * Blocks::kVolume, count);
    }
  });
}

Box3 boundsOf(const Image& image) {
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index(0.0);
    for (int i = 0; i < 3; ++i) {
      if (((corner >> i) & 1) != 0) index[i] = image.size[static_cast<std::size_t>(i)] - 1.0;
    }
    box.include(image.toWorld(index));
  }
  return box;
}

}  // namespace

double MaterialGrid::Blocks::at(int i, int j, int k, int bits) const noexcept {
  const Block& block = blockOf(i, j, k);
  if (block.first == kUniform) return static_cast<double>(block.uniform);
  // Offset from the first of the 3^3 voxels to the middle one.
  constexpr std::size_t kMiddle = (kRow + 1) * kRow + 1;
  const std::size_t voxel = block.first * kVolume + cornerOf(i, j, k) + kMiddle;
  if (bits == 8) return bytes[voxel];
  return bits == 16 ? static_cast<double>(words[voxel]) : static_cast<double>(floats[voxel]);
}

MaterialGrid::MaterialGrid(Image voxels, double tolerance, std::uint64_t max_memory) {
  store(std::move(voxels), tolerance, nullptr, max_memory);
}

MaterialGrid::MaterialGrid(Image voxels, double tolerance, const Quantisation& known,
                           std::uint64_t max_memory) {
  store(std::move(voxels), tolerance, &known, max_memory);
}

MaterialGrid::~MaterialGrid() = default;

void MaterialGrid::store(Image voxels, double tolerance, const Quantisation* known,
                         std::uint64_t max_memory) {
  if (!fillUnknown(voxels.size, voxels.values)) {
    throw inputError("material.empty", "no voxel of it has a value");
  }
  const auto [low, high] = std::minmax_element(voxels.values.begin(), voxels.values.end());
  range_ = {static_cast<double>(*low), static_cast<double>(*high)};
  const bool is_known = known != nullptr && isMadeOf(*known, voxels.values);
  Quantisation how = is_known ? *known : chooseBits(voxels.values, range_, tolerance);
  if (how.bits != 32) {
    // Samples read the exact steps, not the floats nearest to them.
    range_ = {how.least + how.step * countOf(how, *low),
              how.least + how.step * countOf(how, *high)};
  }

  auto blocks = std::make_unique<Blocks>();
  std::size_t count = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    blocks->size[i] = voxels.size[i];
    blocks->count[i] = (voxels.size[i] + Blocks::kSide - 1) / Blocks::kSide;
    count *= static_cast<std::size_t>(blocks->count[i]);
  }
  const std::uint64_t most =
      count * (Blocks::kVolume * static_cast<std::size_t>(how.bits / 8) + sizeof(Blocks::Block));
  if (max_memory > 0 && most > max_memory) {
    throw Error(ErrorKind::kOperation,
                {"bake.memory",
                 "the material grid would take up to " + std::to_string(most) +
                     " bytes, more than " + std::to_string(max_memory) + " allowed",
                 "allow more memory, or a larger tolerance, which takes fewer bits", ""});
  }
  blocks->table.resize(count);
  const auto counted = [&](float value) { return countOf(how, value); };
  if (how.bits == 8) {
    fillBlocks(voxels, *blocks, blocks->bytes, counted);
  } else if (how.bits == 16) {
    fillBlocks(voxels, *blocks, blocks->words, counted);
  } else {
    how.least = 0.0;
    how.step = 1.0;
    fillBlocks(voxels, *blocks, blocks->floats, [](float value) { return value; });
  }

  axes_ = voxels.axes;
  origin_ = voxels.origin;
  to_index_ = glm::inverse(voxels.axes);
  to_world_slope_ = how.step * glm::transpose(to_index_);
  info_.source = voxels.source;
  info_.size = voxels.size;
  info_.voxel_size =
      std::min({glm::length(axes_[0]), glm::length(axes_[1]), glm::length(axes_[2])});
  info_.bounds = boundsOf(voxels);
  info_.quantisation = how;
  info_.memory = blocks->memory();
  blocks_ = std::move(blocks);
}

struct MaterialGrid::Place {
  std::size_t corner = 0;  ///< index of the first of the 27 voxels in the data of the blocks
  std::array<double, 3> off{};
  const Blocks::Block* block = nullptr;
};

MaterialGrid::Place MaterialGrid::placeOf(const Vec3& p) const noexcept {
  const Blocks& blocks = *blocks_;
  const Vec3 at = to_index_ * (p - origin_);
  std::array<int, 3> nearest{};
  Place out;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const int last = blocks.size[a] - 1;
    // Half a voxel beyond the outermost center all three voxels are the same, and so on outwards.
    const double u = std::clamp(at[axis], -0.5, last + 0.5);
    // Counted from the first voxel's outer face: not negative, so that truncation rounds down.
    const double voxels = u + 0.5;
    nearest[a] = std::min(static_cast<int>(voxels), last);
    out.off[a] = u - nearest[a];
  }
  out.block = &blocks.blockOf(nearest[0], nearest[1], nearest[2]);
  out.corner =
      out.block->first * Blocks::kVolume + Blocks::cornerOf(nearest[0], nearest[1], nearest[2]);
  return out;
}

template <typename OfData>
auto MaterialGrid::read(const OfData& of) const noexcept {
  const Blocks& blocks = *blocks_;
  switch (info_.quantisation.bits) {
    case 8:
      return of(blocks.bytes.data());
    case 16:
      return of(blocks.words.data());
    default:
      return of(blocks.floats.data());
  }
}

MaterialMap::Sample MaterialGrid::sample(const Vec3& p) const noexcept {
  const Place place = placeOf(p);
  const Quantisation& how = info_.quantisation;
  if (place.block->first == Blocks::kUniform) {
    return {how.least + how.step * static_cast<double>(place.block->uniform), Vec3(0.0)};
  }
  const Weights x(place.off[0]);
  const Weights y(place.off[1]);
  const Weights z(place.off[2]);
  Sample out =
      read([&](const auto* data) { return spline(data + place.corner, Blocks::kRow, x, y, z); });
  // Rounding must not put the value outside the range of the voxels.
  out.value = std::clamp(how.least + how.step * out.value, range_.least, range_.most);
  out.gradient = to_world_slope_ * out.gradient;
  return out;
}

double MaterialGrid::value(const Vec3& p) const noexcept {
  const Place place = placeOf(p);
  const Quantisation& how = info_.quantisation;
  if (place.block->first == Blocks::kUniform) {
    return how.least + how.step * static_cast<double>(place.block->uniform);
  }
  const Weights x(place.off[0]);
  const Weights y(place.off[1]);
  const Weights z(place.off[2]);
  const double count = read(
      [&](const auto* data) { return splineValue(data + place.corner, Blocks::kRow, x, y, z); });
  return std::clamp(how.least + how.step * count, range_.least, range_.most);
}

Image MaterialGrid::voxels() const {
  Image out;
  out.source = info_.source;
  out.size = info_.size;
  out.axes = axes_;
  out.origin = origin_;
  out.values.reserve(static_cast<std::size_t>(out.size[0]) * static_cast<std::size_t>(out.size[1]) *
                     static_cast<std::size_t>(out.size[2]));
  const Quantisation& how = info_.quantisation;
  for (int k = 0; k < out.size[2]; ++k) {
    for (int j = 0; j < out.size[1]; ++j) {
      for (int i = 0; i < out.size[0]; ++i) {
        out.values.push_back(stepped(how, blocks_->at(i, j, k, how.bits)));
      }
    }
  }
  return out;
}

}  // namespace palpate::vdb
