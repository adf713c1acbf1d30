#include "bake/leaf_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace palpate::vdb {
namespace {

using Flags = std::array<std::uint8_t, PointBatch::kCount>;

/// Bit n of the result is flag n, which is 0 or 1. Eight flags at a time: the multiplication moves
/// flag n of the eight to bit 56 + n, and no two of its terms meet at one bit.
std::uint64_t bitsOf(const Flags& flags) noexcept {
  std::uint64_t bits = 0;
  for (std::size_t group = 0; group < 8; ++group) {
    static_assert(std::endian::native == std::endian::little, "the first flag is the lowest byte");
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags.data() + 8 * group, 8);
    bits |= (eight * 0x0102040810204080U >> 56) << (8 * group);
  }
  return bits;
}

}  // namespace

void LeafValues::fill(const openvdb::Coord& local, float value) noexcept {
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      std::fill_n(values.begin() + BandLeaf::coordToOffset(local.offsetBy(x, y, 0)), 4, value);
    }
  }
  (value < 0.0F ? any_inside : any_outside) = true;
}

void LeafValues::store(const openvdb::Coord& local, const ValueBatch& distances,
                       double units_per_meter, float background) noexcept {
  std::array<float, PointBatch::kCount> found, stored;
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
    found[n] = static_cast<float>(distances[n] * units_per_meter);
  }
  Flags is_near, is_number, is_inside;
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
    is_near[n] = std::fabs(found[n]) < background ? 1 : 0;
    is_inside[n] = found[n] < 0.0F ? 1 : 0;
    is_number[n] = found[n] == found[n] ? 1 : 0;
    const float far = std::copysign(background, found[n]);
    stored[n] = std::fabs(found[n]) < background ? found[n] : far;
  }
  const std::uint64_t near = bitsOf(is_near);
  const std::uint64_t inside = bitsOf(is_inside);
  is_broken = is_broken || bitsOf(is_number) != ~std::uint64_t{0};
  any_active = any_active || near != 0;
  any_inside = any_inside || inside != 0;
  any_outside = any_outside || inside != ~std::uint64_t{0};
  const unsigned first = BandLeaf::coordToOffset(local);
  const unsigned shift = first & 63U;
  for (std::size_t x = 0; x < 4; ++x) {
    const auto rows = near >> (16 * x) & 0xFFFFU;
    std::uint64_t spread = 0;
    for (std::size_t y = 0; y < 4; ++y) {
      std::copy_n(stored.begin() + 16 * x + 4 * y, 4, values.begin() + first + 64 * x + 8 * y);
      spread |= (rows >> (4 * y) & 0xFU) << (8 * y);
    }
    active[(first >> 6) + x] |= spread << shift;
  }
}

std::unique_ptr<BandLeaf> LeafValues::leafAt(const openvdb::Coord& origin, float background) const {
  auto leaf = std::make_unique<BandLeaf>(openvdb::PartialCreate(), origin, background, false);
  leaf->allocate();
  std::memcpy(leaf->buffer().data(), values.data(), sizeof values);
  BandLeaf::NodeMaskType mask;
  for (openvdb::Index x = 0; x < 8; ++x) mask.getWord<openvdb::Index64>(x) = active[x];
  leaf->setValueMask(mask);
  return leaf;
}

}  // namespace palpate::vdb
