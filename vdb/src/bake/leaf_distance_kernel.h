#pragma once
/// The search of leaf_distance.h, over a type of eight lanes. In an unnamed namespace and without any
/// of the standard library's code, since it is compiled for several processors.

#include "bake/leaf_distance.h"

namespace palpate::vdb {
namespace {  // NOLINT(google-build-namespaces): see above

/// Squares of the distances from eight points about `middle` to a facet.
template <typename Lanes>
inline Lanes squaresOf(const Facet& f, const Lanes& x, const Lanes& y, const Lanes& z) {
  const auto plane = [&](const float* n, const Lanes& offset) {
    return fma(Lanes(n[0]), x, fma(Lanes(n[1]), y, fma(Lanes(n[2]), z, offset)));
  };
  const Lanes zero(0.0F);
  Lanes outermost(0.0F);
  Lanes beyond_longest(0.0F);
  Lanes least(0.0F);
  for (int n = 0; n < 3; ++n) {
    const Lanes out = plane(f.out[n], Lanes(f.out[n][3]));
    const Lanes along = plane(f.along[n], zero);
    const Lanes beyond = max(max(Lanes(f.begin[n]) - along, along - Lanes(f.end[n])), zero);
    const Lanes square = fma(out, out, beyond * beyond);
    outermost = n == 0 ? out : max(outermost, out);
    if (n == 0) beyond_longest = beyond;
    least = n == 0 ? square : min(least, square);
  }
  const Lanes height = plane(f.normal, Lanes(f.normal[3]));
  // Beside the longest side, or else rounding could take the way beyond a needle's tip for its inside.
  const Lanes in_plane = zeroWhere(isNegative(outermost) & isZero(beyond_longest), least);
  return fma(height, height, in_plane);
}

/// Coordinates of the middles of the eight parts of a cube.
template <typename Lanes>
struct Eight {
  Lanes x, y, z;
  Eight(float mx, float my, float mz, float step)
      : x(Lanes::xSigns(step) + Lanes(mx)),
        y(Lanes::ySigns(step) + Lanes(my)),
        z(Lanes::zSigns(step) + Lanes(mz)) {}
};

inline float squareOf(float v) { return v * v; }

/// Of `count` facets those within reach of the cube in `lane`; `reach` is its half diagonal.
template <typename Lanes>
inline std::uint32_t select(const float* squares, const std::uint32_t* from, std::uint32_t count,
                            int lane, float reach, float half_width, std::uint32_t* to) {
  float least = kFarSquare;
  for (std::uint32_t n = 0; n < count; ++n) {
    const float here = squares[8 * n + static_cast<std::uint32_t>(lane)];
    least = here < least ? here : least;
  }
  // A hundred-thousandth covers the rounding.
  const float most = half_width + reach + 1e-4F;
  if (least > squareOf(most)) return 0;
  float limit = Lanes::root(least) * 1.00001F + 2.0F * reach + 1e-4F;
  limit = squareOf(limit < most ? limit : most);
  std::uint32_t kept = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    to[kept] = from == nullptr ? n : from[n];
    kept += squares[8 * n + static_cast<std::uint32_t>(lane)] <= limit ? 1U : 0U;
  }
  return kept;
}

template <typename Lanes>
inline void measure(const LeafQuery& q, const std::uint32_t* list, std::uint32_t count,
                    const Eight<Lanes>& at, float* squares) {
  for (std::uint32_t n = 0; n < count; ++n) {
    const Facet& facet = q.facets[list == nullptr ? n : list[n]];
    squaresOf(facet, at.x, at.y, at.z).store(squares + std::size_t{8} * n);
  }
}

template <typename Lanes>
inline void searchLeaf(const LeafQuery& q) {
  constexpr float kReachFour = 2.598077F;
  constexpr float kReachTwo = 0.8660254F;
  for (int n = 0; n < 512; ++n) q.squares[n] = kFarSquare;
  measure<Lanes>(q, nullptr, q.count, Eight<Lanes>(0.0F, 0.0F, 0.0F, 2.0F), q.eight);
  for (int four = 0; four < 8; ++four) {
    const std::uint32_t nearby =
        select<Lanes>(q.eight, nullptr, q.count, four, kReachFour, q.half_width, q.nearby);
    if (nearby == 0) continue;
    const int fx = four >> 2, fy = (four >> 1) & 1, fz = four & 1;
    const float x = 4.0F * static_cast<float>(fx) - 2.0F;
    const float y = 4.0F * static_cast<float>(fy) - 2.0F;
    const float z = 4.0F * static_cast<float>(fz) - 2.0F;
    measure<Lanes>(q, q.nearby, nearby, Eight<Lanes>(x, y, z, 1.0F), q.four);
    for (int two = 0; two < 8; ++two) {
      const std::uint32_t close =
          select<Lanes>(q.four, q.nearby, nearby, two, kReachTwo, q.half_width, q.close);
      if (close == 0) continue;
      const int tx = two >> 2, ty = (two >> 1) & 1, tz = two & 1;
      const Eight<Lanes> at(x + 2.0F * static_cast<float>(tx) - 1.0F,
                            y + 2.0F * static_cast<float>(ty) - 1.0F,
                            z + 2.0F * static_cast<float>(tz) - 1.0F, 0.5F);
      Lanes least(kFarSquare);
      for (std::uint32_t n = 0; n < close; ++n) {
        least = min(least, squaresOf(q.facets[q.close[n]], at.x, at.y, at.z));
      }
      float found[8];
      least.store(found);
      const int first = (4 * fx + 2 * tx) * 64 + (4 * fy + 2 * ty) * 8 + 4 * fz + 2 * tz;
      float* const corner = q.squares + first;
      for (int n = 0; n < 8; ++n) corner[(n >> 2) * 64 + ((n >> 1) & 1) * 8 + (n & 1)] = found[n];
    }
  }
}

}  // namespace
}  // namespace palpate::vdb
