// palpate render --view: what rays meet, against closed forms, and the files that come out.

#include "picture/space_picture.h"

#include <cmath>
#include <random>

#include "palpate/scene/scene_file.h"
#include "picture/cutaway.h"
#include "picture/palette.h"
#include "tools/helpers.h"
#include "tools/png_pixels.h"

namespace palpate::testing {
namespace {

using tools::Camera;
using tools::Color;
using tools::Hit;
using tools::RayMarch;
using tools::SpaceScene;

constexpr const char* kShells =
    "palpate: 1\nlength: mm\nlayers:\n"
    "  - {name: outer, inside: {sphere: {center: [0, 0, 0], radius: 30}}}\n"
    "  - {name: inner, inside: {sphere: {center: [0, 0, 0], radius: 12}}}\n";

/// A scene with all that looking at it needs, kept together.
struct Look {
  explicit Look(const std::string& text)
      : scene(compile(parseScene(text, "test"))),
        paint(nullptr, *scene, {}),
        space{*scene, paint, scene->bounds().grownBy(0.002)} {}

  [[nodiscard]] Camera camera(const Vec3& toward, int pixels) const {
    Camera out = tools::cameraFrom(toward);
    out.center = space.box.center();
    out.width = out.height = pixels;
    out.step = glm::length(space.box.size()) / pixels;
    return out;
  }

  ScenePtr scene;
  tools::Paint paint;
  SpaceScene space;
};

void expectNear(const Color& a, const Color& b, double within, const std::string& where) {
  EXPECT_NEAR(a.r, b.r, within) << where;
  EXPECT_NEAR(a.g, b.g, within) << where;
  EXPECT_NEAR(a.b, b.b, within) << where;
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
        // A chord shorter than half a pixel, the least step, may be missed.
        const double chord = 2.0 * std::sqrt(std::max(0.0, kRadius * kRadius - off * off));
        if (off < kRadius && chord < camera.step) continue;
        const Hit hit = march.cast(x + 0.5, y + 0.5);
        ASSERT_EQ(hit.part != -1, off < kRadius) << side << " " << x << " " << y;
        if (hit.part == -1) continue;
        const Vec3 normal =
            (u * camera.right + v * camera.up + 0.5 * chord * camera.toward) / kRadius;
        // The surface is found to 2^-12 of a step, which near the rim turns the normal by up to some 1e-3.
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
  const auto over = [](const Color& a, double opacity, const Color& below) {
    return Color{opacity * a.r + (1 - opacity) * below.r, opacity * a.g + (1 - opacity) * below.g,
                 opacity * a.b + (1 - opacity) * below.b, 1.0};
  };
  const Color white{1, 1, 1, 1};
  // Through the center: walls from within face the viewer as those from outside do.
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
  look.space.plane = tools::planeAcross(1, 0.005, {"mm", 1e-3});  // what is before y = 5 mm
  const Camera front = look.camera({0, -1, 0}, 64);
  RayMarch march(look.space, front);
  EXPECT_EQ(march.cast(32.0, 32.0).part, 2 * 2) << "the face of the inner layer";
  EXPECT_EQ(march.cast(32.0 + 0.020 / front.step, 32.0).part, 2 * 1) << "that of the outer one";
  const Camera back = look.camera({0, 1, 0}, 64);
  EXPECT_EQ(RayMarch(look.space, back).cast(32.0, 32.0).part, 2 * 1 + 1) << "its rounded back";
}

// The way that a block of rays shares is free for each of them: nothing is seen otherwise than without it.
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
          // Steps fall elsewhere, so that a chord shorter than the least step is met by one and not by the other.
          if (without.part == with.part) continue;
          const Hit near = march.cast(rx + 0.5, ry + 0.5);
          const Hit other = march.cast(rx - 0.5, ry - 0.5);
          EXPECT_TRUE(near.isApartFrom(other) || near.isApartFrom(without) ||
                      other.isApartFrom(without))
              << name << " " << rx << " " << ry;
        }
      }
    }
    EXPECT_GT(with_way, 40U) << name;
  }
}

TEST(SpacePicture, ForceColorsGetBrighter) {
  double last = -1.0;
  for (int i = 0; i <= 32; ++i) {
    const Color c = tools::forceColor(i / 32.0);
    const double bright = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(bright, last) << i;
    last = bright;
  }
}

