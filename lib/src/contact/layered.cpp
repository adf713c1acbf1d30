#include "palpate/contact/layered.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpate {
namespace {

// In an incompressible layer every field of wave number k is the sum of one that decays downwards
// and one that decays upwards. With u = (radial, vertical) displacement and t = (shear, normal)
// stress on a horizontal plane, the first has t = -2 mu k u, the second t = +2 mu k u. A distance s
// / k further down the first is
//   D u,  D = e^-s [[1 - s, s], [-s, 1 + s]] = e^(s M),  M = [[-2, 1], [-1, 0]];
// the same distance further up the second is D^T u. At the lower side of layer i the first is
// reflected: it comes back as r u there, and as q u at the layer's top, q = D^T r D; both are
// symmetric. With rho = (mu_i - mu_j) / (mu_i + mu_j), where j is the layer below, whose reflection
// at its top is q_j,
//   r = (q_j + rho) (1 + rho q_j)^-1;
// the lowest layer reflects nothing, q_j = 0. The compliance of a half-space is 1 / mu, and that of
// the stack is (1 + q) (1 - q)^-1 times that of its top layer.

/// Waves that are computed together: the loops over them become vector instructions.
constexpr std::size_t kLanes = 8;
using Lanes = std::array<double, kLanes>;

/// The symmetric matrix [[xx, xy], [xy, yy]] for each wave.
struct Symmetric {
  Lanes xx, xy, yy;
};

/// The matrix D of one layer for each wave.
struct Pass {
  Lanes a, b, c, d;  // D = [[a, b], [c, d]]
  Symmetric r, q;
};

/// e^-s for s >= 0, with a relative error of 1e-14; 0 may be returned where it is below 1e-30.
double decay(double s) noexcept {
  constexpr double kRound = 0x1.8p52;  // adding it leaves a whole number in the last bits
  s = std::min(s, 70.0);
  const double shifted = s * std::numbers::log2e + kRound;
  const double whole = shifted - kRound;
  const double f = (s - whole * 0x1.62e42fefa0000p-1) - whole * 0x1.cf79abc9e3b3ap-40;
  double p = 1.0 / 479001600.0;
  for (const double factorial : {-39916800.0, 3628800.0, -362880.0, 40320.0, -5040.0, 720.0, -120.0,
                                 24.0, -6.0, 2.0, -1.0, 1.0}) {
    p = p * f + 1.0 / factorial;
  }
  const std::uint64_t exponent = (std::uint64_t{1023} - std::bit_cast<std::uint64_t>(shifted))
                                 << 52U;
  return p * std::bit_cast<double>(exponent);
}

struct Waves {
  Lanes k;       // [1/m]
  Lanes weight;  // [-] weight of each wave in the integral
};

/// The sum over some waves of the compliance that the stack has beyond that of its top layer alone,
/// as a share of the latter, and its derivatives by the thickness of each layer and by each rho.
struct Sum {
  double excess = 0.0;
  std::array<double, kMostStackLayers> by_thickness{};
  std::array<double, kMostStackLayers> by_rho{};
};

void add(std::span<const StackLayer> layers, std::span<const double> rho, const Waves& waves,
         Sum& sum) noexcept {
  std::array<Pass, kMostStackLayers - 1> passes;
  const std::size_t count = layers.size() - 1;
  for (std::size_t i = count; i-- > 0;) {
    Pass& p = passes[i];
    if (i + 1 == count) {
      p.r.xx.fill(rho[i]);
      p.r.xy.fill(0.0);
      p.r.yy.fill(rho[i]);
    } else {
      const Symmetric& q = passes[i + 1].q;
      const double f = rho[i];
      for (std::size_t n = 0; n < kLanes; ++n) {
        const double trace = q.xx[n] + q.yy[n];
        const double det = q.xx[n] * q.yy[n] - q.xy[n] * q.xy[n];
        const double by = 1.0 / (1.0 + f * (trace + f * det));
        const double own = (1.0 - f * f) * by;
        const double even = f * (1.0 + det + f * trace) * by;
        p.r.xx[n] = own * q.xx[n] + even;
        p.r.xy[n] = own * q.xy[n];
        p.r.yy[n] = own * q.yy[n] + even;
      }
    }
    const double thickness = layers[i].thickness;
    for (std::size_t n = 0; n < kLanes; ++n) {
      const double s = std::min(waves.k[n] * thickness, 70.0);
      const double e = decay(s);
      const double a = p.a[n] = e * (1.0 - s);
      const double b = p.b[n] = e * s;
      const double c = p.c[n] = -b;
      const double d = p.d[n] = e * (1.0 + s);
      const double xa = p.r.xx[n] * a + p.r.xy[n] * c;
      const double xb = p.r.xx[n] * b + p.r.xy[n] * d;
      const double ya = p.r.xy[n] * a + p.r.yy[n] * c;
      const double yb = p.r.xy[n] * b + p.r.yy[n] * d;
      p.q.xx[n] = a * xa + c * ya;
      p.q.xy[n] = a * xb + c * yb;
      p.q.yy[n] = b * xb + d * yb;
    }
  }
  // 2 (q (1 - q)^-1)_yy at the top, and its derivative by q.
  Symmetric g;
  {
    const Symmetric& q = passes[0].q;
    Lanes own;
    for (std::size_t n = 0; n < kLanes; ++n) {
      const double x = q.xx[n], y = q.xy[n], z = q.yy[n];
      const double det = x * z - y * y;
      const double by = 1.0 / (1.0 - x - z + det);
      const double value = (z - det) * by;
      const double w = 2.0 * waves.weight[n] * by;
      own[n] = 2.0 * waves.weight[n] * value;
      g.xx[n] = w * (value * (1.0 - z) - z);
      g.yy[n] = w * ((1.0 - x) + value * (1.0 - x));
      g.xy[n] = w * (y + value * y);
    }
    for (const double v : own) sum.excess += v;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Pass& p = passes[i];
    Lanes by_s;
    Symmetric h;
    for (std::size_t n = 0; n < kLanes; ++n) {
      const double x = p.q.xx[n], y = p.q.xy[n], z = p.q.yy[n];
      by_s[n] = 2.0 * waves.k[n] *
                (g.xy[n] * x + g.yy[n] * y - 2.0 * (g.xx[n] * x + g.xy[n] * y) - g.xx[n] * y -
                 g.xy[n] * z);
      const double a = p.a[n], b = p.b[n], c = p.c[n], d = p.d[n];
      const double xa = g.xx[n] * a + g.xy[n] * b;
      const double xc = g.xx[n] * c + g.xy[n] * d;
      const double ya = g.xy[n] * a + g.yy[n] * b;
      const double yc = g.xy[n] * c + g.yy[n] * d;
      h.xx[n] = a * xa + b * ya;
      h.xy[n] = a * xc + b * yc;
      h.yy[n] = c * xc + d * yc;
    }
    for (const double v : by_s) sum.by_thickness[i] += v;
    // Derivative by rho: tr(h (1 - r^2)) / (1 - rho^2).
    const double f = rho[i];
    Lanes by_rho;
    for (std::size_t n = 0; n < kLanes; ++n) {
      const double x = p.r.xx[n], y = p.r.xy[n], z = p.r.yy[n];
      by_rho[n] = h.xx[n] * (1.0 - x * x - y * y) - 2.0 * h.xy[n] * y * (x + z) +
                  h.yy[n] * (1.0 - y * y - z * z);
    }
    double all = 0.0;
    for (const double v : by_rho) all += v;
    sum.by_rho[i] += all / (1.0 - f * f);
    if (i + 1 == count) break;
    const Symmetric& q = passes[i + 1].q;
    for (std::size_t n = 0; n < kLanes; ++n) {
      const double x = q.xx[n], y = q.xy[n], z = q.yy[n];
      const double det = x * z - y * y;
      const double by = 1.0 / (1.0 + f * ((x + z) + f * det));
      // (1 + rho q)^-1
      const double u = (1.0 + f * z) * by, v = -f * y * by, w = (1.0 + f * x) * by;
      const double xu = h.xx[n] * u + h.xy[n] * v;
      const double xv = h.xx[n] * v + h.xy[n] * w;
      const double yu = h.xy[n] * u + h.yy[n] * v;
      const double yv = h.xy[n] * v + h.yy[n] * w;
      const double share = 1.0 - f * f;
      g.xx[n] = share * (u * xu + v * yu);
      g.xy[n] = share * (u * xv + v * yv);
      g.yy[n] = share * (v * xv + w * yv);
    }
  }
}

// Quadrature of (sin x / x)^2 f(x) from 0 to infinity, x = k * radius, for functions f like those
// of layers. The nodes form a geometric sequence. The weights are a least-squares fit over all f =
// (c x)^n e^(-c x) with n = 0, 1, 2 and c from 0.02 to 250, and exact for f = 1. So the sine's
// oscillation is in the weights, and the nodes do not depend on a thickness: the compliance is
// smooth, and its derivatives are exactly those of the sum. The error of the integral is 3e-3 at
// most.
constexpr std::size_t kNodeCount = 2 * kLanes;
constexpr std::array<double, kNodeCount> kNodes = {
    0.003363120349, 0.01386292296, 0.03261273394, 0.06609483117,
    0.1258848118,   0.2326535652,  0.4233137157,  0.7637812385,
    1.371764258,    2.457457688,   4.396212858,   7.858305846,
    14.04066865,    25.08069849,   44.79520937,   80};
constexpr std::array<double, kNodeCount> kWeights = {
    0.007786991898, 0.01349972179, 0.02507937741,   0.0436377448, 0.07874108451, 0.1379420959,
    0.2365508516,   0.368774914,   0.4051714292,    0.114099292,  0.04723058219, 0.05312200407,
    0.005213330233, 0.02781632939, -0.008859940968, 0.01499051372};

}  // namespace

