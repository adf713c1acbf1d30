// The paper's renderer on the paper's figures, against tables of states and Algorithms I and II
// written only from the paper and its documentation (tools/docs/paper.md): the same state, ports
// and force in every tick of a wandering hand.

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "lib/render/paper_text.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

/// A figure given by its surfaces; the effect of its ports is in code, figure by figure.
class Figured {
 public:
  virtual ~Figured() = default;

  struct Layer {
    std::vector<int> faces;
    double viscosity = 0.0;
  };
  std::vector<FieldPtr> fields;
  std::vector<double> signs;  ///< by field: -1 where the solid is outside it
  std::vector<Layer> layers;
  double stiffness = 1000.0;
  double damping = 0.5;
  int state = 0;

  /// Applies the table of ports; returns the names of the ports passed.
  virtual std::string ports(const Vec3& last, const Vec3& now) = 0;
  /// Whether the face of a layer is an open port in the present state.
  [[nodiscard]] virtual bool isOpen(int layer, int face) const = 0;
  /// The force of the content besides its drag.
  [[nodiscard]] virtual Vec3 push(const Vec3&) const { return Vec3(0.0); }
  [[nodiscard]] virtual Vec3 flow() const { return Vec3(0.0); }

  [[nodiscard]] bool in(int face, const Vec3& p) const {
    const auto f = static_cast<std::size_t>(face);
    return signs[f] * fields[f]->value(p) <= 0.0;
  }
  [[nodiscard]] Surface surfaceOf(int layer) const {
    std::vector<Surface> closed;
    for (const int face : layers[static_cast<std::size_t>(layer)].faces) {
      if (isOpen(layer, face)) continue;
      const auto f = static_cast<std::size_t>(face);
      closed.push_back([field = fields[f], sign = signs[f]](const Vec3& p) {
        FieldSample s = field->sample(p);
        s.value *= sign;
        s.gradient *= sign;
        return s;
      });
    }
    return insideAll(closed);
  }
  [[nodiscard]] PaperNumbers numbersOf(int layer) const {
    double feature = kInfinity;
    double slope = 0.0;
    PaperNumbers numbers;
    for (const int face : layers[static_cast<std::size_t>(layer)].faces) {
      const Field& field = *fields[static_cast<std::size_t>(face)];
      feature = std::min(feature, field.featureSize());
      slope = std::max(slope, field.lipschitz());
      numbers.newton = numbers.newton || field.metric() == Metric::kImplicit;
    }
    numbers.epsilon = std::min(1e-6, 1e-4 * feature) * slope;
    return numbers;
  }

  Display tick(const Vec3& last, const Vec3& now) {
    Display d;
    d.passed = ports(last, now);
    d.state = state;
    d.is_free = true;
    if (!d.passed.empty()) return d;
    const auto holds = [&](int layer, bool open) {
      for (const int face : layers[static_cast<std::size_t>(layer)].faces) {
        if (isOpen(layer, face) == open && !in(face, now)) return false;
      }
      return true;
    };
    if (state > 0) {
      const int own = state - 1;
      if (!holds(own, false) && holds(own, true)) {
        d.surface = own;
        d.is_reversed = true;
        d.is_free = false;
        return d;
      }
      if (!holds(own, false) || !holds(own, true)) return d;
    }
    for (int layer = state; layer < static_cast<int>(layers.size()); ++layer) {
      if (hasNoWall(layer) || !holds(layer, false) || !holds(layer, true)) continue;
      d.surface = layer;
      break;
    }
    d.is_free = false;
    return d;
  }
  [[nodiscard]] virtual bool hasNoWall(int) const { return false; }
  /// Whether the surface in contact is a wall at its contact point, for a probe at `now`.
  [[nodiscard]] virtual bool isWallAt(const Display&, const Vec3& /*po*/,
                                      const Vec3& /*now*/) const {
    return true;
  }
};

/// Table I: face 0 is A, face 1 is B.
class Container : public Figured {
 public:
  Container(FieldPtr a, FieldPtr b) {
    fields = {std::move(a), std::move(b)};
    signs = {1, 1};
    layers = {{{0, 1}, 4.0}};
    stiffness = 1500.0;
    damping = 1.0;
  }
  std::string ports(const Vec3& last, const Vec3& now) override {
    const auto row = [&](const Vec3& p) { return (in(0, p) ? 1 : 3) + (in(1, p) ? 0 : 1); };
    const bool entered = state == 1;
    if (row(now) == 1 && row(last) == 2 && !entered) {
      state = 1;  // ENTER_PORT
      return name;
    }
    if (row(now) == 2 && row(last) == 1 && entered) {
      state = 0;  // EXIT_PORT
      return name;
    }
    return {};
  }
  [[nodiscard]] bool isOpen(int, int face) const override { return face == 1; }
  std::string name = "mouth";
};