class RenderView : public ::testing::Test {
 protected:
  RenderView() { (void)folder_.file("c.yaml", kContainer); }
  CommandResult render(std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "c.yaml"});
    return runPalpate(more, folder_.path());
  }
  TempFolder folder_;
};

TEST_F(RenderView, StandsInSpace) {
  const CommandResult drawn = render({"-o", "p.png", "--view", "-y", "--size", "640x400"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const Pixels pixels = pixelsOf(textOf(folder_.path("p.png")));
  ASSERT_EQ(pixels.width, 640U);
  ASSERT_EQ(pixels.height, 400U);
  // A bowl of 80 mm, cut flat 15 mm above its center, from the side: the widest row is wider than the lot is high by
  // 80 : 55. In its panel, beyond the title and left of the legend.
  std::size_t left = pixels.width, right = 0, top = pixels.height, bottom = 0;
  for (std::size_t y = 40; y < pixels.height; ++y) {
    for (std::size_t x = 5; x < 440; ++x) {
      const auto& c = pixels.at(x, y);
      if (c[0] > 245 && c[1] > 245 && c[2] > 245) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  ASSERT_GT(right, left + 100);
  const auto width = static_cast<double>(right - left + 1);
  const auto height = static_cast<double>(bottom - top + 1);
  EXPECT_NEAR(width / height, 80.0 / 55.0, 0.02);
}

/// Of a WebP file: how often a chunk comes.
int chunksOf(const std::string& webp, const std::string& name) {
  int found = 0;
  for (std::size_t at = 12; at + 8 <= webp.size();) {
    if (webp.compare(at, 4, name) == 0) ++found;
    const auto byte = [&](std::size_t i) {
      return static_cast<std::size_t>(static_cast<unsigned char>(webp[at + 4 + i]));
    };
    const std::size_t size = byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U;
    at += 8 + size + size % 2;
  }
  return found;
}

TEST_F(RenderView, TurnsAndReplaysAsAnimations) {
  (void)folder_.file(
      "box.yaml",
      "palpate: 1\nlength: mm\nlayers:\n  - {name: box, inside: {box: {center: [0, 0, 0], "
      "size: [40, 10, 20]}}}\n");
  const CommandResult turned = runPalpate({"render", "box.yaml", "-o", "t.webp", "--view", "corner",
                                           "--turn", "5", "--size", "320x320"},
                                          folder_.path());
  ASSERT_EQ(turned.exit_code, 0) << turned.err;
  const std::string turn = textOf(folder_.path("t.webp"));
  EXPECT_EQ(turn.substr(0, 4), "RIFF");
  EXPECT_EQ(turn.substr(8, 4), "WEBP");
  EXPECT_EQ(chunksOf(turn, "ANMF"), 5) << "a box looks different from each side";

  ASSERT_EQ(runPalpate({"touch", "c.yaml", "--insert", "0,0,60", "0,0,0", "--trace", "t.csv"},
                       folder_.path())
                .exit_code,
            0);
  const CommandResult replayed = render({"-o", "r.webp", "--view", "corner", "--trace", "t.csv",
                                         "--replay", "6", "--size", "320x320"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(chunksOf(textOf(folder_.path("r.webp")), "ANMF"), 6);
}

TEST_F(RenderView, RefusesWhatDoesNotGoTogether) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> all = {
      {{"-o", "p.webp", "--turn", "5"}, "of a picture in space"},
      {{"-o", "p.png", "--opacity", "liquid=0.5"}, "of a picture in space"},
      {{"-o", "p.png", "--view", "corner", "--turn", "5"}, "must end in .webp"},
      {{"-o", "p.webp", "--view", "corner"}, "must end in .png"},
      {{"-o", "p.webp", "--view", "corner", "--replay", "5"}, "--replay shows a trace"},
      {{"-o", "p.png", "--view", "0,0,0"}, "has no direction"},
      {{"-o", "p.png", "--view", "north"}, "--view"},
      {{"-o", "p.png", "--view", "+x", "--opacity", "liquid"}, "is not LAYER=SHARE"},
      {{"-o", "p.png", "--view", "+x", "--opacity", "liquid=2"}, "is not LAYER=SHARE"},
      {{"-o", "p.png", "--view", "+x", "--opacity", "liqiud=0.5"}, "did you mean 'liquid'?"}};
  for (const auto& [arguments, message] : all) {
    const CommandResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace palpate::testing
