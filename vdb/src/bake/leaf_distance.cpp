#include "bake/leaf_distance.h"

#include <cmath>

namespace palpate::vdb {
namespace {

#define PALPATE_KERNEL inline

/// Eight lanes for any processor; compilers make of the loops what it has.
struct Lanes {
  float v[8];
};

template <typename Function>
inline Lanes each(const Function& function) {
  Lanes result;
  for (int n = 0; n < 8; ++n) result.v[n] = function(n);
  return result;
}

inline Lanes all(float a) {
  return each([&](int) { return a; });
}
inline Lanes signs(float s, int bit) {
  return each([&](int n) { return ((n >> bit) & 1) != 0 ? s : -s; });
}
inline Lanes xSigns(float s) { return signs(s, 2); }
inline Lanes ySigns(float s) { return signs(s, 1); }
inline Lanes zSigns(float s) { return signs(s, 0); }
inline Lanes load(const float* from) {
  return each([&](int n) { return from[n]; });
}
inline void store(const Lanes& a, float* to) {
  for (int n = 0; n < 8; ++n) to[n] = a.v[n];
}
inline Lanes operator+(const Lanes& a, const Lanes& b) {
  return each([&](int n) { return a.v[n] + b.v[n]; });
}
inline Lanes operator-(const Lanes& a, const Lanes& b) {
  return each([&](int n) { return a.v[n] - b.v[n]; });
}
inline Lanes operator*(const Lanes& a, const Lanes& b) {
  return each([&](int n) { return a.v[n] * b.v[n]; });
}
inline Lanes min(const Lanes& a, const Lanes& b) {
  return each([&](int n) { return a.v[n] < b.v[n] ? a.v[n] : b.v[n]; });
}
inline Lanes max(const Lanes& a, const Lanes& b) {
  return each([&](int n) { return a.v[n] > b.v[n] ? a.v[n] : b.v[n]; });
}
inline Lanes root(const Lanes& a) {
  return each([&](int n) { return std::sqrt(a.v[n]); });
}
inline Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
  return each([&](int n) { return a.v[n] * b.v[n] + c.v[n]; });
}

/// 0 where `outermost` is negative and `beyond` 0, else `otherwise`.
inline Lanes zeroWhereInside(const Lanes& outermost, const Lanes& beyond, const Lanes& otherwise) {
  return each(
      [&](int n) { return outermost.v[n] < 0.0F && beyond.v[n] == 0.0F ? 0.0F : otherwise.v[n]; });
}

/// -1 where a > b, else `otherwise`.
inline Lanes noneWhereAbove(const Lanes& a, const Lanes& b, const Lanes& otherwise) {
  return each([&](int n) { return a.v[n] > b.v[n] ? -1.0F : otherwise.v[n]; });
}

/// A bit for each lane where a <= b.
inline std::uint32_t atMost(const Lanes& a, const Lanes& b) {
  std::uint32_t bits = 0;
  for (int n = 0; n < 8; ++n) bits |= (a.v[n] <= b.v[n] ? 1U : 0U) << n;
  return bits;
}

#include "bake/leaf_distance_kernel.h"

}  // namespace

void findSquaresPlain(const LeafQuery& query) noexcept { searchLeaf(query); }

bool hasAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

void findSquares(const LeafQuery& query) noexcept {
  static const bool has_avx2 = hasAvx2();
  has_avx2 ? findSquaresAvx2(query) : findSquaresPlain(query);
}

LeafQuery makeQuery(const std::vector<Facet>& facets, float half_width, LeafScratch& scratch,
                    float* squares) {
  const std::size_t count = facets.size();
  const std::size_t lists = 8 * (count + 1);
  if (scratch.nearby.size() < lists) {
    scratch.distances.resize(8 * count);
    // One more in each: lists are written before it is known that an entry stays.
    scratch.nearby.resize(lists);
    scratch.close.resize(lists);
  }
  return {facets.data(),
          static_cast<std::uint32_t>(count),
          half_width,
          scratch.distances.data(),
          scratch.nearby.data(),
          scratch.close.data(),
          squares};
}

}  // namespace palpate::vdb
