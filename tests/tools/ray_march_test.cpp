// Rays through scenes: their hits compared with closed forms.

#include "picture/ray_march.h"

#include <cmath>
#include <random>

#include "tools/helpers.h"
#include "tools/space_look.h"

namespace palpate::testing {
namespace {

using tools::Camera;
using tools::Color;
using tools::Hit;
using tools::RayMarch;
using tools::SpaceScene;

Color over(const Color& a, double opacity, const Color& below) {
  return {opacity * a.r + (1 - opacity) * below.r, opacity * a.g + (1 - opacity) * below.g,
          opacity * a.b + (1 - opacity) * below.b, 1.0};
}

// Silhouette, normals and colors of a ball from 20 sides, pixel by pixel.
TEST(RayMarch, ABallIsSeenAsTheFormulaSays) {
  const Look look(
      "palpate: 1\nlength: mm\nlayers:\n  - {name: ball, inside: {sphere: {center: [5, "
      "-3, 8], radius: 30}}}\n");
  const Vec3 center(0.005, -0.003, 0.008);
  constexpr double kRadius = 0.030;
  std::mt19937_64 random(1);
  std::normal_distribution<double> any;
  for (int side = 0; side < 20; ++side) {
    const Camera camera = look.camera({any(random), any(random), any(random)}, 64);
    RayMarch march(look.space, camera);
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Vec3 d = camera.world(x + 0.5, y + 0.5) - center;
        const double u = glm::dot(d, camera.right);
        const double v = glm::dot(d, camera.up);
        const double off = std::hypot(u, v);
        // A chord shorter than half a pixel, the shortest step, may be missed.
        const double chord = 2.0 * std::sqrt(std::max(0.0, kRadius * kRadius - off * off));
        if (off < kRadius && chord < camera.step) continue;
        const Hit hit = march.cast(x + 0.5, y + 0.5);
        ASSERT_EQ(hit.part != -1, off < kRadius) << side << " " << x << " " << y;
        if (hit.part == -1) continue;
        const Vec3 normal =
            (u * camera.right + v * camera.up + 0.5 * chord * camera.toward) / kRadius;
        // The surface is found to 2^-12 of a step, which near the silhouette turns the normal by up
        // to some 1e-3.
        expectNear(hit.color, tools::scaled(tools::regionColor(1), tools::shadeOf(normal, camera)),
                   2e-3, std::to_string(x) + " " + std::to_string(y));
      }
    }
  }
}

TEST(RayMarch, SeesThroughLayersInTheirOrder) {
  Look look(kShells);
  const Camera camera = look.camera({0, -1, 0}, 64);
  const double front = tools::shadeOf({0, -1, 0}, camera);
  const Color outer = tools::scaled(tools::regionColor(1), front);
  const Color inner = tools::scaled(tools::regionColor(2), front);
  const Color white{1, 1, 1, 1};
  // Through the center: walls seen from within face the viewer just as those seen from outside.
  const auto seen = [&](double a, double b) {
    look.space.opacity = {1.0, a, b};
    return RayMarch(look.space, camera).cast(32.0, 32.0).color;
  };
  expectNear(seen(1, 1), outer, 1e-6, "opaque");
  expectNear(seen(0.25, 1), over(outer, 0.25, inner), 1e-6, "one");
  expectNear(seen(0, 1), inner, 1e-6, "not there");
  expectNear(seen(0.25, 0.5),
             over(outer, 0.25, over(inner, 0.5, over(inner, 0.5, over(outer, 0.25, white)))), 1e-6,
             "four walls");
}

TEST(RayMarch, TheCutFaceIsFlatAndItsFrontIsGone) {
  Look look(kShells);
  // Cuts away everything in front of y = 5 mm
  look.space.plane = tools::planeAcross(1, 0.005, {"mm", 1e-3});
  const Camera front = look.camera({0, -1, 0}, 64);
  RayMarch march(look.space, front);
  EXPECT_EQ(march.cast(32.0, 32.0).part, 2 * 2) << "the face of the inner layer";
  EXPECT_EQ(march.cast(32.0 + 0.020 / front.step, 32.0).part, 2 * 1) << "that of the outer one";
  const Camera back = look.camera({0, 1, 0}, 64);
  EXPECT_EQ(RayMarch(look.space, back).cast(32.0, 32.0).part, 2 * 1 + 1) << "its rounded back";
}

