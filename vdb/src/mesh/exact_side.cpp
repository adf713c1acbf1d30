#include "mesh/exact_side.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate::vdb {
namespace {

/// A number as the exact sum of doubles that do not overlap, the smallest first.
/// (J. R. Shewchuk, Adaptive precision floating-point arithmetic, 1997: Grow-Expansion.)
template <std::size_t kMost>
class Sum {
 public:
  void add(double value) noexcept {
    double carry = value;
    std::size_t kept = 0;
    for (std::size_t n = 0; n < count_; ++n) {
      const double sum = carry + terms_[n];
      const double part = sum - carry;
      const double error = (carry - (sum - part)) + (terms_[n] - part);
      if (error != 0.0) terms_[kept++] = error;
      carry = sum;
    }
    if (carry != 0.0) terms_[kept++] = carry;
    count_ = kept;
  }
  void addProduct(double a, double b) noexcept {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  /// Adds `factor` times the product of two sums.
  template <std::size_t kA, std::size_t kB>
  void addProduct(const Sum<kA>& a, const Sum<kB>& b, double factor) noexcept {
    for (std::size_t i = 0; i < a.count(); ++i) {
      for (std::size_t k = 0; k < b.count(); ++k) addProduct(factor * a[i], b[k]);
    }
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] double operator[](std::size_t n) const noexcept { return terms_[n]; }
  [[nodiscard]] int sign() const noexcept {
    if (count_ == 0) return 0;
    return terms_[count_ - 1] > 0.0 ? 1 : -1;
  }

 private:
  std::array<double, kMost> terms_{};
  std::size_t count_ = 0;
};

Sum<2> difference(double a, double b) noexcept {
  Sum<2> sum;
  sum.add(a);
  sum.add(-b);
  return sum;
}

/// Each product of two differences has at most 2 * 2 * 2 = 8 terms, so that two of them have 16.
Sum<16> minorOf(const Sum<2>& a, const Sum<2>& b, const Sum<2>& c, const Sum<2>& d) noexcept {
  Sum<16> sum;
  sum.addProduct(a, d, 1.0);
  sum.addProduct(b, c, -1.0);
  return sum;
}

int exactSideOfPlane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  std::array<std::array<Sum<2>, 3>, 3> rows;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    rows[0][n] = difference(a[axis], d[axis]);
    rows[1][n] = difference(b[axis], d[axis]);
    rows[2][n] = difference(c[axis], d[axis]);
  }
  const auto& [p, q, r] = rows;
  Sum<192> volume;  // three products of sums of 2 and 16 terms; each product of terms gives two
  volume.addProduct(p[0], minorOf(q[1], q[2], r[1], r[2]), 1.0);
  volume.addProduct(p[1], minorOf(q[2], q[0], r[2], r[0]), 1.0);
  volume.addProduct(p[2], minorOf(q[0], q[1], r[0], r[1]), 1.0);
  return volume.sign();
}

/// Relative error of each product of differences below.
constexpr long double kRounding = 16.0L * std::numeric_limits<long double>::epsilon();

}  // namespace

int sideOfPlane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  using Wide = long double;
  const Wide px = Wide{a.x} - d.x;
  const Wide py = Wide{a.y} - d.y;
  const Wide pz = Wide{a.z} - d.z;
  const Wide qx = Wide{b.x} - d.x;
  const Wide qy = Wide{b.y} - d.y;
  const Wide qz = Wide{b.z} - d.z;
  const Wide rx = Wide{c.x} - d.x;
  const Wide ry = Wide{c.y} - d.y;
  const Wide rz = Wide{c.z} - d.z;
  const Wide volume =
      px * (qy * rz - qz * ry) + py * (qz * rx - qx * rz) + pz * (qx * ry - qy * rx);
  const Wide size = std::fabs(px) * (std::fabs(qy * rz) + std::fabs(qz * ry)) +
                    std::fabs(py) * (std::fabs(qz * rx) + std::fabs(qx * rz)) +
                    std::fabs(pz) * (std::fabs(qx * ry) + std::fabs(qy * rx));
  if (volume > kRounding * size) return 1;
  if (volume < -kRounding * size) return -1;
  return size == 0.0L ? 0 : exactSideOfPlane(a, b, c, d);
}

int sideOfLine(const Vec3& a, const Vec3& b, const Vec3& c, int axis) noexcept {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  using Wide = long double;
  const Wide left = (Wide{a[u]} - c[u]) * (Wide{b[v]} - c[v]);
  const Wide right = (Wide{a[v]} - c[v]) * (Wide{b[u]} - c[u]);
  const Wide size = std::fabs(left) + std::fabs(right);
  if (left - right > kRounding * size) return 1;
  if (left - right < -kRounding * size) return -1;
  if (size == 0.0L) return 0;
  return minorOf(difference(a[u], c[u]), difference(a[v], c[v]), difference(b[u], c[u]),
                 difference(b[v], c[v]))
      .sign();
}

}  // namespace palpate::vdb