StackStiffness stackStiffness(std::span<const StackLayer> layers, double radius) noexcept {
  StackStiffness out;
  const double top = layers.front().stiffness;
  out.stiffness = top;
  out.by_stiffness[0] = 1.0;
  if (layers.size() == 1) return out;
  std::array<double, kMostStackLayers> rho{};
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    const double own = layers[i].stiffness;
    const double below = layers[i + 1].stiffness;
    rho[i] = (own - below) / (own + below);
  }
  Sum sum;
  for (std::size_t first = 0; first < kNodeCount; first += kLanes) {
    Waves waves;
    for (std::size_t n = 0; n < kLanes; ++n) {
      waves.k[n] = kNodes[first + n] / radius;
      waves.weight[n] = kWeights[first + n];
    }
    add(layers, rho, waves, sum);
  }
  const double share = 1.0 / (1.0 + 2.0 / std::numbers::pi * sum.excess);
  out.stiffness = top * share;
  const double by = -2.0 / std::numbers::pi * out.stiffness * share;
  out.by_stiffness[0] = share;
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    out.by_thickness[i] = by * sum.by_thickness[i];
    const double both = layers[i].stiffness + layers[i + 1].stiffness;
    const double slope = by * sum.by_rho[i] * 2.0 / (both * both);
    out.by_stiffness[i] += slope * layers[i + 1].stiffness;
    out.by_stiffness[i + 1] -= slope * layers[i].stiffness;
  }
  return out;
}
}  // namespace palpate
