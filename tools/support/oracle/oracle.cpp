#include "support/oracle/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "support/oracle/local_projection.h"

namespace palpate::oracle {
namespace {

/// Smallest eigenvalue of a symmetric 1 x 1 or 2 x 2 matrix, with its eigenvector.
struct LeastCurvature {
  double value = kInfinity;
  Vec3 direction{0.0, 0.0, 0.0};
};

/// An orthonormal basis of the space orthogonal to all `normals`.
std::vector<Vec3> tangents(const std::vector<Vec3>& normals) {
  std::vector<Vec3> basis;
  const auto reduce = [](Vec3 v, const std::vector<Vec3>& by) {
    for (int twice = 0; twice < 2; ++twice) {
      for (const Vec3& b : by) v -= glm::dot(b, v) * b;
    }
    return v;
  };
  std::vector<Vec3> taken;
  for (const Vec3& n : normals) {
    const Vec3 rest = reduce(glm::normalize(n), taken);
    if (glm::length(rest) > 1e-9) taken.push_back(glm::normalize(rest));
  }
  while (taken.size() < 3) {
    Vec3 best(0.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 axis(0.0);
      axis[i] = 1.0;
      const Vec3 rest = reduce(axis, taken);
      if (glm::length(rest) > glm::length(best)) best = rest;
    }
    basis.push_back(glm::normalize(best));
    taken.push_back(basis.back());
  }
  return basis;
}

/// A point where the distance to the HIP is stationary on the surfaces of `active`.
struct Stationary {
  Vec3 point{0.0, 0.0, 0.0};
  LeastCurvature curvature = {};  ///< of the Lagrangian on the tangent space; infinite at a corner
};

class Run {
 public:
  Run(const FeasibleSet& set, const Vec3& hip, double step, std::size_t most_steps, double kick)
      : set_(set), hip_(hip), step_(step), most_steps_(most_steps), kick_(kick) {}

  OracleResult from(const Vec3& previous) {
    OracleResult out;
    Vec3 x = previous;
    if (set_.value(x) < 0.0) x = projectLocally(set_, x, std::max(step_, set_.feature())).point;
    int resting = 0;
    int searches = 0;
    for (; out.steps < most_steps_; ++out.steps) {
      const double depth = glm::length(hip_ - x);
      if (depth == 0.0) return finished(out, x, {}, 0.0);
      const double h = std::min(step_, depth);
      const LocalPoint next = advance(x);
      const double moved = glm::length(next.point - x);
      const bool free = next.active.empty() && next.smooth;
      x = next.point;
      if (free) continue;
      if (!next.smooth && ++searches > kMostSearches) break;

      // Newton only finishes what the flow has almost reached, so that the flow chooses the basin.
      if (next.smooth && moved <= kNearly * h) {
        if (const auto end = polish(x, next.active)) {
          if (end->curvature.value < 0.0) {
            if (glm::length(end->point - x) <= 1e-6 * h || moved <= 1e-9 * h) {
              x = kicked(end->point, end->curvature.direction, h);
            }
            continue;
          }
          if (!isAllowed(set_, end->point)) continue;  // another side will stop it first
          const double left = glm::length(advance(end->point).point - end->point);
          if (left <= 1e-8 * h) return finished(out, end->point, next, left / h);
        }
      }
      // At a cusp, a kink or a weakly active corner the flow itself must come to rest.
      resting = moved <= (next.smooth ? 1e-11 : 1e-6) * h ? resting + 1 : 0;
      if (resting >= 5) return finished(out, x, next, moved / h);
    }
    out.proxy = x;
    out.residual = 1.0;
    return out;
  }

  [[nodiscard]] bool wasKicked() const noexcept { return was_kicked_; }

 private:
  /// Sine of the angle to a stationary point below which Newton may take over.
  static constexpr double kNearly = 0.05;
  /// Limit of projections by search in a run: at a cusp a few are enough, along a kink no number is
  /// enough.
  static constexpr int kMostSearches = 300;

  [[nodiscard]] LocalPoint advance(const Vec3& x) const {
    const double depth = glm::length(hip_ - x);
    if (depth == 0.0) return {x};
    const double h = std::min(step_, depth);
    return projectLocally(set_, h == depth ? hip_ : x + (h / depth) * (hip_ - x), h, x);
  }

  [[nodiscard]] OracleResult finished(OracleResult out, const Vec3& x, const LocalPoint& last,
                                      double residual) const {
    out.proxy = x;
    out.converged = true;
    out.smooth = last.smooth;
    out.active = last.active;
    out.residual = residual;
    return out;
  }

  /// Moves away from a stationary point that is not a minimum, along the direction in which the
  /// distance falls. The caller tries both directions.
  Vec3 kicked(const Vec3& x, const Vec3& direction, double h) {
    was_kicked_ = true;
    return projectLocally(set_, x + kick_ * 0.1 * h * direction, h).point;
  }

