#include "support/field_contract.h"

#include <algorithm>
#include <bit>
#include <iomanip>
#include <limits>
#include <ostream>
#include <sstream>

namespace palpate::test {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

void PrintTo(const FieldCase& field_case, std::ostream* out) { *out << field_case.name; }

double Random::uniform(double lo, double hi) {
  const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;
  return lo + (hi - lo) * unit;
}

Vec3 Random::in(const Box3& box) {
  const double x = uniform(box.lo.x, box.hi.x);
  const double y = uniform(box.lo.y, box.hi.y);
  return {x, y, uniform(box.lo.z, box.hi.z)};
}

Vec3 Random::direction() {
  for (;;) {
    const Vec3 v = in({Vec3(-1.0), Vec3(1.0)});
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1.0) return v / length;
  }
}

namespace {

constexpr int kPoints = 600;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

std::string text(const Vec3& v) {
  std::ostringstream out;
  out << std::setprecision(17) << '(' << v.x << ", " << v.y << ", " << v.z << ')';
  return out.str();
}

double diagonal(const FieldCase& field_case) { return glm::length(field_case.region.size()); }

Box3 grown(const FieldCase& field_case, double share) {
  return field_case.region.grownBy(share * diagonal(field_case));
}

/// Points in the region, some around it, and some close to the surface, where it matters most.
std::vector<Vec3> pointsFor(const FieldCase& field_case, const Field& field) {
  Random random(20240611);
  std::vector<Vec3> points;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p = random.in(i % 4 == 0 ? grown(field_case, 1.0) : field_case.region);
    points.push_back(p);
    if (i % 2 != 0) continue;
    const FieldSample s = field.sample(p);
    const double slope = glm::dot(s.gradient, s.gradient);
    if (slope > 0.0)
      points.push_back(p - s.gradient * (s.value / slope * random.uniform(0.9, 1.1)));
  }
  std::erase_if(points, [](const Vec3& p) { return !isFinite(p); });
  return points;
}

/// Zeros of both signs, the smallest and largest numbers, corners and middles of boxes, the
/// case's own.
std::vector<Vec3> awkwardPoints(const FieldCase& field_case, const Field& field) {
  std::vector<Vec3> points = field_case.awkward;
  const Vec3 middle = field_case.region.center();
  for (const Vec3& about : {Vec3(0.0), middle}) {
    for (const double x : {0.0, -0.0, 1e-300, -1e-300, 5e-324, 1e-160, 1e-20}) {
      points.insert(points.end(),
                    {about + Vec3(x), about + Vec3(x, 0.0, 0.0), about + Vec3(0.0, x, -0.0),
                     about + Vec3(-0.0, x, x), about + Vec3(0.0, 0.0, x)});
    }
  }
  std::vector<double> far{1e3, 1e9};
  if (field_case.far_away) far.insert(far.end(), {1e80, 1e160, 1e300});
  for (const double x : far) {
    points.insert(points.end(), {Vec3(x), Vec3(-x, 0.0, 0.0), Vec3(0.0, x, 1.0), Vec3(1.0, -x, x),
                                 Vec3(0.0, 0.0, -x), Vec3(1e-300, x, -1e-300)});
  }
  const Box3 bounds = field.bounds();
  for (const Box3& box : {field_case.region, bounds}) {
    if (!box.isBounded()) continue;
    for (int i = 0; i < 27; ++i) {  // corners, middles of edges and faces, center
      const Vec3 share(i % 3, i / 3 % 3, i / 9);
      points.push_back(box.lo + 0.5 * share * box.size());
    }
  }
  return points;
}

/// Central differences need a step well above rounding at `p`.
double stepAt(const FieldCase& field_case, const Field& field, const Vec3& p) {
  const double reach = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return std::max(field_case.difference_step * field.featureSize(), 1e-8 * reach);
}

struct Stencil {
  Vec3 slope{0.0};    ///< central differences of value
  Mat3 bend{0.0};     ///< central differences of gradient
  double jump = 0.0;  ///< largest change of gradient across the stencil
  bool in_band = true;
};

