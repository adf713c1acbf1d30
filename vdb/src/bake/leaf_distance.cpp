#include "bake/leaf_distance.h"

#include <cmath>

namespace palpate::vdb {
namespace {

/// Eight lanes for any processor; compilers make of the loops what it has.
struct Lanes {
  float v[8];
  Lanes() = default;
  explicit Lanes(float each) {
    for (float& lane : v) lane = each;
  }
  static Lanes signs(float s, int bit) {
    Lanes result;
    for (int n = 0; n < 8; ++n) result.v[n] = ((n >> bit) & 1) != 0 ? s : -s;
    return result;
  }
  static Lanes xSigns(float s) { return signs(s, 2); }
  static Lanes ySigns(float s) { return signs(s, 1); }
  static Lanes zSigns(float s) { return signs(s, 0); }
  static float root(float s) { return std::sqrt(s); }
  void store(float* to) const {
    for (int n = 0; n < 8; ++n) to[n] = v[n];
  }
};

struct Mask {
  bool v[8];
};

template <typename Result = Lanes, typename Function>
inline Result each(const Function& function) {
  Result result;
  for (int n = 0; n < 8; ++n) result.v[n] = function(n);
  return result;
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
inline Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
  return each([&](int n) { return a.v[n] * b.v[n] + c.v[n]; });
}
inline Mask isNegative(const Lanes& a) {
  return each<Mask>([&](int n) { return a.v[n] < 0.0F; });
}
inline Mask isZero(const Lanes& a) {
  return each<Mask>([&](int n) { return a.v[n] == 0.0F; });
}
inline Mask operator&(const Mask& a, const Mask& b) {
  return each<Mask>([&](int n) { return a.v[n] && b.v[n]; });
}
inline Lanes zeroWhere(const Mask& mask, const Lanes& a) {
  return each([&](int n) { return mask.v[n] ? 0.0F : a.v[n]; });
}

}  // namespace
}  // namespace palpate::vdb

#include "bake/leaf_distance_kernel.h"

namespace palpate::vdb {

void findSquaresPlain(const LeafQuery& query) noexcept { searchLeaf<Lanes>(query); }

bool hasAvx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

void findSquares(const LeafQuery& query) noexcept {
  static const bool has_avx2 = hasAvx2();
  if (has_avx2) {
    findSquaresAvx2(query);
  } else {
    findSquaresPlain(query);
  }
}

LeafQuery makeQuery(const std::vector<Facet>& facets, float half_width, LeafScratch& scratch,
                    float* squares) {
  const std::size_t count = facets.size();
  if (scratch.nearby.size() <= count) {
    scratch.eight.resize(8 * count);
    scratch.four.resize(8 * count);
    // One more: lists are written before it is known that an entry stays.
    scratch.nearby.resize(count + 1);
    scratch.close.resize(count + 1);
  }
  return {facets.data(),        static_cast<std::uint32_t>(count),
          half_width,           scratch.eight.data(),
          scratch.four.data(),  scratch.nearby.data(),
          scratch.close.data(), squares};
}

}  // namespace palpate::vdb
