// Whole scenes turned, mirrored, scaled, moved and sampled at another rate feel the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "lib/render/drive.h"
#include "support/random_hand.h"
#include "support/random_scene.h"
#include "support/rest_oracle.h"

namespace palpate::test {
namespace {

constexpr int kScenes = 80;
constexpr int kTicks = 250;
constexpr double kEps = std::numeric_limits<double>::epsilon();

/// The original scene, and the trace of a random hand in it.
struct Trace {
  RandomScene scene;
  ScenePtr compiled;
  std::vector<Vec3> path;
  std::vector<TickResult> ticks;
};

std::optional<Trace> traceOf(std::uint64_t number) {
  Trace out;
  out.scene = randomScene(number);
  if (out.scene.is_label_group)
    return std::nullopt;  // its layers share an image, which a scene file cannot move
  out.compiled = out.scene.compiled();
  const testing::RegionTree tree(*out.compiled, out.compiled->startRegion());
  const auto start = roomyPoint(tree, number);
  if (!start) return std::nullopt;
  const auto renderer = makeRenderer(out.compiled);
  RandomHand hand(number, *start);
  out.path.push_back(*start);
  out.ticks.push_back(renderer->update({*start, Vec3(0.0)}));
  for (int i = 1; i < kTicks; ++i) {
    out.path.push_back(hand.next(out.ticks.back().proxy, tree));
    out.ticks.push_back(renderer->update({out.path.back(), Vec3(0.0)}));
  }
  return out;
}

const std::vector<Trace>& traces() {
  static const std::vector<Trace> all = [] {
    std::vector<Trace> out;
    for (std::uint64_t number = 1; out.size() < kScenes; ++number) {
      if (auto trace = traceOf(number)) out.push_back(std::move(*trace));
    }
    return out;
  }();
  return all;
}

/// The pose of the other scene in the world, and its sampling rate.
struct Elsewhere {
  RandomSceneOptions options;
  double scale = 1.0;
  Mat3 turn{1.0};
  Vec3 shift{0.0};  ///< [m]
  int samples = 1;  ///< number of its ticks in a tick of the trace

  [[nodiscard]] Vec3 of(const Vec3& p) const { return scale * (turn * p) + shift; }
};

struct Difference {
  long ticks = 0;
  long contacts = 0;
  long beyond = 0;     ///< differences beyond the bound, where the oracle knows only one end
  long forked = 0;     ///< differences beyond the bound, where it knows several
  double worst = 0.0;  ///< largest difference over its bound, where not forked
};

/// Each run may be off the minimum by 1e-6 of the depth; walls are met to a billionth of their
/// feature sizes, and to about ten roundings of the coordinates, which a field's value accumulates.
/// In a wedge all of this grows by 1 / sine.
double boundOf(double on_surface, const Elsewhere& other, double depth, double blunt) {
  const double rounding = 16.0 * kEps * glm::length(other.shift) / other.scale + 16.0 * kEps * 0.05;
  return 2e-6 * depth + (8.0 * on_surface + rounding) / std::max(blunt, 1e-3);
}

Difference compare(const Elsewhere& other) {
  Difference out;
  for (const Trace& trace : traces()) {
    const RandomScene scene = randomScene(trace.scene.number, other.options);
    const ScenePtr compiled = scene.compiled();
    const auto renderer = makeRenderer(compiled);
    const testing::RegionTree there(*compiled, compiled->startRegion());
    const testing::RegionTree tree(*trace.compiled, trace.compiled->startRegion());
    const testing::RestOracle oracle(tree);
    // A plane's tolerance is a billionth of 0.1 m, whatever the size of the scene.
    const double on_surface = std::max(tree.onSurface(), there.onSurface() / other.scale);
    (void)renderer->update({other.of(trace.path[0]), Vec3(0.0), 1e-3});
    for (std::size_t i = 1; i < trace.path.size(); ++i) {
      TickResult now;
      for (int k = 1; k <= other.samples; ++k) {
        const double share = static_cast<double>(k) / other.samples;
        const Vec3 p = glm::mix(trace.path[i - 1], trace.path[i], share);
        now = renderer->update({other.of(p), Vec3(0.0), 1e-3 / other.samples});
      }
      ++out.ticks;
      const TickResult& first = trace.ticks[i];
      out.contacts += first.contact ? 1 : 0;
      const Vec3 here = glm::transpose(other.turn) * (now.proxy - other.shift) / other.scale;
      const double depth = glm::length(first.proxy - trace.path[i]);
      const double off = glm::length(here - first.proxy);
      if (off <= boundOf(on_surface, other, depth, 1.0)) {
        out.worst = std::max(out.worst, off / boundOf(on_surface, other, depth, 1.0));
        continue;
      }
      // Either the hand is deep in a wedge, or rounding chose one of several ends. Then both
      // proxies go on from different places, and the rest of the trace is not compared.
      const testing::Rest rest = oracle.solve(trace.ticks[i - 1].proxy, trace.path[i]);
      const double bound = boundOf(on_surface, other, depth, rest.blunt);
      if (off <= bound) continue;
      bool is_forked = false;
      for (const Vec3& end : rest.others) is_forked |= glm::length(end - rest.point) > bound;
      ++(is_forked ? out.forked : out.beyond);
      if (!is_forked) {
        out.worst = std::max(out.worst, off / bound);
        std::printf("  scene %llu tick %zu: off by %.3g of depth %.3g m\n",
                    static_cast<unsigned long long>(trace.scene.number), i, off, depth);
      }
      break;
    }
  }
  return out;
}

void expectTheSame(const Elsewhere& other) {
  const Difference out = compare(other);
  std::printf("%ld ticks, %ld in contact: %ld scenes beyond the bound, %ld forked; %.3g of it\n",
              out.ticks, out.contacts, out.beyond, out.forked, out.worst);
  EXPECT_GT(out.contacts, kScenes * kTicks / 5);
  EXPECT_EQ(out.beyond, 0);
  EXPECT_LE(out.forked, kScenes / 20);
}

std::string placedBy(const char* shift) {
  return std::string("translate: ") + shift + ", rotate: {axis: [1, 2, 3], degrees: 40}";
}
Mat3 turned() { return rotationAbout(Vec3(1, 2, 3), 40.0 * 0.017453292519943295); }

TEST(Symmetry, Turned) {
  Elsewhere other;
  other.options.placed = placedBy("[0, 0, 0]");
  other.turn = turned();
  expectTheSame(other);
}

TEST(Symmetry, Mirrored) {
  Elsewhere other;
  other.options.mirrored = true;
  other.turn = Mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  expectTheSame(other);
}

TEST(Symmetry, AThousandthOfTheSize) {
  Elsewhere other;
  other.options.unit = "um";
  other.scale = 1e-3;
  expectTheSame(other);
}

TEST(Symmetry, AThousandTimesTheSize) {
  Elsewhere other;
  other.options.unit = "m";
  other.scale = 1e3;
  expectTheSame(other);
}

TEST(Symmetry, MovedByAKilometer) {
  Elsewhere other;
  other.options.placed = placedBy("[600000, 0, -800000]");
  other.turn = turned();
  other.shift = {600.0, 0.0, -800.0};
  expectTheSame(other);
}

TEST(Symmetry, SampledAtEightKilohertz) {
  Elsewhere other;
  other.samples = 8;
  expectTheSame(other);
}

}  // namespace
}  // namespace palpate::test