/// The grid-like interior: Table I with a tank instead of the sphere.
class Tank : public Container {
 public:
  Tank() : Container(box(Vec3(0.0), mm(80, 80, 40)), halfSpace(mm(0, 0, 18), Vec3(0, 0, 1))) {
    layers[0].viscosity = 0.5;
    name = "top";
  }
  [[nodiscard]] Vec3 push(const Vec3& p) const override {
    if (state == 0) return Vec3(0.0);
    constexpr double kTurn = 6.283185307179586;
    return {-0.4 * std::sin(kTurn * p.x / 8e-3), -0.4 * std::sin(kTurn * p.y / 8e-3),
            -0.4 * std::sin(kTurn * p.z / 12e-3)};
  }
};

/// Figure 2.7. The faces are the tube (0), the space right of -45, -15, 15 mm (1, 2, 3), and left
/// of 45 mm (4).
class Tube : public Figured {
 public:
  Tube() {
    fields = {cylinder(Vec3(0.0), Vec3(1, 0, 0), 15e-3, 0.2)};
    for (const double x : {-45.0, -15.0, 15.0}) {
      fields.push_back(halfSpace(mm(x, 0, 0), Vec3(-1, 0, 0)));
    }
    fields.push_back(halfSpace(mm(45, 0, 0), Vec3(1, 0, 0)));
    signs.assign(5, 1.0);
    layers = {{{0, 1, 4}, 1.0}, {{0, 2, 4}, 4.0}, {{0, 3, 4}, 9.0}};
    stiffness = 1500.0;
    damping = 1.0;
  }
  std::string ports(const Vec3& last, const Vec3& now) override {
    if (!in(0, last) || !in(0, now)) return {};
    // The places along the tube: 0 before it, 1 to 3 its fillings, 4 behind it. Port k leads from k
    // - 1 to k.
    const auto place = [&](const Vec3& p) {
      return in(3, p) ? (in(4, p) ? 3 : 4) : in(2, p) ? 2 : in(1, p) ? 1 : 0;
    };
    std::string all;
    const int end = place(now);
    for (int at = place(last); at != end;) {
      const int next = end > at ? at + 1 : at - 1;
      const int port = std::max(at, next);
      const int here = at == 4 ? 0 : at;
      const bool is_due = port == 1 || passed_[static_cast<std::size_t>(port - 1)] != 0;
      if (state != here || !is_due) break;
      passed_[static_cast<std::size_t>(port)] += next > at ? 1 : -1;
      state = next == 4 ? 0 : next;
      if (state == 0) passed_.assign(5, 0);
      all += (all.empty() ? "" : " ") + ("port " + std::to_string(port));
      at = next;
    }
    return all;
  }
  [[nodiscard]] bool isOpen(int layer, int face) const override {
    if (face == 0) return false;
    const bool is_due = face == 1 || passed_[static_cast<std::size_t>(face - 1)] != 0;
    if (state == layer + 1) {  // out of its own filling
      return is_due && (face != 4 || layer == 2);
    }
    // Here the probe would go into another filling, through the port that joins the two.
    const int before = face == 4 ? -1 : face - 1;
    return is_due && face == layer + 1 && state == before;
  }

 private:
  std::vector<int> passed_ = std::vector<int>(5, 0);
};

