// One look into bricks, in terms of simd.h, which is included before: a kernel's translation unit
// compiles this for its own instruction set.
//
// The cubic kernel: with c the 4^3 coefficients around the point and w, d, e the weights of the cubic
// B-spline, its first and its second derivative along one axis,
//   value = sum wx wy wz c,  d/dx = sum dx wy wz c,  d2/dxdy = sum dx dy wz c,  ...
// Sums run over y first, then x, each on four lanes along z; then over the lanes.

/// Where a point lies: its brick and the place in it.
struct Place {
  std::uint32_t entry = BrickView::kOutside;
  int x = 0, y = 0, z = 0;              ///< cell in the block, from 0 to 7
  double tx = 0.0, ty = 0.0, tz = 0.0;  ///< in the cell, from 0 to 1
  bool in_box = false;
};

PALPATE_KERNEL Place locate(const BrickView& view, const Vec3& p) noexcept {
  Place place;
  const double x = (p.x - view.origin.x) * view.per_voxel;
  const double y = (p.y - view.origin.y) * view.per_voxel;
  const double z = (p.z - view.origin.z) * view.per_voxel;
  // Written so that a NaN is out.
  place.in_box = x >= 0.0 && x < view.extent.x && y >= 0.0 && y < view.extent.y && z >= 0.0 &&
                 z < view.extent.z;
  if (!place.in_box) return place;
  const auto i = static_cast<int>(x);
  const auto j = static_cast<int>(y);
  const auto k = static_cast<int>(z);
  place.tx = x - i;
  place.ty = y - j;
  place.tz = z - k;
  place.x = i & 7;
  place.y = j & 7;
  place.z = k & 7;
  const auto bx = static_cast<std::uint32_t>(i) >> 3;
  const auto by = static_cast<std::uint32_t>(j) >> 3;
  const auto bz = static_cast<std::uint32_t>(k) >> 3;
  if (view.coarse == nullptr) {
    place.entry =
        view.blocks[static_cast<std::size_t>(bx) * view.stride_x + by * view.stride_y + bz];
    return place;
  }
  const std::uint32_t group = view.coarse[static_cast<std::size_t>(bx >> 3) * view.stride_x +
                                          (by >> 3) * view.stride_y + (bz >> 3)];
  place.entry = group >= BrickView::kInside
                    ? group
                    : view.blocks[static_cast<std::size_t>(group) * 512 +
                                  ((bx & 7) << 6 | (by & 7) << 3 | (bz & 7))];
  return place;
}

PALPATE_KERNEL const Brick& brickAt(const BrickView& view, std::uint32_t entry) noexcept {
  return *reinterpret_cast<const Brick*>(view.bricks +
                                         static_cast<std::size_t>(entry) * BrickView::kUnit);
}

PALPATE_KERNEL bool isKnown(const Brick& brick, const Place& place) noexcept {
  return (brick.known[place.x * 8 + place.y] >> place.z & 1U) != 0;
}

/// Weights of the four coefficients along one axis: cubic B-spline, at t behind the second.
struct Weights {
  Lanes value, slope, bend;
};

PALPATE_KERNEL Weights weightsAt(double at) noexcept {
  const Lanes t = all(at);
  constexpr double kSixth = 1.0 / 6.0;
  const Lanes c0{kSixth, 4.0 * kSixth, kSixth, 0.0};
  const Lanes c1{-0.5, 0.0, 0.5, 0.0};
  const Lanes c2{0.5, -1.0, 0.5, 0.0};
  const Lanes c3{-kSixth, 0.5, -0.5, kSixth};
  return {fma(fma(fma(c3, t, c2), t, c1), t, c0), fma(fma(3.0 * c3, t, 2.0 * c2), t, c1),
          fma(6.0 * c3, t, 2.0 * c2)};
}

/// w0 r0 + w1 r1 + w2 r2 + w3 r3, as two chains that run at once.
PALPATE_KERNEL Lanes weighted(Lanes w, Lanes r0, Lanes r1, Lanes r2, Lanes r3) noexcept {
  return fma(all(w[1]), r1, all(w[0]) * r0) + fma(all(w[3]), r3, all(w[2]) * r2);
}

/// Sums over y of the four slabs along x, by value, first and second derivative of the y weights.
struct Slabs {
  Lanes value[4], slope[4], bend[4];
};

template <bool kWithBend>
PALPATE_KERNEL Slabs sumRows(const Brick& brick, const Place& place, const Weights& y) noexcept {
  Slabs slabs;
  const float* row = brick.values + (place.x * Brick::kSlab + place.y * Brick::kRow + place.z);
  for (int n = 0; n < 4; ++n, row += Brick::kSlab) {
    const Lanes r0 = load(row);
    const Lanes r1 = load(row + Brick::kRow);
    const Lanes r2 = load(row + 2 * Brick::kRow);
    const Lanes r3 = load(row + 3 * Brick::kRow);
    slabs.value[n] = weighted(y.value, r0, r1, r2, r3);
    slabs.slope[n] = weighted(y.slope, r0, r1, r2, r3);
    if constexpr (kWithBend) slabs.bend[n] = weighted(y.bend, r0, r1, r2, r3);
  }
  return slabs;
}

