// Sweeps against dense sampling of the same segment.

#include "palpate/contact/sweep.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>

#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

using Kind = SweepResult::Kind;

/// S from a function; the gradient by differences.
class FromFunction final : public Field {
 public:
  FromFunction(std::function<double(const Vec3&)> f, double lipschitz, double feature)
      : f_(std::move(f)), lipschitz_(lipschitz), feature_(feature) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample out{f_(p), Vec3(0.0)};
    const double h = 1e-6 * feature_;
    for (int i = 0; i < 3; ++i) {
      Vec3 e(0.0);
      e[i] = h;
      out.gradient[i] = (f_(p + e) - f_(p - e)) / (2 * h);
    }
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return f_(p); }
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  std::function<double(const Vec3&)> f_;
  double lipschitz_, feature_;
};

double torus(const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 0.03, p.z) - 0.01; }

struct Shape {
  const char* name;
  FieldPtr field;
  bool has_edges = false;
};

std::vector<Shape> shapes() {
  return {
      {"sphere", sphere(Vec3(0.0), 0.03)},
      {"box", box(Vec3(0.0), Vec3(0.06, 0.04, 0.02)), true},
      {"plate of 0.1 mm", box(Vec3(0.0), Vec3(0.06, 0.06, 1e-4)), true},
      {"cylinder", cylinder(Vec3(0.0), Vec3(1, 1, 0), 0.02, 0.05), true},
      {"torus", std::make_shared<FromFunction>(torus, 1.0, 0.01)},
      // Slopes from 0.2 to 40: only an upper bound of the slope is known, and it is far too large
      // almost everywhere.
      {"uneven", std::make_shared<FromFunction>(
                     [](const Vec3& p) {
                       const double d = glm::length(p) - 0.03;
                       return d * (20.0 + 19.8 * std::sin(80.0 * p.x));
                     },
                     // |d (d/dx) factor| + factor, for |d| <= 0.1
                     40.0 + 0.1 * 19.8 * 80.0, 0.03)},
  };
}

SweepSurface surfaceOf(const FieldPtr& field, double side) {
  const double tolerance = 1e-9 * field->featureSize() * field->lipschitz();
  return {field.get(), side, field->lipschitz(), tolerance, 0.02 * field->featureSize()};
}

/// Largest depth beyond the wall among `n` samples of the way up to share `until`.
double deepest(const SweepSurface& s, const Vec3& a, const Vec3& b, double until, int n) {
  double worst = kInfinity;
  for (int i = 0; i <= n; ++i) {
    worst = std::min(worst, s.side * s.field->value(a + (until * i / n) * (b - a)));
  }
  return worst;
}

TEST(Sweep, AgainstDenseSamplingFromBothSides) {
  for (const Shape& shape : shapes()) {
    Random random(17);
    int hits = 0;
    int unsure = 0;
    // Ticks of 0.1 to 20 mm, that is 0.1 to 20 m/s at 1 kHz; some as long as the scene.
    for (int trial = 0; trial < 6000; ++trial) {
      const Vec3 a = random.in({Vec3(-0.045), Vec3(0.045)});
      const double length = std::pow(10.0, random.uniform(-4.0, -1.0));
      const Vec3 b = a + length * random.direction();
      const double value = shape.field->value(a);
      if (std::fabs(value) < 1e-7) continue;
      const SweepSurface s = surfaceOf(shape.field, value > 0.0 ? 1.0 : -1.0);
      const SweepResult out = sweep(s, a, b, std::fabs(value), 4096);
      ASSERT_GE(out.at, 0.0);
      ASSERT_LE(out.at, 1.0);
      // The point stays on its own side up to the reported share, except for grazes shorter than
      // `graze`: a chord of that length dips by graze^2 / (8 R) = 5e-5 R into a curved wall, and by
      // graze / 2 into an edge.
      const double dip =
          (shape.has_edges ? 1e-2 : 1e-4) * shape.field->featureSize() * shape.field->lipschitz();
      ASSERT_GE(deepest(s, a, b, out.at, 500), -dip) << shape.name << " trial " << trial;
      if (out.kind == Kind::kHit) {
        ++hits;
        const double here = s.side * shape.field->value(a + out.at * (b - a));
        ASSERT_GE(here, -s.tolerance) << shape.name;
        ASSERT_LE(here, 2.0 * s.tolerance + 1e-15 * s.lipschitz) << shape.name;
      } else if (out.kind == Kind::kFree) {
        const double end = s.side * shape.field->value(b);
        ASSERT_GT(end, -s.tolerance) << shape.name << ": never ends beyond the wall";
        ASSERT_LE(out.end_value, end + 1e-15) << shape.name << ": a lower bound";
        ASSERT_EQ(out.at, 1.0);
      } else {
        ++unsure;
      }
    }
    EXPECT_GT(hits, 150) << shape.name;
    EXPECT_LE(unsure, 6) << shape.name << ": the budget is enough for nearly all";
  }
}