Stencil stencilAt(const Field& field, const Vec3& p, double step) {
  Stencil out;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 ahead = p;
    Vec3 behind = p;
    ahead[axis] += step;
    behind[axis] -= step;
    const FieldSample a = field.sample(ahead);
    const FieldSample b = field.sample(behind);
    const double span = ahead[axis] - behind[axis];
    out.slope[axis] = (a.value - b.value) / span;
    out.bend[axis] = (a.gradient - b.gradient) / span;
    out.jump = std::max(out.jump, glm::length(a.gradient - b.gradient));
    out.in_band = out.in_band && a.in_band && b.in_band;
  }
  return out;
}

double largestEntry(const Mat3& m) {
  double largest = 0.0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) largest = std::fmax(largest, std::fabs(m[column][row]));
  }
  return largest;
}

bool isFinite(const Mat3& m) {
  return palpate::isFinite(m[0]) && palpate::isFinite(m[1]) && palpate::isFinite(m[2]);
}

bool insideOf(const FieldCase& field_case, const Field& field, const Vec3& p) {
  return field_case.inside ? field_case.inside(p) : field.value(p) < 0.0;
}

/// Smallest distance found from `p` to a point on the other side, by shooting rays in all
/// directions and then ever closer around the best one: an upper bound that converges to the
/// distance. The gradient only suggests where to shoot first, and how far (`claimed`, and a little
/// more: `expected`). `others` are some points of the other side.
double shootAtBorder(const FieldCase& field_case, const Field& field, const Vec3& p,
                     const std::vector<Vec3>& others, double claimed, double expected, double reach,
                     Random& random) {
  const bool here = insideOf(field_case, field, p);
  double best = reach;
  Vec3 best_direction(0.0);
  const auto shoot = [&](const Vec3& u, double length) {
    if (insideOf(field_case, field, p + u * length) == here) return false;
    double near = 0.0;
    double far = length;
    for (int i = 0; i < 60 && far - near > 1e-12 * reach; ++i) {
      const double middle = 0.5 * (near + far);
      (insideOf(field_case, field, p + u * middle) == here ? near : far) = middle;
    }
    best = far;
    best_direction = u;
    return true;
  };
  const auto shoot_shorter = [&](const Vec3& u) {
    // Several lengths, because a thin part may begin and end before `best`.
    static_cast<void>(shoot(u, best * (1.0 - 1e-9)) || shoot(u, best * 0.97) ||
                      shoot(u, best * 0.8));
  };
  const FieldSample s = field.sample(p);
  const Vec3 hint = unitOr(here ? s.gradient : -s.gradient, Vec3(1.0, 0.0, 0.0));
  shoot(hint, expected);  // so that even a plate is not overshot
  // A ray at a tip passes through it: aim a little beside it, towards points of the other side.
  const Vec3 tip = p + hint * claimed;
  for (const Vec3& other : others) {
    const Vec3 aim = tip + unitOr(other - tip, Vec3(0.0)) * (expected - claimed) - p;
    const double length = glm::length(aim);
    if (length > 0.0 && length < best) shoot(aim / length, length);
  }
  for (int i = 0; i < 150; ++i) shoot_shorter(random.direction());
  for (double spread = 0.3; spread > 1e-6; spread *= 0.93) {
    if (best_direction == Vec3(0.0)) break;
    shoot_shorter(glm::normalize(best_direction + random.direction() * spread));
  }
  return best;
}

}  // namespace

