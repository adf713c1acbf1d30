// Algorithms I and II against a transcription of their text made for this test alone, and the drift
// for which they are known.

#include "palpate/contact/paper_contact.h"

#include <gtest/gtest.h>

#include <numbers>

#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// The paper's text, sentence by sentence. S and N are the surface's, P the probe.
struct Text {
  const PaperSurface& surface;
  int reacquired_on_pi = 0;
  int reacquired_on_p = 0;

  [[nodiscard]] double value(const Vec3& p) const {
    return surface.side * surface.field->sample(p).value;
  }
  [[nodiscard]] Vec3 gradient(const Vec3& p) const {
    return surface.side * surface.field->sample(p).gradient;
  }
  [[nodiscard]] Vec3 alphaTerm(const Vec3& p) const {
    const double form =
        surface.newton_form ? glm::dot(gradient(p), gradient(p)) : glm::length(gradient(p));
    return surface.alpha * value(p) * gradient(p) / form;
  }
  [[nodiscard]] Vec3 onNormalLine(const Vec3& po, const Vec3& probe) const {
    return po + gradient(po) *
                    (glm::dot(gradient(po), probe - po) / glm::dot(gradient(po), gradient(po)));
  }

  [[nodiscard]] PaperContact algorithm1(Vec3 out, Vec3 in, const Vec3& probe) const {
    Vec3 po = (out + in) / 2.0;
    for (int n = 0; n < 48 && !(std::fabs(value(po)) < surface.epsilon); ++n) {
      if (value(po) > 0.0) out = po;
      if (value(po) <= 0.0) in = po;
      po = (out + in) / 2.0;
    }
    PaperContact c{po, onNormalLine(po, probe)};
    if (value(po) < 0.0) c.surface_point = po - alphaTerm(po);
    return c;
  }

  [[nodiscard]] PaperContact algorithm2(const PaperContact& last, const Vec3& last_probe,
                                        const Vec3& probe) {
    const Vec3 po0 = last.surface_point;
    const Vec3 n = gradient(po0);
    const Vec3 v = probe - last_probe;
    const Vec3 po = po0 + v - n * (glm::dot(n, v) / glm::dot(n, n)) - alphaTerm(po0);
    const PaperContact c{po, onNormalLine(po, probe)};
    if (value(po) <= surface.epsilon) return c;
    const bool bracket = !(value(c.interaction_point) > 0.0);
    ++(bracket ? reacquired_on_pi : reacquired_on_p);
    return algorithm1(po, bracket ? c.interaction_point : probe, probe);
  }
};

void expectSame(const PaperContact& a, const PaperContact& b, const std::string& where) {
  // Both compute the same sums in different orders: 1e-13 m is a thousand roundings of a decimeter.
  EXPECT_LT(glm::length(a.surface_point - b.surface_point), 1e-13) << where;
  EXPECT_LT(glm::length(a.interaction_point - b.interaction_point), 1e-13) << where;
}

/// An ellipsoid as a quadric: not a distance; its slope on the surface is 2 / radius.
class Quadric final : public Field {
 public:
  explicit Quadric(const Vec3& radii) : radii_(radii) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const Vec3 w = 1.0 / radii_;
    const Vec3 q = p * w;
    return {glm::dot(q, q) - 1.0, 2.0 * q * w};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return {-radii_, radii_}; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1000.0; }
  [[nodiscard]] double featureSize() const noexcept override { return 0.01; }

 private:
  Vec3 radii_;
};

TEST(PaperContact, IsTheTextStepByStep) {
  const std::vector<FieldPtr> fields{sphere(Vec3(0.0), 0.05), box(Vec3(0.0), Vec3(0.08)),
                                     std::make_shared<Quadric>(Vec3(0.05, 0.03, 0.04))};
  int on_pi = 0;
  int first = 0;
  for (const FieldPtr& field : fields) {
    for (const double side : {1.0, -1.0}) {
      for (const bool newton : {false, true}) {
        for (const double alpha : {1.0, 0.3}) {
          // In the printed form the term grows with the slope of S: on the quadric it would throw
          // Po around.
          if (!newton && field->metric() == Metric::kImplicit && alpha > 0.5) continue;
          const PaperSurface surface{field.get(), side, 1e-6, newton ? alpha : 0.02 * alpha,
                                     newton};
          Text text{surface};
          Random random(4);
          PaperContact mine;
          PaperContact theirs;
          bool touching = false;
          Vec3 last = side * Vec3(0.06, 0, 0) * (side > 0 ? 1.0 : 0.0);
          Vec3 drift = random.direction();
          for (int tick = 0; tick < 3000; ++tick) {
            // A walk near the surface, sometimes through it: limited to depths of up to 4 mm.
            const FieldSample s = field->sample(last);
            const double depth = side * random.uniform(-0.004, 0.002);
            drift = glm::normalize(drift + 0.3 * random.direction());
            Vec3 probe = last + 4e-4 * drift;
            probe -= s.gradient * (0.05 * (s.value - depth * glm::length(s.gradient)) /
                                   glm::dot(s.gradient, s.gradient));
            const bool in = text.value(probe) <= 0.0;
            if (in && touching) {
              mine = trackContact(surface, mine, last, probe);
              theirs = text.algorithm2(theirs, last, probe);
            } else if (in && text.value(last) > 0.0) {
              mine = firstContact(surface, last, probe);
              theirs = text.algorithm1(last, probe, probe);
              ++first;
            }
            touching = in && (touching || text.value(last) > 0.0);
            if (touching) {
              expectSame(mine, theirs, std::to_string(tick));
              ASSERT_FALSE(HasFailure()) << "side " << side << " newton " << newton;
              theirs = mine;  // so that rounding differences do not add up until a branch differs
            }
            last = probe;
          }
          on_pi += text.reacquired_on_pi;
        }
      }
    }
  }
  EXPECT_GT(first, 50);
  EXPECT_GT(on_pi, 50) << "re-acquiring was tried";
}

