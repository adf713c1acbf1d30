// palpate render --view: the files that it writes, and the options that it refuses.

#include "picture/space_picture.h"

#include "picture/space_path.h"
#include "tools/helpers.h"
#include "tools/png_pixels.h"

namespace palpate::testing {
namespace {

using tools::Color;

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
  // A bowl of 80 mm, cut flat 15 mm above its center, seen from the side: its widest row is to its
  // total height as 80 : 55. Only the panel is searched, below the title and left of the legend.
  std::size_t left = pixels.width, right = 0, top = pixels.height, bottom = 0;
  for (std::size_t y = 40; y < pixels.height; ++y) {
    for (std::size_t x = 5; x < 440; ++x) {
      const auto& c = pixels.at(x, y);
      if (c[0] - c[2] < 12) continue;  // paper, scale bar and axes are gray
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

/// How often a chunk occurs in a WebP file.
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
      {{"-o", "p.webp", "--turn", "5"}, "apply to pictures in space"},
      {{"-o", "p.png", "--opacity", "liquid=0.5"}, "apply to pictures in space"},
      {{"-o", "p.png", "--slice", "x=0"}, "apply to pictures in space"},
      {{"-o", "p.png", "--around", "0,0,0,10"}, "apply to pictures in space"},
      {{"-o", "p.gif", "--view", "corner", "--turn", "5"}, "must end in .png or .webp"},
      {{"-o", "p.png", "--view", "corner", "--forces", "8"}, "where the scene is cut"},
      {{"-o", "p.png", "--view", "corner", "--iso", "5"}, "where the scene is cut"},
      {{"-o", "p.png", "--iso", "-1"}, "is not above 0"},
      {{"-o", "p.png", "--iso", "0.001"}, "would merge"},
      {{"-o", "p.png", "--view", "+x", "--slice", "x=1", "--iso", "1um"}, "would merge"},
      {{"-o", "p.png", "--view", "+x", "--slice", "w=1"}, "--slice: 'w=1' is not x=VALUE"},
      {{"-o", "p.png", "--view", "+x", "--around", "0,0,0"}, "is not four numbers"},
      {{"-o", "p.png", "--view", "+x", "--around", "0,0,0,-1"}, "nothing can be seen"},
      {{"-o", "p.png", "--view", "+x", "--around", "1e300,0,0,1"}, "nothing can be seen"},
      {{"-o", "p.webp", "--view", "corner"}, "must end in .png"},
      {{"-o", "p.webp", "--view", "corner", "--replay", "5"}, "--replay shows a trace"},
      {{"-o", "p.png", "--view", "0,0,0"}, "has no direction"},
      {{"-o", "p.png", "--view", "north"}, "is not a place to look from"},
      {{"-o", "p.png", "--view", "nan,0,0"}, "is not three numbers"},
      {{"-o", "p.png", "--view", "+x", "--opacity", "liquid"}, "is not LAYER=SHARE"},
      {{"-o", "p.png", "--view", "+x", "--opacity", "liquid=2"}, "is not LAYER=SHARE"},
      {{"-o", "p.png", "--view", "+x", "--opacity", "liqiud=0.5"}, "did you mean 'liquid'?"}};
  for (const auto& [arguments, message] : all) {
    const CommandResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  }
  EXPECT_EQ(filesIn(folder_.path()), std::vector<std::string>{"c.yaml"}) << "nothing was written";
}

TEST_F(RenderView, WritesFramesAllOrNone) {
  const std::vector<std::string> turn = {"-o",     "t.png", "--view", "front",
                                         "--turn", "3",     "--size", "320x320"};
  (void)folder_.file("t-0002.png", "mine");
  const CommandResult refused = render(turn);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("t-0002.png"), std::string::npos) << refused.err;
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"c.yaml", "t-0002.png"}));
  std::filesystem::remove(folder_.path("t-0002.png"));
  ASSERT_EQ(render(turn).exit_code, 0);
  EXPECT_EQ(filesIn(folder_.path()),
            (std::vector<std::string>{"c.yaml", "t-0001.png", "t-0002.png", "t-0003.png"}));
  EXPECT_EQ(pixelsOf(textOf(folder_.path("t-0003.png"))).width, 320U);
}

TEST_F(RenderView, ABrokenTraceLeavesNothing) {
  (void)folder_.file("t.csv", "no trace\n");
  const CommandResult broken = render({"-o", "r.webp", "--view", "corner", "--trace", "t.csv",
                                       "--replay", "6", "--size", "320x320"});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_NE(broken.err.find("this is not a trace"), std::string::npos) << broken.err;
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"c.yaml", "t.csv"}));
}

// The same direction given by name, axis or numbers yields the same picture, byte for byte.
TEST_F(RenderView, NamesAndNumbersAreTheSameCamera) {
  int number = 0;
  const auto bytes = [&](const std::string& view) {
    const std::string file = std::to_string(number++) + ".png";
    EXPECT_EQ(render({"-o", file, "--view", view, "--size", "320x320"}).exit_code, 0) << view;
    return textOf(folder_.path(file));
  };
  const std::string front = bytes("front");
  EXPECT_EQ(front, bytes("-y"));
  EXPECT_EQ(front, bytes("0,-1e-200,0"));
  EXPECT_EQ(front, bytes("0,-1e200,0"));
  EXPECT_NE(front, bytes("bottom"));
}

}  // namespace
}  // namespace palpate::testing