AssertionResult checkGradient(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  const std::vector<Vec3> points = pointsFor(field_case, *field);
  std::size_t at_crease = 0;
  std::size_t checked = 0;
  for (const Vec3& p : points) {
    const FieldSample s = field->sample(p);
    if (!s.in_band) continue;
    const double scale = std::max(glm::length(s.gradient), 1e-2 * field->lipschitz());
    double step = stepAt(field_case, *field, p);
    Stencil stencil = stencilAt(*field, p, step);
    if (!stencil.in_band) continue;
    ++checked;
    if (stencil.jump > 1e-2 * scale) {
      ++at_crease;
      continue;
    }
    const auto is_off = [&] {
      // Error of the differences themselves: rounding of the value divided by the step, and the
      // square of step times curvature, which is the jump.
      const double noise =
          8.0 * kEpsilon * (std::fabs(s.value) + glm::length(p) * field->lipschitz()) / step;
      const double bend = stencil.jump * stencil.jump / scale;
      return !(glm::length(stencil.slope - s.gradient) <=
               field_case.gradient_tolerance * scale + noise + bend);
    };
    if (!is_off()) continue;
    // Near a caustic the curvature itself changes within the step.
    step /= 16.0;
    stencil = stencilAt(*field, p, step);
    if (is_off()) {
      return AssertionFailure() << "at " << text(p) << " the gradient is " << text(s.gradient)
                                << ", differences give " << text(stencil.slope);
    }
  }
  if (checked == 0) return AssertionFailure() << "no point lies in the band";
  if (static_cast<double>(at_crease) > field_case.crease_share * static_cast<double>(checked)) {
    return AssertionFailure() << at_crease << " of " << checked << " points seem to sit at creases";
  }
  return AssertionSuccess();
}

AssertionResult checkSign(const FieldCase& field_case) {
  if (!field_case.inside) return AssertionSuccess() << "no independent test of membership";
  const FieldPtr field = field_case.make();
  const double margin = field_case.sign_margin * diagonal(field_case) * field->lipschitz();
  int inside = 0;
  int outside = 0;
  for (const Vec3& p : pointsFor(field_case, *field)) {
    const double value = field->value(p);
    if (std::fabs(value) <= margin) continue;
    ++(value < 0.0 ? inside : outside);
    if ((value < 0.0) != field_case.inside(p)) {
      return AssertionFailure() << "at " << text(p) << " the value is " << value
                                << ", but the point is " << (value < 0.0 ? "outside" : "inside");
    }
  }
  if (inside == 0 || outside == 0) {
    return AssertionFailure() << inside << " points inside, " << outside
                              << " outside: the region shows one side only";
  }
  return AssertionSuccess();
}

AssertionResult checkBounds(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  const Box3 bounds = field->bounds();
  Random random(7);
  for (const Vec3& p : pointsFor(field_case, *field)) {
    if (field->value(p) <= 0.0 && !bounds.grownBy(1e-12 * diagonal(field_case)).contains(p)) {
      return AssertionFailure() << text(p) << " is inside, but out of bounds";
    }
  }
  // Just beyond each finite face nothing may be inside, wherever on the face.
  const Box3 window =
      bounds.grownBy(1e-9 * diagonal(field_case)).intersectedWith(grown(field_case, 3.0));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double face : {bounds.lo[axis], bounds.hi[axis]}) {
      if (!std::isfinite(face) || window.isEmpty()) continue;
      // The lowest value on the plane just beyond the face, refined from the best of many points.
      const double beyond = 1e-6 * diagonal(field_case);
      const double plane = face == bounds.lo[axis] ? face - beyond : face + beyond;
      const auto on_plane = [&](Vec3 p) {
        p = glm::clamp(p, window.lo, window.hi);
        p[axis] = plane;
        return p;
      };
      Vec3 lowest = on_plane(window.center());
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = on_plane(random.in(window));
        if (field->value(p) < field->value(lowest)) lowest = p;
      }
      double spread = 0.1 * diagonal(field_case);
      for (int i = 0; i < 300; ++i) {
        const Vec3 p = on_plane(lowest + random.direction() * spread);
        if (field->value(p) < field->value(lowest)) {
          lowest = p;
        } else {
          spread *= 0.94;
        }
      }
      if (field->value(lowest) <= 0.0) {
        return AssertionFailure() << text(lowest) << " is inside, beyond a face of the bounds";
      }
    }
  }
  return AssertionSuccess();
}