/// Flow in one direction. The faces are the bore (0), the space right of -40 mm (1), right of 0
/// (2), and left of 40 mm (3).
class Valve : public Figured {
 public:
  Valve() {
    fields = {cylinder(Vec3(0.0), Vec3(1, 0, 0), 12e-3, 0.2),
              halfSpace(mm(-40, 0, 0), Vec3(-1, 0, 0)), halfSpace(Vec3(0.0), Vec3(-1, 0, 0)),
              halfSpace(mm(40, 0, 0), Vec3(1, 0, 0))};
    signs.assign(4, 1.0);
    layers = {{{0, 1, 3}, 1.0}, {{0, 2, 3}, 1.0}};
    stiffness = 800.0;
    damping = 0.5;
  }
  std::string ports(const Vec3& last, const Vec3& now) override {
    if (!in(0, last) || !in(0, now)) return {};
    std::string all;
    const auto pass = [&](const char* port, int to) {
      all += (all.empty() ? "" : " ") + std::string(port);
      state = to;
    };
    const bool right = now.x > last.x;
    const auto crosses = [&](int face) { return in(face, last) != in(face, now); };
    if (right && state == 0 && crosses(1) && in(3, now)) pass("inlet", 1);
    if (right && state == 1 && crosses(2) && in(1, last) && in(3, now)) {
      pass("valve", 2);
    }
    if (right && state == 2 && crosses(3) && in(2, last)) pass("outlet", 0);
    return all;
  }
  [[nodiscard]] bool isOpen(int layer, int face) const override {
    if (face == 1) return layer == 0 && state == 0;
    if (face == 2) return layer == 1 && state == 1;
    return face == 3 && layer == 1 && state == 2;
  }
  [[nodiscard]] Vec3 flow() const override { return {0.02, 0, 0}; }
};

/// Figure 1.1: a cup, glass and liquid; the liquid's surface is not a wall. Faces: outer, hollow,
/// level.
class Cup : public Figured {
 public:
  Cup() {
    fields = {cylinder(Vec3(0.0), Vec3(0, 0, 1), 32e-3, 80e-3),
              cylinder(mm(0, 0, 24), Vec3(0, 0, 1), 29e-3, 0.12),
              halfSpace(mm(0, 0, 20), Vec3(0, 0, 1)), nullptr};
    fields[3] = fields[1];
    signs = {1, 1, 1, -1};
    layers = {{{0, 3}, 0.0}, {{1, 2}, 2.0}};
    stiffness = 1500.0;
    damping = 1.0;
  }
  std::string ports(const Vec3& last, const Vec3& now) override {
    const int before = place(last);
    const int after = place(now);
    if (before == state && before != 1 && after != 1) state = after;
    return {};
  }
  [[nodiscard]] bool isOpen(int, int) const override { return false; }
  [[nodiscard]] bool hasNoWall(int layer) const override { return layer == 1; }
  /// Felt from inside, only the part of the liquid's surface towards the glass is a wall: where
  /// glass is just beyond the contact point, or, on the rim between both, where the probe is in it.
  [[nodiscard]] bool isWallAt(const Display& d, const Vec3& po, const Vec3& now) const override {
    if (d.surface != 1) return true;
    return place(po + 4e-6 * glm::normalize(surfaceOf(1)(po).gradient)) == 1 || place(now) == 1;
  }

 private:
  [[nodiscard]] int place(const Vec3& p) const {
    return in(1, p) && in(2, p) ? 2 : in(0, p) && !in(1, p) ? 1 : 0;
  }
};

/// Solids that cannot be entered, each with its faces.
class Solids : public Figured {
 public:
  Solids(std::vector<std::vector<FieldPtr>> all, double k) {
    for (const auto& solid : all) {
      layers.push_back({});
      for (const FieldPtr& face : solid) {
        layers.back().faces.push_back(static_cast<int>(fields.size()));
        fields.push_back(face);
        signs.push_back(1.0);
      }
    }
    stiffness = k;
  }
  std::string ports(const Vec3&, const Vec3&) override { return {}; }
  [[nodiscard]] bool isOpen(int, int) const override { return false; }
};

std::vector<std::vector<FieldPtr>> wholes(const std::string& name) {
  std::vector<std::vector<FieldPtr>> all;
  const ScenePtr scene = sceneNamed(name);
  for (const Region& region : scene->regions()) {
    if (region.field) all.push_back({region.field});
  }
  return all;
}

std::unique_ptr<Figured> figureNamed(const std::string& name) {
  if (name == "container") {
    return std::make_unique<Container>(sphere(Vec3(0.0), 0.04),
                                       halfSpace(mm(0, 0, 15), Vec3(0, 0, 1)));
  }
  if (name == "lattice") return std::make_unique<Tank>();
  if (name == "composite_tube") return std::make_unique<Tube>();
  if (name == "valve_tube") return std::make_unique<Valve>();
  if (name == "cup") return std::make_unique<Cup>();
  if (name == "csg") {
    const FieldPtr dent = ellipsoid(mm(70, 0, 18), mm(14, 10, 12));
    auto all = std::make_unique<Solids>(
        std::vector<std::vector<FieldPtr>>{
            wholes("csg")[0],
            {ellipsoid(Vec3(0.0), mm(26, 20, 22)), box(Vec3(0.0), mm(34, 34, 34))},
            {box(mm(70, 0, 0), mm(36, 36, 36)), dent}},
        2000.0);
    all->signs.back() = -1.0;
    return all;
  }
  return std::make_unique<Solids>(wholes(name), 1000.0);
}

