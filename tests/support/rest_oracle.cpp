#include "support/rest_oracle.h"

#include <algorithm>
#include <cmath>

namespace palpate::testing {
namespace {

/// Directions spread evenly over the sphere.
Vec3 directionOf(int i, int count) {
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double angle = 2.399963229728653 * i;
  const double rho = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {rho * std::cos(angle), rho * std::sin(angle), z};
}

/// Two unit vectors perpendicular to `n`.
std::array<Vec3, 2> across(const Vec3& n) {
  Vec3 other(0.0);
  other[std::fabs(n.x) < 0.6 ? 0 : 1] = 1.0;
  const Vec3 u = glm::normalize(glm::cross(n, other));
  return {u, glm::cross(n, u)};
}

/// [m] Distance from a kink at which the normals around it are computed: nearer, differences would
/// reach across the kink.
double aroundKink(const Literal& literal, double radius) {
  return std::max(radius, 4e-5 * literal.feature);
}

}  // namespace

std::optional<HalfSpaceBound> RestOracle::planeAtKink(const Literal& literal, const Vec3& x,
                                                      const Vec3& out) const {
  const double widest = 0.05 * glm::length(out);
  const Slope far = tree_.slopeAt(literal, x + out, widest);
  const Slope near = tree_.slopeAt(literal, x + 0.5 * out, widest);
  if (far.doubt > Slope::kSingular || near.doubt > Slope::kSingular) return std::nullopt;
  // Extrapolates, which removes the curvature of the wall over that length.
  const Vec3 normal = 2.0 * near.normal - far.normal;
  return HalfSpaceBound{glm::normalize(normal), literal.value(x) / near.steepness};
}

bool RestOracle::addKink(Cell& cell, const Literal& literal, int index, const Vec3& x,
                         double radius) const {
  // The normals around the kink, used together if the literal there is convex like an apex seen
  // from within. If it bends the other way, any single one of them would hold, which cannot be
  // decided here.
  constexpr int kAround = 48;
  const double center = literal.value(x);
  const double around = aroundKink(literal, radius);
  for (int i = 0; i < kAround; ++i) {
    const Vec3 out = around * directionOf(i, kAround);
    const double there = literal.value(x + out);
    const double middle = literal.value(x + 0.5 * out);
    if (middle < 0.5 * (center + there) - 1e-3 * around) return false;
    const std::optional<HalfSpaceBound> plane = planeAtKink(literal, x, out);
    if (!plane.has_value()) continue;
    cell.planes.push_back({plane->normal, std::max(plane->gap, 0.0)});
    cell.owner.push_back(index);
  }
  return true;
}

RestOracle::Cell RestOracle::cellAt(const Vec3& x, const Nearby& nearby, std::uint32_t bits,
                                    double radius, double granted, bool asks_creases) const {
  Cell cell;
  for (std::size_t i = 0; i < nearby.literals.size(); ++i) {
    if (((bits >> i) & 1U) == 0) continue;
    const int index = nearby.literals[i];
    const Literal& literal = tree_.literals()[static_cast<std::size_t>(index)];
    const Slope slope = tree_.slopeAt(literal, x);
    if (slope.gap < -tree_.onSurface() - granted) cell.holds = false;
    cell.literals.push_back(index);
    if (slope.doubt > Slope::kSingular || (asks_creases && tree_.isOnCrease(literal, x, slope))) {
      if (!addKink(cell, literal, index, x, radius)) cell.is_judged = false;
      continue;
    }
    cell.doubt = std::max(cell.doubt, slope.doubt);
    cell.planes.push_back({slope.normal, std::max(slope.gap - granted, 0.0)});
    cell.owner.push_back(index);
  }
  return cell;
}

RestCheck RestOracle::check(const Vec3& x, const Vec3& hip) const {
  RestCheck out;
  const Vec3 way = hip - x;
  const double depth = glm::length(way);
  if (depth == 0.0) return out;
  const double radius = std::max(1e-5 * depth, 100.0 * tree_.onSurface());
  tree_.nearby(x, radius, nearby_);
  const Nearby nearby = nearby_;
  out.is_judged = !nearby.is_too_much;
  bool is_inside = true;
  for (const std::uint32_t bits : nearby.cells) {
    Cell cell = cellAt(x, nearby, bits, radius, 4.0 * tree_.onSurface(), true);
    if (!cell.holds) continue;
    is_inside = false;
    out.is_judged &= cell.is_judged;
    NearestOfPlanes next = PlaneProblem(cell.planes).nearestTo(way);
    // At an apex, add a few normals around the remaining direction.
    const bool has_kink = cell.planes.size() > cell.literals.size() + 8;
    out.has_kink |= has_kink || !cell.is_judged;
    for (int more = 0; has_kink && more < 40; ++more) {
      const double length = glm::length(next.point);
      if (length <= 1e-9 * depth) break;
      for (const int index : cell.literals) {
        const Literal& literal = tree_.literals()[static_cast<std::size_t>(index)];
        const std::optional<HalfSpaceBound> plane = planeAtKink(
            literal, x, next.point * (std::min(length, aroundKink(literal, radius)) / length));
        if (!plane.has_value()) continue;
        cell.planes.push_back({plane->normal, std::max(plane->gap - 4.0 * tree_.onSurface(), 0.0)});
      }
      next = PlaneProblem(cell.planes).nearestTo(way);
    }
    const double length = glm::length(next.point);
    if (length >= out.residual) {
      out.residual = length;
      out.touching = next.active_count;
    }
    out.doubt = std::max(out.doubt, cell.doubt);
  }
  // A point that no cell contains is inside a wall, so it does not rest there. Its value alone does
  // not show that, where a blend is far less steep than 1.
  if (is_inside) out.residual = depth;
  return out;
}

std::optional<Vec3> RestOracle::project(const Vec3& goal, const Vec3& from, double h) const {
  tree_.nearby(from, 3.0 * h, nearby_);
  const Nearby nearby = nearby_;
  std::optional<Vec3> best;
  double best_length = 2.5 * h;
  std::vector<HalfSpaceBound> planes;
  for (const std::uint32_t bits : nearby.cells) {
    std::vector<HalfSpaceBound> cuts;
    Vec3 y = goal;
    bool is_done = false;
    for (int iteration = 0; iteration < 30 && !is_done; ++iteration) {
      planes.clear();
      for (std::size_t i = 0; i < nearby.literals.size(); ++i) {
        if (((bits >> i) & 1U) == 0) continue;
        const Literal& literal = tree_.literals()[static_cast<std::size_t>(nearby.literals[i])];
        const Slope slope = tree_.slopeAt(literal, y);
        if (slope.doubt > Slope::kSingular) continue;
        const HalfSpaceBound plane{slope.normal, slope.gap + glm::dot(slope.normal, goal - y)};
        planes.push_back(plane);
        // Planes that the apex gave for an earlier step may no longer hold after the next one.
        if (plane.gap + glm::dot(plane.normal, from - goal) >= -tree_.onSurface()) {
          cuts.push_back(plane);
        }
      }
      const std::size_t own = planes.size();
      for (const HalfSpaceBound& cut : cuts) {
        const bool is_new = std::all_of(
            planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(own),
            [&](const HalfSpaceBound& plane) { return glm::dot(plane.normal, cut.normal) < 0.99; });
        if (is_new) planes.push_back(cut);
      }
      const NearestOfPlanes next = PlaneProblem(planes).nearestTo(Vec3(0.0));
      const double moved = glm::length(goal + next.point - y);
      y = goal + next.point;
      if (glm::length(next.point) > 3.0 * h) break;
      is_done = moved <= 1e-10 * h + 1e-16 && next.is_allowed;
    }
    if (!is_done) continue;
    const double length = glm::length(y - goal);
    if (length < best_length) {
      best_length = length;
      best = y;
    }
  }
  return best;
}

RestOracle::Newton RestOracle::newton(const Vec3& x, const Vec3& hip, double radius) const {
  Newton out;
  const Vec3 way = hip - x;
  tree_.nearby(x, radius, nearby_);
  const Nearby nearby = nearby_;
  for (const std::uint32_t bits : nearby.cells) {
    const Cell cell = cellAt(x, nearby, bits, 0.1 * radius, tree_.onSurface(), false);
    if (!cell.holds) continue;
    const NearestOfPlanes next = PlaneProblem(cell.planes).nearestTo(way);
    const double residual = glm::length(next.point);
    std::vector<Vec3> basis;  // perpendicular to the active normals
    std::vector<Vec3> taken;
    double blunt = 1.0;
    for (int k = 0; k < next.active_count; ++k) {
      Vec3 n =
          cell.planes[static_cast<std::size_t>(next.active[static_cast<std::size_t>(k)])].normal;
      for (const Vec3& t : taken) n -= glm::dot(t, n) * t;
      const double rest = glm::length(n);
      blunt = std::min(blunt, rest);
      if (rest > 1e-9) taken.push_back(n / rest);
    }
    if (taken.empty()) {
      basis = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    } else if (taken.size() == 1) {
      const auto both = across(taken[0]);
      basis = {both[0], both[1]};
    } else if (taken.size() == 2) {
      basis = {glm::normalize(glm::cross(taken[0], taken[1]))};
    }
    // way = p - sum mult n, so that p - way = sum mult n with mult >= 0.
    Mat3 bent(1.0);
    const Vec3 push = next.point - way;
    if (!taken.empty() && next.active_count > 0) {
      // A Gram system of at most three equations, solved by elimination with orthonormal vectors.
      const int m = next.active_count;
      std::array<Vec3, 3> n{};
      for (int k = 0; k < m; ++k) {
        n[static_cast<std::size_t>(k)] =
            cell.planes[static_cast<std::size_t>(next.active[static_cast<std::size_t>(k)])].normal;
      }
      Mat3 gram(1.0);
      Vec3 right(0.0);
      for (int a = 0; a < m; ++a) {
        right[a] = glm::dot(n[static_cast<std::size_t>(a)], push);
        for (int b = 0; b < m; ++b) {
          gram[b][a] = glm::dot(n[static_cast<std::size_t>(a)], n[static_cast<std::size_t>(b)]);
        }
      }
      const double det = glm::determinant(gram);
      if (std::fabs(det) > 1e-18) {
        const Vec3 multiplier = glm::inverse(gram) * right;
        for (int k = 0; k < m; ++k) {
          const int owner =
              cell.owner[static_cast<std::size_t>(next.active[static_cast<std::size_t>(k)])];
          const Literal& literal = tree_.literals()[static_cast<std::size_t>(owner)];
          const Slope slope = tree_.slopeAt(literal, x);
          if (slope.doubt > Slope::kSingular) continue;
          bent -= multiplier[k] * tree_.hessianAt(literal, x, slope.steepness);
        }
      }
    }
    // Newton's step in the tangent space; where the curvature is too small the step is limited.
    Vec3 step = next.point;
    double least = kInfinity;
    Vec3 least_way(0.0);
    if (basis.size() == 1) {
      least = glm::dot(basis[0], bent * basis[0]);
      least_way = basis[0];
      const double along = glm::dot(next.point, basis[0]);
      step += (along / std::max(std::fabs(least), 0.02) - along) * basis[0];
    } else if (basis.size() == 2) {
      const double a = glm::dot(basis[0], bent * basis[0]);
      const double b = glm::dot(basis[0], bent * basis[1]);
      const double c = glm::dot(basis[1], bent * basis[1]);
      const double spread = std::hypot(0.5 * (a - c), b);
      const double angle = 0.5 * std::atan2(b, 0.5 * (a - c));
      const std::array<Vec3, 2> axes = {std::cos(angle) * basis[0] + std::sin(angle) * basis[1],
                                        -std::sin(angle) * basis[0] + std::cos(angle) * basis[1]};
      const std::array<double, 2> eigen = {0.5 * (a + c) + spread, 0.5 * (a + c) - spread};
      least = eigen[1];
      least_way = axes[1];
      for (std::size_t k = 0; k < 2; ++k) {
        const double along = glm::dot(next.point, axes[k]);
        step += (along / std::max(std::fabs(eigen[k]), 0.02) - along) * axes[k];
      }
    } else if (basis.size() == 3) {
      least = 1.0;
    }
    const bool is_worse = residual >= out.residual;
    if (is_worse) {
      out.residual = residual;
      out.step = step;
      out.blunt = blunt;
    }
    if (least < out.least) {
      out.least = least;
      out.least_way = least_way;
    }
  }
  return out;
}

std::optional<Vec3> RestOracle::polish(const Vec3& x, const Vec3& hip, double h) const {
  Vec3 y = x;
  for (int iteration = 0; iteration < 25; ++iteration) {
    const double depth = glm::length(hip - y);
    const Newton next = newton(y, hip, std::max(3.0 * h, 1e3 * tree_.onSurface()));
    if (next.residual <= 1e-10 * depth) return y;
    Vec3 step = next.step;
    const double length = glm::length(step);
    const double most = 10.0 * h;
    if (length > most) step *= most / length;
    const auto landed = project(y + step, y, std::max(std::min(length, most), 1e-4 * h));
    if (!landed) return std::nullopt;
    const double moved = glm::length(*landed - y);
    y = *landed;
    if (moved <= 1e-13 * depth) return y;
  }
  return std::nullopt;
}

RestOracle::Flow RestOracle::flow(const Vec3& previous, const Vec3& hip, double h, double kick,
                                  int steps) const {
  Flow out{previous};
  Vec3 x = previous;
  int resting = 0;
  int kicks = 0;
  for (int step = 0; step < steps; ++step) {
    const Vec3 way = hip - x;
    const double depth = glm::length(way);
    if (depth <= 1e-15) {
      out.has_settled = true;
      break;
    }
    const double room = tree_.value(x);
    const double length = std::min(depth, std::max(h, 0.9 * room));
    const Vec3 goal = length == depth ? hip : x + (length / depth) * way;
    if (room > length) {
      x = goal;
      continue;
    }
    const auto next = project(goal, x, length);
    if (!next) break;
    const double moved = glm::length(*next - x);
    x = *next;
    resting = moved <= 1e-7 * length ? resting + 1 : 0;
    const bool is_near = moved <= 0.1 * length && step % 8 == 7;
    if (!is_near && resting < 3) continue;
    const auto end = polish(x, hip, h);
    const Vec3 candidate = end.value_or(x);
    const double left = glm::length(hip - candidate);
    if (end) {
      const bool is_reached =
          glm::length(candidate - x) <= 0.3 * left && left <= glm::length(hip - x) + 1e-12 &&
          tree_.value(0.5 * (candidate + x)) >= -0.1 * glm::length(candidate - x);
      if (!is_reached && resting < 3) continue;
    }
    const RestCheck checked = check(candidate, hip);
    if (checked.residual > 2e-8 * left + 1e-15 + checked.doubt * left) {
      if (resting < 200) continue;
      break;
    }
    const Newton curved = newton(candidate, hip, std::max(1e-5 * left, 1e2 * tree_.onSurface()));
    if (curved.least < -1e-6 && kicks < 20) {
      ++kicks;
      out.was_kicked = true;
      resting = 0;
      const auto off = project(candidate + kick * 0.3 * h * curved.least_way, candidate, 0.3 * h);
      if (!off) break;
      x = *off;
      continue;
    }
    x = candidate;
    out.has_settled = true;
    break;
  }
  out.point = x;
  return out;
}

double RestOracle::stepFor(const Vec3& previous, const Vec3& hip) const {
  return std::min({2e-5, 0.02 * tree_.feature(), 0.05 * glm::length(hip - previous)});
}

void RestOracle::measureBluntness(Rest& rest, const Vec3& hip) const {
  const double left = glm::length(hip - rest.point);
  if (left == 0.0) return;
  const double radius = std::max(1e-5 * left, 1e2 * tree_.onSurface());
  rest.blunt = newton(rest.point, hip, radius).blunt;
}

Rest RestOracle::solveOnce(const Vec3& previous, const Vec3& hip) const {
  const Flow run = flow(previous, hip, stepFor(previous, hip), 1.0);
  Rest out;
  out.point = run.point;
  out.has_settled = run.has_settled;
  measureBluntness(out, hip);
  return out;
}

Vec3 RestOracle::stay(const Vec3& x, const Vec3& hip) const {
  return flow(x, hip, 1e-6 * glm::length(hip - x), 1.0, 200).point;
}

Rest RestOracle::solve(const Vec3& previous, const Vec3& hip) const {
  const double h = stepFor(previous, hip);
  const Flow fine = flow(previous, hip, 0.1 * h, 1.0);
  Rest out;
  out.point = fine.point;
  out.has_settled = fine.has_settled;
  if (fine.was_kicked) out.others.push_back(flow(previous, hip, 0.1 * h, -1.0).point);
  const Flow coarse = flow(previous, hip, h, 1.0);
  out.others.push_back(coarse.point);
  out.has_settled &= coarse.has_settled;
  measureBluntness(out, hip);
  return out;
}

double RestOracle::leastCurvature(const Vec3& x, const Vec3& hip) const {
  const double depth = glm::length(hip - x);
  return newton(x, hip, std::max(1e-5 * depth, 1e2 * tree_.onSurface())).least;
}

double RestOracle::gainNear(const Vec3& x, const Vec3& hip, double radius) const {
  const double depth = glm::length(hip - x);
  if (depth <= radius) return 0.0;
  const Vec3 way = (hip - x) / depth;
  double best = 0.0;
  Vec3 best_way(0.0);
  const auto attempt = [&](const Vec3& u) {
    const Vec3 y = x + radius * u;
    const double gain = (depth - glm::length(hip - y)) / radius;
    if (gain <= best || tree_.value(y) < 0.0) return;
    // A path to the point must be open, except for the part that a convex wall cuts off a chord.
    for (const double share : {0.25, 0.5, 0.75}) {
      if (tree_.value(x + share * radius * u) < -1e-2 * radius) return;
    }
    best = gain;
    best_way = u;
  };
  constexpr int kTried = 96;
  for (int i = 0; i < kTried; ++i) {
    const Vec3 u = directionOf(i, kTried);
    if (glm::dot(u, way) > 0.0) attempt(u);
  }
  for (double spread = 0.2; best > 0.0 && spread > 0.01; spread *= 0.5) {
    const Vec3 around = best_way;
    const auto sides = across(around);
    for (int i = 0; i < 6; ++i) {
      const double angle = i * 1.0471975511965976;
      attempt(glm::normalize(around +
                             spread * (std::cos(angle) * sides[0] + std::sin(angle) * sides[1])));
    }
  }
  return best;
}

}  // namespace palpate::testing