PALPATE_KERNEL Lanes sumSlabs(Lanes w, const Lanes (&s)[4]) noexcept {
  return weighted(w, s[0], s[1], s[2], s[3]);
}

PALPATE_ENTRY FieldSample sampleCubic(const BrickView& view, const Vec3& p) noexcept {
  const Place place = locate(view, p);
  if (!place.in_box) [[unlikely]]
    return sampleBeyond(view, p);
  if (place.entry >= BrickView::kInside) [[unlikely]]
    return sampleWithoutBrick(view, place.entry);
  const Brick& brick = brickAt(view, place.entry);
  const Weights x = weightsAt(place.tx);
  const Weights y = weightsAt(place.ty);
  const Weights z = weightsAt(place.tz);
  const Slabs slabs = sumRows<false>(brick, place, y);
  const Lanes value = sumSlabs(x.value, slabs.value);
  const Lanes all_sums = sums(value * z.value, sumSlabs(x.slope, slabs.value) * z.value,
                              sumSlabs(x.value, slabs.slope) * z.value, value * z.slope);
  const double distance = all_sums[0] * view.voxel;
  if (!isKnown(brick, place)) [[unlikely]]
    return {distance, Vec3(0.0), false};
  return {distance, Vec3(all_sums[1], all_sums[2], all_sums[3]), true};
}

PALPATE_ENTRY FieldJet jetCubic(const BrickView& view, const Vec3& p) noexcept {
  const Place place = locate(view, p);
  if (!place.in_box || place.entry >= BrickView::kInside) [[unlikely]] {
    const FieldSample sample =
        place.in_box ? sampleWithoutBrick(view, place.entry) : sampleBeyond(view, p);
    return {sample.value, sample.gradient, Mat3(0.0), false};
  }
  const Brick& brick = brickAt(view, place.entry);
  const Weights x = weightsAt(place.tx);
  const Weights y = weightsAt(place.ty);
  const Weights z = weightsAt(place.tz);
  const Slabs slabs = sumRows<true>(brick, place, y);
  const Lanes s = sumSlabs(x.value, slabs.value);
  const Lanes sx = sumSlabs(x.slope, slabs.value);
  const Lanes sy = sumSlabs(x.value, slabs.slope);
  const Lanes first = sums(s * z.value, sx * z.value, sy * z.value, s * z.slope);
  const double distance = first[0] * view.voxel;
  if (!isKnown(brick, place)) [[unlikely]]
    return {distance, Vec3(0.0), Mat3(0.0), false};
  const Lanes second = sums(sumSlabs(x.bend, slabs.value) * z.value,
                            sumSlabs(x.value, slabs.bend) * z.value, s * z.bend, sy * z.slope);
  const Lanes mixed =
      sums(sumSlabs(x.slope, slabs.slope) * z.value, sx * z.slope, all(0.0), all(0.0));
  const double scale = view.per_voxel;
  const double xy = mixed[0] * scale;
  const double xz = mixed[1] * scale;
  const double yz = second[3] * scale;
  return {distance, Vec3(first[1], first[2], first[3]),
          Mat3(second[0] * scale, xy, xz, xy, second[1] * scale, yz, xz, yz, second[2] * scale),
          true};
}

/// Trilinear, out of bricks that hold the grid's own values.
PALPATE_ENTRY FieldSample sampleLinear(const BrickView& view, const Vec3& p) noexcept {
  const Place place = locate(view, p);
  if (!place.in_box) [[unlikely]]
    return sampleBeyond(view, p);
  if (place.entry >= BrickView::kInside) [[unlikely]]
    return sampleWithoutBrick(view, place.entry);
  const Brick& brick = brickAt(view, place.entry);
  const float* const near = brick.values + Brick::at(place.x, place.y, place.z);
  const float* const far = near + Brick::kSlab;
  // Lanes: the four edges along z. Along z, then y, then x; each step keeps the differences.
  const Lanes low{near[0], near[Brick::kRow], far[0], far[Brick::kRow]};
  const Lanes high{near[1], near[Brick::kRow + 1], far[1], far[Brick::kRow + 1]};
  const Lanes dz = high - low;
  const Lanes v = fma(all(place.tz), dz, low);
  const double near_y = v[1] - v[0];
  const double far_y = v[3] - v[2];
  const double near_v = v[0] + place.ty * near_y;
  const double far_v = v[2] + place.ty * far_y;
  const double dx = far_v - near_v;
  const double distance = (near_v + place.tx * dx) * view.voxel;
  if (!isKnown(brick, place)) [[unlikely]]
    return {distance, Vec3(0.0), false};
  const double near_z = dz[0] + place.ty * (dz[1] - dz[0]);
  const double far_z = dz[2] + place.ty * (dz[3] - dz[2]);
  return {distance,
          Vec3(dx, near_y + place.tx * (far_y - near_y), near_z + place.tx * (far_z - near_z)),
          true};
}