TEST(PaperContact, ReacquiresOnPiOrOnPAsTheTextSays) {
  // Single ticks with long motions over a flat ellipsoid: its normal lines miss it after Po slid
  // off the rim.
  const Quadric flat(Vec3(0.05, 0.05, 0.004));
  Random random(6);
  int on_pi = 0;
  int on_p = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const PaperSurface surface{&flat, 1.0, 1e-6, 0.5, true};
    Text text{surface};
    const auto inside = [&] {
      for (;;) {
        const Vec3 p = random.in(flat.bounds());
        if (flat.value(p) < 0.0) return p;
      }
    };
    const Vec3 last_probe = inside();
    const Vec3 probe = inside();
    const PaperContact last = firstContact(surface, 3.0 * random.direction(), last_probe);
    expectSame(trackContact(surface, last, last_probe, probe),
               text.algorithm2(last, last_probe, probe), std::to_string(trial));
    on_pi += text.reacquired_on_pi;
    on_p += text.reacquired_on_p;
  }
  EXPECT_GT(on_pi, 100);
  EXPECT_GT(on_p, 100);
}

TEST(PaperContact, FirstContactIsTheCrossingOfThePathNotTheClosestPoint) {
  // The paper's figure 2.1: a convex surface met away from its normal.
  const FieldPtr ball = sphere(Vec3(0.0), 0.05);
  const PaperSurface surface{ball.get()};
  const PaperContact c = firstContact(surface, Vec3(-0.06, 0.03, 0), Vec3(0.02, 0.03, 0));
  EXPECT_LT(glm::length(c.surface_point - Vec3(-0.04, 0.03, 0)), 2e-6);
  // Pi: the probe on the normal line (-0.8, 0.6) of that point.
  EXPECT_LT(glm::length(c.interaction_point - c.surface_point - Vec3(0.8, -0.6, 0) * 0.048), 5e-6);
}

TEST(PaperContact, BothAlphaFormsAreWhatTheySay) {
  const Quadric field(Vec3(0.05, 0.03, 0.04));
  const Vec3 inside(0.0499, 0, 0);
  const double value = field.value(inside);
  const Vec3 n = field.sample(inside).gradient;
  const PaperContact last{inside, inside};
  for (const bool newton : {false, true}) {
    for (const double alpha : {1.0, 0.25}) {
      const PaperSurface surface{&field, 1.0, 1e9, alpha, newton};
      const Vec3 moved = trackContact(surface, last, inside, inside).surface_point - inside;
      const double length = newton ? -alpha * value / glm::length(n) : -alpha * value;
      EXPECT_NEAR(moved.x, length, 1e-15) << newton << alpha;
    }
  }
}

TEST(PaperContact, WithoutABracketGoesDownTheGradient) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.05);
  const PaperSurface surface{ball.get()};
  const PaperContact c = firstContact(surface, Vec3(0.03, 0, 0), Vec3(0, 0.04, 0));
  EXPECT_LT(glm::length(c.surface_point - Vec3(0, 0.05, 0)), 1e-6);
  // Exactly at the center one fixed direction is used, and nothing is NaN.
  EXPECT_TRUE(isFinite(firstContact(surface, Vec3(0.0), Vec3(0.0)).surface_point));
}

/// Angle in degrees by which Po lags behind P after `turns` turns at a depth of `share` R.
double lagAfter(double turns, double share, double side) {
  const double radius = 0.05;
  const FieldPtr ball = sphere(Vec3(0.0), radius);
  const PaperSurface surface{ball.get(), side};
  const double rho = radius * (1.0 - side * share);
  const auto at = [&](double angle, double r) {
    return Vec3(r * std::cos(angle), r * std::sin(angle), 0.0);
  };
  const double step = 0.2e-3 / rho;  // 0.2 m/s at 1 kHz
  Vec3 last = at(0.0, rho);
  PaperContact c = firstContact(surface, at(0.0, radius * (1.0 + side * 0.01)), last);
  double lag = 0.0;
  for (int tick = 1; tick * step <= turns * 2.0 * std::numbers::pi; ++tick) {
    const Vec3 probe = at(tick * step, rho);
    c = trackContact(surface, c, last, probe);
    last = probe;
    const double now = tick * step - std::atan2(c.surface_point.y, c.surface_point.x);
    lag += std::remainder(now - lag, 2.0 * std::numbers::pi);  // the unwrapped angle
  }
  return lag * 180.0 / std::numbers::pi;
}

TEST(PaperContact, DriftsOnABall) {
  // Po moves rho per turn on a circle of radius R, so it falls behind by 2 pi d/R at first; the
  // further it is behind, the less of the motion is along its tangent. So the lag is at least 7.2
  // degrees for d/R = 0.02.
  const double one = lagAfter(1.0, 0.02, 1.0);
  EXPECT_GT(one, 7.2);
  EXPECT_LT(one, 9.5);
  EXPECT_GT(lagAfter(2.0, 0.02, 1.0), 2.0 * one) << "and it adds up";
  EXPECT_GT(lagAfter(1.0, 0.1, 1.0), 36.0);
  EXPECT_LT(lagAfter(1.0, 0.1, 1.0), 180.0);
  EXPECT_LT(lagAfter(0.25, 0.02, -1.0), 0.0) << "in a hollow it runs ahead";
}

}  // namespace
}  // namespace palpate::test