class PaperFigures : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Figures, PaperFigures,
                         testing::Values("container", "lattice", "composite_tube", "valve_tube",
                                         "cup", "heart", "metaballs", "csg"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(PaperFigures, EveryTickIsAsTheTableAndTheAlgorithmsSay) {
  const std::string name = GetParam();
  const std::unique_ptr<Figured> figure = figureNamed(name);
  Drive drive(sceneNamed(name), RendererKind::kPaper);
  const Box3 box = drive.scene().bounds().grownBy(0.012);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto anywhere = [&] {
    const double x = unit(random);
    const double y = unit(random);
    return box.lo + Vec3(x, y, unit(random)) * box.size();
  };
  PaperText contact;
  bool was_touching = false;
  int last_surface = -1;
  bool last_side = false;
  std::vector<bool> last_open;
  Vec3 hand = box.hi;
  Vec3 goal = anywhere();
  (void)drive.to(hand);
  (void)figure->tick(hand, hand);
  int touched = 0;
  int passed = 0;
  for (int tick = 0; tick < 40'000; ++tick) {
    // Now and then along the tubes' axis, or no port would ever be met.
    if (glm::length(goal - hand) < 1e-9 || tick % 400 == 0) {
      goal = anywhere();
      if (unit(random) < 0.4) goal.y = goal.z = 0.002 * unit(random);
      if (unit(random) < 0.2) goal.x = box.lo.x;
    }
    const Vec3 last = hand;
    const double step = std::min(glm::length(goal - hand), 2e-3 * unit(random));
    if (step > 0.0) hand += step * glm::normalize(goal - hand);
    const Display expected = figure->tick(last, hand);
    const TickResult out = drive.to(hand);
    SCOPED_TRACE(testing::Message() << name << " tick " << tick);
    ASSERT_EQ(drive.events(), expected.passed);
    ASSERT_EQ(static_cast<int>(out.region), expected.state);
    passed += expected.passed.empty() ? 0 : 1;
    const Vec3 velocity = (hand - last) / Drive::kTick;
    Vec3 force(0.0);
    const double viscosity =
        expected.state == 0
            ? 0.0
            : figure->layers[static_cast<std::size_t>(expected.state - 1)].viscosity;
    if (!expected.is_free && viscosity > 0.0) force -= viscosity * (velocity - figure->flow());
    if (!expected.is_free) force += figure->push(hand);
    ASSERT_EQ(out.contact, expected.surface >= 0);
    if (expected.surface >= 0) {
      std::vector<bool> open;
      for (const int face : figure->layers[static_cast<std::size_t>(expected.surface)].faces) {
        open.push_back(figure->isOpen(expected.surface, face));
      }
      const Surface from_outside = figure->surfaceOf(expected.surface);
      const Surface surface = expected.is_reversed ? reversed(from_outside) : from_outside;
      const PaperNumbers numbers = figure->numbersOf(expected.surface);
      const bool goes_on = was_touching && last_surface == expected.surface &&
                           last_side == expected.is_reversed && last_open == open;
      if (goes_on) {
        contact.algorithm2(surface, numbers, last, hand);
      } else {
        contact.algorithm1(surface, numbers, last, hand, hand);
      }
      if (figure->isWallAt(expected, contact.po, hand)) {
        force += figure->stiffness * (contact.po - contact.pi) - figure->damping * velocity;
      }
      last_surface = expected.surface;
      last_side = expected.is_reversed;
      last_open = open;
      ++touched;
      // Both compute the same sums in different orders; where those differ, a search may end one
      // halving apart.
      ASSERT_TRUE(isNear(out.proxy, contact.po, 4e-6));
      ASSERT_TRUE(isNear(out.force, force, 8e-6 * figure->stiffness + 1e-9));
      contact.po = out.proxy;  // otherwise they would drift apart with the contact point
    } else {
      ASSERT_EQ(out.proxy, hand);
      ASSERT_TRUE(isNear(out.force, force, 1e-9));
    }
    was_touching = expected.surface >= 0;
  }
  EXPECT_GT(touched, 1000);
  const bool has_ports = !drive.scene().ports().empty();
  EXPECT_EQ(passed > 10, has_ports) << passed;
}

TEST(PaperFigure27, TheTubesPortsArePassedInTheirOrderAndTheProbeIsOutBehindIt) {
  Drive drive(sceneNamed("composite_tube"), RendererKind::kPaper);
  (void)drive.walk(mm(-60, 0, 0));
  (void)drive.walk(mm(60, 0, 0));
  EXPECT_EQ(drive.events(), "port 1 port 2 port 3 port 4");
  EXPECT_EQ(drive.region(), "outside");
  EXPECT_EQ(drive.last().force, Vec3(0.0));
  // From behind, the tube is shut by steel, at the plane of port 4.
  (void)drive.walk(mm(44, 0, 0));
  EXPECT_EQ(drive.events(), "");
  EXPECT_TRUE(isNear(drive.last().force, {1.5, 0, 0}, 3e-3));
}

TEST(PaperFigure27, ThroughTheSideOfAFillingNoPortIsPassed) {
  Drive drive(sceneNamed("composite_tube"), RendererKind::kPaper);
  (void)drive.walk(mm(0, 0, 30));
  (void)drive.walk(mm(0, 0, 14));
  EXPECT_TRUE(isNear(drive.last().force, {0, 0, 1.5}, 3e-3));
  (void)drive.walk(mm(0, 0, 0));
  (void)drive.walk(mm(30, 0, 0));
  (void)drive.walk(mm(-30, 0, 0));
  EXPECT_EQ(drive.events(), "");
  EXPECT_EQ(drive.region(), "outside");
}

TEST(PaperValve, TheClosedValveIsAWallOnTheWayBack) {
  Drive drive(sceneNamed("valve_tube"), RendererKind::kPaper);
  (void)drive.walk(mm(-60, 0, 0));
  (void)drive.walk(mm(20, 0, 0));
  EXPECT_EQ(drive.events(), "inlet valve");
  (void)drive.walk(mm(-5, 0, 0));
  EXPECT_EQ(drive.events(), "");
  EXPECT_EQ(drive.region(), "downstream");
  EXPECT_TRUE(drive.last().contact);
  EXPECT_TRUE(isNear(drive.last().force, {800 * 5e-3 + 0.02, 0, 0}, 3e-3)) << "wall and current";
  (void)drive.walk(mm(60, 0, 0));
  EXPECT_EQ(drive.events(), "outlet");
  (void)drive.walk(mm(39, 0, 0));
  EXPECT_EQ(drive.region(), "outside") << "and from outside the right end is shut";
  EXPECT_TRUE(isNear(drive.last().force, {0.8, 0, 0}, 3e-3));
}

TEST(PaperParameters, AreThoseOfTheSceneAndThoseGivenGoBeforeThem) {
  const std::string text = containerText("paper: {interior: wall, epsilon: 0.1, alpha: 0}\n");
  const auto in_wall = [&](const std::string& scene, PaperParameters given) {
    RendererSettings settings;
    settings.paper = given;
    Drive drive(sceneOf(scene), RendererKind::kPaper, settings);
    (void)drive.walk(mm(0, 0, 30));
    (void)drive.walk(mm(0, 0, -41));
    (void)drive.to(mm(0.1, 0, -41));
    return drive.last();
  };
  EXPECT_NEAR(in_wall(containerText(), {}).force.x, -4 * 0.1, 1e-2) << "wall and syrup";
  EXPECT_NEAR(in_wall(text, {}).force.x, 0.0, 1e-2) << "the wall alone";
  EXPECT_NEAR(in_wall(text, {.interior = PaperInterior::kTogether}).force.x, -4 * 0.1, 1e-2);
  // Such a large epsilon has a visible effect: contact points are off by up to 0.1 mm, unless a
  // finer one is given.
  const auto off = [&](PaperParameters given) {
    RendererSettings settings;
    settings.paper = given;
    Drive drive(sceneOf(text), RendererKind::kPaper, settings);
    (void)drive.to(mm(50, 0, 0));
    return std::fabs(drive.to(mm(31, 0, 0)).proxy.x - 0.04);
  };
  EXPECT_GT(off({}), 1e-6);
  EXPECT_LE(off({}), 1e-4);
  EXPECT_LE(off({.epsilon = 1e-9}), 1e-9);
  EXPECT_GT(off({.epsilon = 1e-9, .max_halvings = 3}), 1e-4);
}

}  // namespace
}  // namespace palpate::test