TEST(Sweep, APlateThinnerThanTheStepIsHit) {
  for (const double thickness : {1e-3, 1e-4, 1e-6}) {
    const FieldPtr plate = box(Vec3(0.0), Vec3(0.1, 0.1, thickness));
    Random random(2);
    for (const double length : {1e-3, 5e-3, 20e-3, 1.0}) {
      for (int trial = 0; trial < 50; ++trial) {
        const Vec3 through(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.0);
        Vec3 u = random.direction();
        if (std::fabs(u.z) < 0.2) u.z = 0.2;
        u = glm::normalize(u);
        const double share = random.uniform(0.2, 0.8);
        const Vec3 a = through - share * length * u;
        const Vec3 b = a + length * u;
        const double start = plate->value(a);
        if (start <= 0.0) continue;
        const SweepResult out = sweep(surfaceOf(plate, 1.0), a, b, start, 4096);
        ASSERT_EQ(out.kind, Kind::kHit) << thickness << " " << length;
        const double z = (a + out.at * (b - a)).z;
        EXPECT_NEAR(z, std::copysign(0.5 * thickness, a.z), 1e-12 + 1e-7 * thickness);
      }
    }
  }
}

TEST(Sweep, FromTheSurface) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.03);
  const Vec3 on(0.03, 0, 0);
  for (const double side : {1.0, -1.0}) {
    const SweepSurface s = surfaceOf(ball, side);
    for (const double start : {0.0, 0.9 * s.tolerance, -0.9 * s.tolerance}) {
      const Vec3 a = on + side * start * Vec3(1, 0, 0);
      for (const double length : {1e-5, 1e-3, 0.02}) {
        const Vec3 away = a + side * length * Vec3(0.6, 0.8, 0);
        EXPECT_EQ(sweep(s, a, away, start, 256).kind, Kind::kFree) << side << start << length;
        const Vec3 into = a - side * length * Vec3(0.6, 0.8, 0);
        const SweepResult hit = sweep(s, a, into, start, 256);
        EXPECT_EQ(hit.kind, Kind::kHit);
        EXPECT_EQ(hit.at, 0.0);
      }
    }
  }
  // From inside, a sweep along a chord is free across the interior, then hits the opposite wall.
  const SweepSurface within = surfaceOf(ball, -1.0);
  const Vec3 chord = glm::normalize(Vec3(-1, 1, 0));
  const SweepResult hit = sweep(within, on, on + 0.1 * chord, 0.0, 256);
  ASSERT_EQ(hit.kind, Kind::kHit);
  EXPECT_NEAR(hit.at * 0.1, 0.03 * std::sqrt(2.0), 1e-9);
  // From outside, a sweep along the tangent never goes through the wall.
  EXPECT_EQ(sweep(surfaceOf(ball, 1.0), on, on + Vec3(0, 0.1, 0), 0.0, 256).kind, Kind::kFree);
}