// The distance that the rays of a block skip together is free for each of them: the result is the
// same as without skipping.
TEST(RandomRays, TheSharedWayHidesNothing) {
  for (const char* name : {"csg_part", "metaballs", "heart", "sponge", "flag", "valve_tube"}) {
    const std::string file = scenePath(std::string(name) + ".yaml");
    const ScenePtr scene = compile(readScene(file));
    const tools::Paint paint(nullptr, *scene, {});
    const SpaceScene space{*scene, paint, scene->bounds().grownBy(0.002)};
    std::mt19937_64 random(7);
    std::normal_distribution<double> any;
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::size_t with_way = 0;
    for (int round = 0; round < 8; ++round) {
      Camera camera = tools::cameraFrom({any(random), any(random), any(random)});
      camera.center = space.box.center();
      camera.width = camera.height = 200;
      camera.step = glm::length(space.box.size()) / camera.width;
      RayMarch march(space, camera);
      for (int block = 0; block < 40; ++block) {
        const double x = camera.width * share(random);
        const double y = camera.height * share(random);
        const double free = march.freeWay(x, y, 6.0);
        if (free > 0.0) ++with_way;
        for (int ray = 0; ray < 6; ++ray) {
          const double angle = 6.2831853 * share(random);
          const double off = 6.0 * share(random);
          const double rx = x + off * std::cos(angle);
          const double ry = y + off * std::sin(angle);
          const Hit without = march.cast(rx, ry);
          const Hit with = march.cast(rx, ry, free);
          // Steps end at different places, so that a chord shorter than the shortest step may be
          // met in one picture and missed in the other.
          if (without.part == with.part) continue;
          const Hit near = march.cast(rx + 0.5, ry + 0.5);
          const Hit other = march.cast(rx - 0.5, ry - 0.5);
          EXPECT_TRUE(near.isApartFrom(other) || near.isApartFrom(without) ||
                      other.isApartFrom(without))
              << name << " " << rx << " " << ry;
        }
      }
    }
    // A gyroid continues everywhere, also where another shape cuts it off: no ray is ever far from
    // it.
    if (std::string(name) != "sponge") {
      EXPECT_GT(with_way, 40U) << name;
    }
  }
}

TEST(RayMarch, ASliceStandsBehindWhatIsSeenThrough) {
  Look look(kShells);
  look.space.opacity = {1.0, 0.25, 1.0};
  look.space.slices = {tools::planeAcross(1, 0.0, {"mm", 1e-3})};
  const Camera camera = look.camera({0, -1, 0}, 64);
  RayMarch march(look.space, camera);
  const Color outer = tools::regionColor(1);
  // 20 mm beside the center: first the outer wall, whose normal there has an x of 20/30, then the
  // slice.
  const double x = 0.020, radius = 0.030;
  const Vec3 normal(x / radius, -std::sqrt(1.0 - x * x / (radius * radius)), 0.0);
  constexpr double kFace = 0.97;  // share of its color that a flat face keeps
  const Color seen = march.cast(32.0 + x / camera.step, 32.0).color;
  expectNear(
      seen,
      over(tools::scaled(outer, tools::shadeOf(normal, camera)), 0.25, tools::scaled(outer, kFace)),
      2e-3, "as far as the surface is found");
  EXPECT_EQ(march.cast(32.0 + 0.031 / camera.step, 32.0).part, -1) << "nothing is cut there";
  const Camera side = look.camera({1, 0, 0}, 64);
  EXPECT_EQ(RayMarch(look.space, side).cast(32.5, 32.0).part, 2 * 1 + 1) << "along the slice";
}