AssertionResult checkLipschitz(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  const double bound = field->lipschitz();
  const Box3 domain = field->lipschitzDomain().intersectedWith(grown(field_case, 2.0));
  if (domain.isEmpty()) return AssertionFailure() << "the domain of the bound misses the region";
  Random random(11);
  const double size = glm::length(domain.size());
  const auto rise = [&](const Vec3& a, const Vec3& b) {
    const double apart = glm::length(b - a);
    // For a smaller distance, rounding of the values decides.
    if (!(apart > 1e-7 * size)) return 0.0;
    return std::fabs(field->value(b) - field->value(a)) / apart;
  };
  struct Pair {
    Vec3 a{0.0}, b{0.0};
    double rise = 0.0;
  };
  const auto clamped = [&](const Vec3& p) { return glm::clamp(p, domain.lo, domain.hi); };
  std::vector<Pair> steepest;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 a = random.in(domain);
    const Vec3 b =
        i % 2 == 0
            ? random.in(domain)
            : clamped(a + random.direction() * (size * std::pow(10.0, random.uniform(-5.0, -1.0))));
    steepest.push_back({a, b, rise(a, b)});
    // Along the gradient, where a short pair has the steepest slope.
    const FieldSample s = field->sample(a);
    const Vec3 c = clamped(a + unitOr(s.gradient, Vec3(1.0, 0.0, 0.0)) * (1e-5 * size));
    steepest.push_back({a, c, rise(a, c)});
  }
  std::sort(steepest.begin(), steepest.end(),
            [](const Pair& x, const Pair& y) { return x.rise > y.rise; });
  steepest.resize(12);
  for (Pair& pair : steepest) {  // uphill from the best one
    double spread = 0.2 * size;
    for (int i = 0; i < 300; ++i) {
      const Vec3 shift = random.direction() * spread;
      const Vec3 a = clamped(pair.a + shift);
      const Vec3 b =
          clamped(pair.b + shift + random.direction() * (0.1 * glm::length(pair.b - pair.a)));
      const double r = rise(a, b);
      if (r > pair.rise) {
        pair = {a, b, r};
      } else {
        spread *= 0.95;
      }
    }
    if (!(pair.rise <= bound * (1.0 + 1e-6))) {
      return AssertionFailure() << std::setprecision(12) << "between " << text(pair.a) << " and "
                                << text(pair.b) << " the field rises by " << pair.rise
                                << ", the bound is " << bound;
    }
  }
  return AssertionSuccess();
}

AssertionResult checkMetric(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  if (field->metric() == Metric::kImplicit) return AssertionSuccess() << "implicit";
  Random random(13);
  const double tolerance = field_case.distance_tolerance * diagonal(field_case);
  std::vector<Vec3> points = pointsFor(field_case, *field);
  std::vector<Vec3> inside;
  std::vector<Vec3> outside;
  for (const Vec3& p : points) {
    std::vector<Vec3>& side = insideOf(field_case, *field, p) ? inside : outside;
    if (side.size() < 20) side.push_back(p);
  }
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const Vec3& p = points[i];
    const FieldSample s = field->sample(p);
    const double claimed = std::fabs(s.value);
    const double found =
        shootAtBorder(field_case, *field, p, s.value < 0.0 ? outside : inside, claimed,
                      claimed + tolerance, 1.01 * claimed + 4.0 * tolerance, random);
    if (claimed > found + tolerance) {
      return AssertionFailure() << std::setprecision(12) << "at " << text(p) << " the value is "
                                << s.value << ", but the surface is " << found << " away";
    }
    if (field->metric() == Metric::kExact && s.in_band && claimed < found - 2.0 * tolerance) {
      return AssertionFailure() << std::setprecision(12) << "at " << text(p) << " the value is "
                                << s.value << ", but no surface was found that near";
    }
  }
  return AssertionSuccess();
}