TEST(Sweep, GrazesAndTangents) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.03);
  const SweepSurface s = surfaceOf(ball, 1.0);
  for (const double miss : {1e-3, 1e-6, 1e-9, 0.0}) {
    const Vec3 a(-0.1, 0.03 + miss, 0);
    const SweepResult out = sweep(s, a, a + Vec3(0.2, 0, 0), ball->value(a), 4096);
    EXPECT_EQ(out.kind, Kind::kFree) << miss;
  }
  // Deep enough that the chord is longer than `graze`: hit.
  const Vec3 a(-0.1, 0.03 - 3e-6, 0);
  const SweepResult out = sweep(s, a, a + Vec3(0.2, 0, 0), ball->value(a), 4096);
  ASSERT_EQ(out.kind, Kind::kHit);
  EXPECT_NEAR(a.x + 0.2 * out.at, -std::sqrt(0.03 * 0.03 - a.y * a.y), 1e-6);
}

TEST(Sweep, BudgetsAreKeptAndWhatIsSaidIsTrue) {
  struct Counting final : Field {
    mutable int calls = 0;
    [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
      ++calls;
      return {p.z, Vec3(0, 0, 1)};
    }
    [[nodiscard]] double value(const Vec3& p) const noexcept override {
      ++calls;
      return p.z;
    }
    [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
    [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
    [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
    [[nodiscard]] double featureSize() const noexcept override { return 1e-6; }
  } field;
  // A long way close above a plane, whose Lipschitz bound permits only tiny steps.
  const SweepSurface s{&field, 1.0, 1.0, 1e-12, 1e-9};
  for (const int budget : {16, 64, 256}) {
    field.calls = 0;
    const SweepResult out = sweep(s, Vec3(0, 0, 1e-6), Vec3(1, 0, 1e-6), 1e-6, budget);
    EXPECT_EQ(out.kind, Kind::kUnsure);
    EXPECT_LE(field.calls, budget + 60);  // narrowing down a hit may add some
    EXPECT_LT(out.at, 0.1);
    EXPECT_GT(out.at, 0.0);
  }
  EXPECT_EQ(sweep(s, Vec3(0.0, 0, 1), Vec3(0.0, 0, 1), 1.0, 8).kind, Kind::kFree) << "no motion";
}

/// Falls from z = 1 to z = 0, with a zero at `at`: linearly, or curved to either side. Counts its
/// evaluations.
struct Falling final : Field {
  enum class Bend : std::uint8_t { kLine, kHollow, kBulging };
  Falling(double zero, Bend how) : at(zero), bend(how) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    ++looks;
    const double down = 1.0 - p.z;
    if (bend == Bend::kLine) return {p.z - at, Vec3(0, 0, 1)};
    if (bend == Bend::kHollow) return {p.z * p.z - at * at, Vec3(0, 0, 2.0 * p.z)};
    return {(1.0 - at) * (1.0 - at) - down * down, Vec3(0, 0, 2.0 * down)};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override {
    return bend == Bend::kLine ? 1.0 : 2.0;
  }
  [[nodiscard]] double featureSize() const noexcept override { return 1.0; }
  double at;
  Bend bend;
  mutable int looks = 0;
};

TEST(Sweep, NarrowsDownInFewLooks) {
  using Bend = Falling::Bend;
  for (const double at : {0.3, 0.5, 0.7}) {
    for (const Bend bend : {Bend::kLine, Bend::kHollow, Bend::kBulging}) {
      const Falling field(at, bend);
      const double start = field.value(Vec3(0, 0, 1));
      field.looks = 0;
      const SweepSurface s{&field, 1.0, field.lipschitz(), 1e-10, 1.0};
      const SweepResult out = sweep(s, Vec3(0, 0, 1), Vec3(0.0), start, 64);
      ASSERT_EQ(out.kind, Kind::kHit);
      // The hit is on the near side of the surface, closer to it than the tolerance.
      EXPECT_LE(out.at, 1.0 - at);
      EXPECT_GT(out.at, 1.0 - at - 1e-9);
      // The end, and one secant step if the value is linear. If it is curved, one end would stay
      // for ever if its value were not halved: that would take 14 evaluations and more.
      EXPECT_LE(field.looks, bend == Bend::kLine ? 2 : 12) << at;
    }
  }
}

}  // namespace
}  // namespace palpate::test