TEST(RayMarch, LightComesThroughAsWallsLetIt) {
  Look look(kShells);
  const Camera camera = look.camera({0, -1, 0}, 64);
  const auto light = [&](double a, double b, const Vec3& from) {
    look.space.opacity = {1.0, a, b};
    return RayMarch(look.space, camera).lightFrom(from, 0.001);
  };
  EXPECT_NEAR(light(0.25, 0.5, {0, 0, 0}), 0.75 * 0.5, 1e-12);
  EXPECT_NEAR(light(0.25, 0.5, {0, 0.020, 0}), 0.75 * 0.5 * 0.5, 1e-12);
  EXPECT_EQ(light(1, 1, {0, 0, 0}), 0.0);
  EXPECT_EQ(light(1, 1, {0, -0.030, 0}), 1.0) << "on the wall that faces the viewer";
  EXPECT_EQ(light(1, 1, {0, -0.050, 0}), 1.0) << "before all of it";
  look.space.plane = tools::planeAcross(1, 0.005, {"mm", 1e-3});
  EXPECT_EQ(light(1, 1, {0, 0, 0}), 1.0) << "what was before it is cut away";
}

// The whole picture of a ball: white around it, inside it the shade that its normal gives, and
// finer rays only at its silhouette.
TEST(DrawSpace, ABallIsWhatItsFormulaSays) {
  const Look look(
      "palpate: 1\nlength: mm\nlayers:\n  - {name: ball, inside: {sphere: {center: [0, 0, 0], "
      "radius: 30}}}\n");
  const Camera camera = look.camera({1, -2, 0.7}, 200);
  const tools::Raster raster = tools::drawSpace(look.space, camera, {});
  constexpr double kRadius = 0.030;
  int inner = 0, outer = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vec3 d = camera.world(x + 0.5, y + 0.5);
      const double u = glm::dot(d, camera.right);
      const double v = glm::dot(d, camera.up);
      const double off = std::hypot(u, v);
      const std::uint32_t word =
          raster.words[static_cast<std::size_t>(y) * 200 + static_cast<std::size_t>(x)];
      if (off > kRadius + 1.5 * camera.step) {
        ASSERT_EQ(word, 0xFFFFFFU) << x << " " << y;
        ++outer;
      }
      // Within 3 pixels of the silhouette the shade changes by more within a pixel, and there is an
      // edge.
      if (off > kRadius - 3.0 * camera.step) continue;
      const Vec3 normal = (u * camera.right + v * camera.up +
                           std::sqrt(kRadius * kRadius - off * off) * camera.toward) /
                          kRadius;
      const Color want = tools::scaled(tools::regionColor(1), tools::shadeOf(normal, camera));
      // Half a step of 8 bits for rounding, and 2e-3 for the error of the surface's place.
      const Color got = tools::rgb(word);
      expectNear(got, want, 0.5 / 255.0 + 2e-3, std::to_string(x) + " " + std::to_string(y));
      ++inner;
    }
  }
  EXPECT_GT(inner, 4000);
  EXPECT_GT(outer, 10000);
}

// The bands in which a tall picture is drawn leave no seam: a shifted picture has the same pixels.
TEST(DrawSpace, BandsLeaveNoSeam) {
  const Look look(kShells);
  Camera camera = look.camera({0, -1, 0}, 600);
  camera.width = 40;
  const tools::Raster whole = tools::drawSpace(look.space, camera, {});
  constexpr int kShift = 96;
  camera.height = 600 - 2 * kShift;
  const tools::Raster part = tools::drawSpace(look.space, camera, {});
  int differing = 0;
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      const auto at = [&](const tools::Raster& r, int row) {
        return r.words[static_cast<std::size_t>(row) * 40 + static_cast<std::size_t>(x)];
      };
      if (at(part, y) != at(whole, y + kShift)) ++differing;
    }
  }
  EXPECT_EQ(differing, 0);
}

}  // namespace
}  // namespace palpate::testing
