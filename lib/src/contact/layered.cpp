#include "palpate/contact/layered.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

// In an incompressible layer every field of wave number k is one that dies out downwards and one that dies out
// upwards. With u = (radial, vertical) displacement and t = (shear, normal) stress on a level plane, the first
// has t = -2 mu k u, the second t = +2 mu k u. A distance s / k further on the first is
//   e^-s [[1 - s, s], [-s, 1 + s]] u,
// the second, upwards, the same with the radial part's sign changed. What lies below a plane is there through
// t = -2 k Y u alone; a half-space has Y = mu.

struct Mat {
  double a, b, c, d;  // [[a, b], [c, d]]
};

Mat product(const Mat& x, const Mat& y) noexcept {
  return {x.a * y.a + x.b * y.c, x.a * y.b + x.b * y.d, x.c * y.a + x.d * y.c,
          x.c * y.b + x.d * y.d};
}

Mat inverse(const Mat& x) noexcept {
  const double f = 1.0 / (x.a * x.d - x.b * x.c);
  return {f * x.d, -f * x.b, -f * x.c, f * x.a};
}

/// Y at the top of a layer of modulus `mu`, s = k * thickness, on what has `y`.
Mat onTop(const Mat& y, double mu, double s) noexcept {
  const double e = std::exp(-s);
  const Mat down{e * (1.0 - s), e * s, -e * s, e * (1.0 + s)};
  const Mat up{down.a, -down.b, -down.c, down.d};
  const Mat reflected =
      product(inverse({mu + y.a, y.b, y.c, mu + y.d}), {mu - y.a, -y.b, -y.c, mu - y.d});
  const Mat q = product(up, product(reflected, down));
  const Mat out =
      product({1.0 - q.a, -q.b, -q.c, 1.0 - q.d}, inverse({1.0 + q.a, q.b, q.c, 1.0 + q.d}));
  return {mu * out.a, mu * out.b, mu * out.c, mu * out.d};
}

/// How much further the stack gives way than its top layer alone, as a share of that, at wave number k.
double excess(std::span<const StackLayer> layers, double k) noexcept {
  const double last = layers.back().stiffness;
  Mat y{last, 0.0, 0.0, last};
  for (std::size_t i = layers.size() - 1; i-- > 0;) {
    y = onTop(y, layers[i].stiffness, k * layers[i].thickness);
  }
  return layers.front().stiffness * inverse(y).d - 1.0;
}

// Gauss and Legendre's rule of 8 points on [-1, 1], its positive half.
constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290,
                                          0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};
/// Of k * thickness of the top layer: beyond, what lies below it is not felt (e^-2s (1 + 2 s + 2 s^2) < 3e-6).
constexpr double kDeepest = 9.0;
/// Of k * radius: beyond, waves are so short that the patch feels little of them (1 / 2ka in all).
constexpr double kWidest = 40.0;
/// A panel of the rule for so much of k * radius, one more at least, and so many at most.
constexpr double kPanel = 6.0;
constexpr int kMostPanels = 6;

/// [-] (2 / pi) times the integral of (sin ka / ka)^2 excess(k) over ka.
double excessUnder(std::span<const StackLayer> layers, double radius) noexcept {
  const double end = std::min(kDeepest * radius / layers.front().thickness, kWidest);
  // What is far down shows at small wave numbers: panels grow from there.
  const int panels = std::min(static_cast<int>(std::ceil(end / kPanel)) + 1, kMostPanels);
  double begin = 0.0;
  double sum = 0.0;
  for (int panel = 0; panel < panels; ++panel) {
    const double share = static_cast<double>(panel + 1) / panels;
    const double stop = end * share * share;
    const double half = 0.5 * (stop - begin);
    for (std::size_t n = 0; n < 2 * kNodes.size(); ++n) {
      const std::size_t node = n / 2;
      const double x = begin + half * (1.0 + (n % 2 == 0 ? kNodes[node] : -kNodes[node]));
      const double sinc = std::sin(x) / x;
      sum += half * kWeights[node] * sinc * sinc * excess(layers, x / radius);
    }
    begin = stop;
  }
  // What is left of a thin layer: sin^2 is a half in the mean, the integral of 1 / x^2 1 / x.
  if (end == kWidest) sum += 0.5 / end * excess(layers, end / radius);
  return 2.0 / std::numbers::pi * sum;
}

double felt(std::span<const StackLayer> layers, double radius) noexcept {
  return layers.front().stiffness / (1.0 + excessUnder(layers, radius));
}

}  // namespace

StackStiffness stackStiffness(std::span<const StackLayer> layers, double radius,
                              bool want_slopes) noexcept {
  StackStiffness out;
  out.stiffness = layers.front().stiffness;
  if (layers.size() == 1) return out;
  out.stiffness = felt(layers, radius);
  if (!want_slopes) return out;
  std::array<StackLayer, kMostStackLayers> moved{};
  std::copy(layers.begin(), layers.end(), moved.begin());
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    const double thickness = layers[i].thickness;
    const double step = 1e-4 * std::max(thickness, 1e-2 * radius);
    const auto at = [&](double value) {
      moved[i].thickness = value;
      return felt(std::span(moved.data(), layers.size()), radius);
    };
    const double low = std::max(0.0, thickness - step);
    out.by_thickness[i] = (at(thickness + step) - at(low)) / (thickness + step - low);
    moved[i].thickness = thickness;
  }
  return out;
}

}  // namespace palpate