AssertionResult checkJet(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  for (const Vec3& p : pointsFor(field_case, *field)) {
    const FieldSample s = field->sample(p);
    const FieldJet jet = field->jet(p);
    if (jet.value != s.value || jet.in_band != s.in_band) {
      return AssertionFailure() << "at " << text(p) << " jet and sample have different values";
    }
    if (!(glm::length(jet.gradient - s.gradient) <= 1e-12 * field->lipschitz())) {
      return AssertionFailure() << "at " << text(p) << " jet and sample have different gradients";
    }
    if (!isFinite(jet.hessian)) return AssertionFailure() << "at " << text(p) << " not finite";
    if (largestEntry(jet.hessian - glm::transpose(jet.hessian)) >
        1e-9 * (largestEntry(jet.hessian) + field->lipschitz() / field->featureSize())) {
      return AssertionFailure() << "at " << text(p) << " the Hessian is not symmetric";
    }
    if (!s.in_band) {
      if (largestEntry(jet.hessian) != 0.0) {
        return AssertionFailure() << "at " << text(p) << " outside the band, yet with a Hessian";
      }
      continue;
    }
    const double step = stepAt(field_case, *field, p);
    const Stencil stencil = stencilAt(*field, p, step);
    if (!stencil.in_band || stencil.jump > 1e-3 * field->lipschitz()) continue;
    const double error = largestEntry(jet.hessian - stencil.bend);
    const double natural = field->lipschitz() / field->featureSize();
    // Relative to the curvature itself where that is larger, as it is inside a tight hollow; the
    // differences of a strongly curved field have a relative error of (step * curvature)^2.
    const double scale = std::max(natural, largestEntry(jet.hessian));
    const double noise = 16.0 * kEpsilon * field->lipschitz() / step;
    if (!(error <= field_case.hessian_tolerance * scale + noise)) {
      return AssertionFailure() << "at " << text(p) << " the Hessian is off by " << error << " of "
                                << scale << " 1/m; " << text(jet.hessian[0]) << text(jet.hessian[1])
                                << text(jet.hessian[2]) << " against " << text(stencil.bend[0])
                                << text(stencil.bend[1]) << text(stencil.bend[2]);
    }
  }
  return AssertionSuccess();
}

AssertionResult checkValue(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  std::vector<Vec3> points = pointsFor(field_case, *field);
  points.insert(points.end(), field_case.awkward.begin(), field_case.awkward.end());
  for (const Vec3& p : points) {
    const double value = field->value(p);
    const double sampled = field->sample(p).value;
    if (std::bit_cast<std::uint64_t>(value) != std::bit_cast<std::uint64_t>(sampled)) {
      return AssertionFailure() << std::setprecision(17) << "at " << text(p) << " value() is "
                                << value << ", sample().value is " << sampled;
    }
  }
  return AssertionSuccess();
}

AssertionResult checkValues(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  std::vector<Vec3> points = pointsFor(field_case, *field);
  // A few points that a batch loop is not designed for, among many that it is.
  std::vector<Vec3> strange = awkwardPoints(field_case, *field);
  strange.insert(strange.end(), {Vec3(kInfinity), Vec3(std::nan(""), 0.0, 0.0),
                                 Vec3(0.0, std::nan(""), 0.0), Vec3(0.0, 0.0, std::nan(""))});
  for (std::size_t n = 0; n < strange.size(); ++n) {
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(37 * n % points.size()), strange[n]);
  }
  points.insert(points.end(), strange.begin(), strange.end());
  points.resize((points.size() + PointBatch::kCount - 1) / PointBatch::kCount * PointBatch::kCount,
                points.front());
  PointBatch batch{};
  ValueBatch values{};
  for (std::size_t first = 0; first < points.size(); first += PointBatch::kCount) {
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const Vec3& p = points[first + n];
      batch.x[n] = p.x;
      batch.y[n] = p.y;
      batch.z[n] = p.z;
    }
    field->values(batch, values);
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const double value = field->value(batch[n]);
      // Any two NaN count as equal.
      if (std::isnan(value) && std::isnan(values[n])) continue;
      if (std::bit_cast<std::uint64_t>(value) != std::bit_cast<std::uint64_t>(values[n])) {
        return AssertionFailure() << std::setprecision(17) << "at " << text(batch[n]) << " (" << n
                                  << " of the batch) values() is " << values[n] << ", value() is "
                                  << value;
      }
    }
  }
  return AssertionSuccess();
}