  /// Newton on y - P = sum mu_i grad g_i(y), g_i(y) = 0, from `x`; nothing if it does not stay
  /// near, or if a side would pull.
  [[nodiscard]] std::optional<Stationary> polish(const Vec3& x,
                                                 const std::vector<std::size_t>& active) const {
    const std::size_t m = active.size();
    const std::size_t n = 3 + m;
    Vec3 y = x;
    std::vector<double> mu = startMultipliers(x, active);
    if (mu.empty()) return std::nullopt;
    std::vector<Vec3> normals(m);
    Mat3 lagrangian(1.0);
    double last_step = kInfinity;
    const double done = 1e-13 * glm::length(hip_ - x) + 2e-16 * glm::length(x);
    bool fine = false;
    for (int iteration = 0; iteration < 40; ++iteration) {
      lagrangian = Mat3(1.0);
      Vec3 force = hip_ - y;
      std::vector<double> jacobian(n * n, 0.0);
      std::vector<double> right(n, 0.0);
      for (std::size_t i = 0; i < m; ++i) {
        const FieldSide& side = set_.sides()[active[i]];
        normals[i] = side.gradient(y);
        lagrangian -= mu[i] * side.hessian(y);
        force += mu[i] * normals[i];
        right[3 + i] = -side.value(y);
        for (std::size_t k = 0; k < 3; ++k) {
          jacobian[k * n + 3 + i] = -normals[i][static_cast<int>(k)];
          jacobian[(3 + i) * n + k] = normals[i][static_cast<int>(k)];
        }
      }
      for (std::size_t r = 0; r < 3; ++r) {
        right[r] = force[static_cast<int>(r)];
        for (std::size_t c = 0; c < 3; ++c) {
          jacobian[r * n + c] = lagrangian[static_cast<int>(c)][static_cast<int>(r)];
        }
      }
      if (fine) break;
      if (!solveLinear(jacobian, right)) return std::nullopt;
      const Vec3 step(right[0], right[1], right[2]);
      y += step;
      for (std::size_t i = 0; i < m; ++i) mu[i] += right[3 + i];
      if (!(glm::length(y - x) <= 0.25 * set_.feature())) return std::nullopt;
      const double length = glm::length(step);
      // At rounding level: the step is small enough, or it is small and no longer shrinks.
      fine = length <= done || (length <= 1e4 * done && length >= 0.5 * last_step);
      last_step = length;
    }
    if (!fine) return std::nullopt;
    const double largest = *std::max_element(mu.begin(), mu.end());
    for (const double each : mu) {
      if (each < -1e-9 * std::fabs(largest)) return std::nullopt;
    }
    return Stationary{y, leastCurvature(lagrangian, normals)};
  }

  /// Multipliers by least squares: y - P = sum mu_i grad g_i.
  [[nodiscard]] std::vector<double> startMultipliers(const Vec3& x,
                                                     const std::vector<std::size_t>& active) const {
    const std::size_t m = active.size();
    std::vector<double> gram(m * m);
    std::vector<double> mu(m);
    std::vector<Vec3> normals(m);
    for (std::size_t i = 0; i < m; ++i) normals[i] = set_.sides()[active[i]].gradient(x);
    for (std::size_t i = 0; i < m; ++i) {
      mu[i] = glm::dot(normals[i], x - hip_);
      for (std::size_t j = 0; j < m; ++j) gram[i * m + j] = glm::dot(normals[i], normals[j]);
    }
    if (!solveLinear(gram, mu)) return {};
    return mu;
  }

  static LeastCurvature leastCurvature(const Mat3& lagrangian, const std::vector<Vec3>& normals) {
    const std::vector<Vec3> z = tangents(normals);
    if (z.empty()) return {};
    const double a = glm::dot(z[0], lagrangian * z[0]);
    if (z.size() == 1) return {a, z[0]};
    const double b = glm::dot(z[0], lagrangian * z[1]);
    const double c = glm::dot(z[1], lagrangian * z[1]);
    const double least = 0.5 * (a + c) - std::hypot(0.5 * (a - c), b);
    // (a - least) u + b v = 0 or b u + (c - least) v = 0: the larger row is numerically safer.
    const Vec3 one = b * z[0] - (a - least) * z[1];
    const Vec3 two = (c - least) * z[0] - b * z[1];
    const Vec3 direction = glm::length(one) > glm::length(two) ? one : two;
    return {least, unitOr(direction, z[0])};
  }

  const FeasibleSet& set_;
  Vec3 hip_;
  double step_;
  std::size_t most_steps_;
  double kick_;
  bool was_kicked_ = false;
};

}  // namespace

double OracleResult::errorOf(const Vec3& x, const Vec3& hip, double least_depth) const {
  return glm::length(x - proxy) / std::max(glm::length(proxy - hip), least_depth);
}

OracleResult solveOracle(const FeasibleSet& set, const Vec3& previous, const Vec3& hip,
                         const OracleSettings& settings) {
  const double h = settings.step > 0.0 ? settings.step : set.feature() / 50.0;
  OracleResult result;
  std::vector<OracleResult> others;
  for (const double step : {h, 0.1 * h}) {
    Run run(set, hip, step, settings.most_steps, 1.0);
    result = run.from(previous);
    others.push_back(result);
    if (run.wasKicked()) {
      others.push_back(Run(set, hip, step, settings.most_steps, -1.0).from(previous));
    }
  }
  // Results in one basin agree to rounding (1e-7 at a cusp); results in two basins differ by far
  // more.
  const double near = 1e-5 * std::max(glm::length(hip - result.proxy), 1e-4 * set.feature());
  for (const OracleResult& other : others) {
    result.ambiguous |= glm::length(other.proxy - result.proxy) > near;
    result.converged &= other.converged;
  }
  return result;
}

}  // namespace palpate::oracle