AssertionResult checkAwkward(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  const std::vector<Vec3> points = awkwardPoints(field_case, *field);
  const bool has_unit_gradient = field->metric() == Metric::kExact && field_case.unit_gradient;
  for (const Vec3& p : points) {
    const FieldJet jet = field->jet(p);
    const FieldSample s = field->sample(p);
    if (!std::isfinite(s.value) || !palpate::isFinite(s.gradient) || field->value(p) != s.value ||
        jet.value != s.value) {
      return AssertionFailure() << "at " << text(p) << " value " << s.value << ", gradient "
                                << text(s.gradient) << ", value() " << field->value(p)
                                << ", jet().value " << jet.value;
    }
    if (!palpate::isFinite(jet.gradient) || !isFinite(jet.hessian)) {
      return AssertionFailure() << "at " << text(p) << " the jet is not finite";
    }
    const double slope = glm::length(s.gradient);
    if (has_unit_gradient && s.in_band && !(std::fabs(slope - 1.0) <= 1e-9)) {
      return AssertionFailure() << "at " << text(p) << " the gradient has length " << slope;
    }
    if (field->metric() == Metric::kBound && !(slope <= 1.0 + 1e-9)) {
      return AssertionFailure() << "at " << text(p) << " the gradient has length " << slope;
    }
    if (!s.in_band && slope != 0.0) {
      return AssertionFailure() << "at " << text(p) << " outside the band, yet with a gradient";
    }
    // Zero and minus zero are the same point.
    const FieldSample again = field->sample(p + Vec3(0.0));
    if (again.value != s.value || again.gradient != s.gradient) {
      return AssertionFailure() << "at " << text(p) << " the sign of a zero matters";
    }
  }
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p = field_case.region.center();
      p[axis] = bad;
      if (std::isfinite(field->value(p)) || std::isfinite(field->jet(p).value)) {
        return AssertionFailure() << "at " << text(p) << " the value is " << field->value(p);
      }
    }
  }
  return AssertionSuccess();
}

AssertionResult checkConstants(const FieldCase& field_case) {
  const FieldPtr field = field_case.make();
  if (!field_case.region.isBounded()) return AssertionFailure() << "the case has no bounded region";
  if (!(field->featureSize() > 0.0) || !std::isfinite(field->featureSize())) {
    return AssertionFailure() << "featureSize() is " << field->featureSize();
  }
  if (!(field->lipschitz() > 0.0) || !std::isfinite(field->lipschitz())) {
    return AssertionFailure() << "lipschitz() is " << field->lipschitz();
  }
  if (field->metric() != Metric::kImplicit && field->lipschitz() != 1.0) {
    return AssertionFailure() << "an exact or bound field has lipschitz() " << field->lipschitz();
  }
  const FieldStructure structure = field->structure();
  using Kind = FieldStructure::Kind;
  const bool has_one = structure.kind == Kind::kComplement || structure.kind == Kind::kTransform;
  if (structure.kind == Kind::kLeaf
          ? !structure.operands.empty()
          : structure.operands.empty() || (has_one && structure.operands.size() != 1)) {
    return AssertionFailure() << "a structure with " << structure.operands.size() << " operands";
  }
  for (const FieldPtr& operand : structure.operands) {
    if (!operand) return AssertionFailure() << "a null operand";
  }
  return AssertionSuccess();
}

// Every module's tests are linked with this file, but most add no field.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(FieldContract);

TEST_P(FieldContract, GradientIsThatOfTheValue) { EXPECT_TRUE(checkGradient(GetParam())); }
TEST_P(FieldContract, SignTellsInsideFromOutside) { EXPECT_TRUE(checkSign(GetParam())); }
TEST_P(FieldContract, BoundsHoldTheInside) { EXPECT_TRUE(checkBounds(GetParam())); }
TEST_P(FieldContract, LipschitzBoundHolds) { EXPECT_TRUE(checkLipschitz(GetParam())); }
TEST_P(FieldContract, ValueIsTheDistanceItClaims) { EXPECT_TRUE(checkMetric(GetParam())); }
TEST_P(FieldContract, JetAgreesWithSample) { EXPECT_TRUE(checkJet(GetParam())); }
TEST_P(FieldContract, ValueAloneIsTheSame) { EXPECT_TRUE(checkValue(GetParam())); }
TEST_P(FieldContract, BatchIsTheSame) { EXPECT_TRUE(checkValues(GetParam())); }
TEST_P(FieldContract, AwkwardPointsAreHarmless) { EXPECT_TRUE(checkAwkward(GetParam())); }
TEST_P(FieldContract, ConstantsBelongTogether) { EXPECT_TRUE(checkConstants(GetParam())); }

}  // namespace palpate::test
