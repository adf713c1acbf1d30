#include "picture/space_path.h"

#include <algorithm>

#include "picture/palette.h"

namespace palpate::tools {
namespace {

constexpr int kShades = 32;
constexpr std::size_t kMostPoints = 4000;
constexpr double kHides = 0.5;  // opacity above which a surface hides the path
// [pixels] A wall on which the tip rests does not hide it within this distance
constexpr double kMargin = 2.0;

}  // namespace

SpacePath::SpacePath(const Track& track) {
  const std::size_t stride = track.points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    if (i % stride == 0 || i + 1 == track.points.size()) shown_.push_back(track.points[i]);
    peak_ = std::max(peak_, glm::length(track.points[i].force));
  }
  is_hidden_.assign(shown_.size(), false);
}

std::vector<Vec3> SpacePath::tips() const {
  std::vector<Vec3> tips;
  tips.reserve(shown_.size());
  for (const Track::Point& p : shown_) tips.push_back(p.proxy);
  return tips;
}

void SpacePath::look(const SpaceScene& space, const Camera& camera) {
  RayMarch march(space, camera);
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    is_hidden_[i] = march.lightFrom(shown_[i].proxy, kMargin * camera.step) < kHides;
  }
}

int SpacePath::shadeAt(std::size_t i) const {
  if (!(peak_ > 0.0)) return 0;
  const double share = glm::length(shown_[i].force) / peak_;
  return std::clamp(static_cast<int>(kShades * share), 0, kShades - 1);
}

void SpacePath::draw(Sheet& s, const Place& at, std::size_t count) const {
  std::vector<Pixel> line;
  line.reserve(count);
  for (std::size_t i = 0; i < count; ++i) line.push_back(at(shown_[i].proxy));
  // Hidden parts are drawn first, below visible ones.
  for (const bool is_hidden : {true, false}) {
    for (std::size_t i = 0; i + 1 < count;) {
      // Adjacent segments of one shade are drawn as one stroke.
      const int shade = shadeAt(i);
      std::size_t end = i + 1;
      while (end + 1 < count && shadeAt(end) == shade && is_hidden_[end] == is_hidden_[i]) ++end;
      if (is_hidden_[i] == is_hidden) {
        const std::vector<Pixel> part(line.begin() + static_cast<std::ptrdiff_t>(i),
                                      line.begin() + static_cast<std::ptrdiff_t>(end) + 1);
        Color color = forceColor((shade + 0.5) / kShades);
        color.a = is_hidden ? 0.45 : 1.0;
        if (!is_hidden) s.canvas.line(part, {rgb(0xFFFFFF, 0.85), s.px(6.5)});
        s.canvas.line(part, {color, s.px(is_hidden ? 2.2 : 3.6)});
      }
      i = end;
    }
  }
}

void SpacePath::drawHand(Sheet& s, const Camera& camera, const Place& at, std::size_t index,
                         double longest) const {
  const Track::Point& now = shown_[index];
  const Pixel tip = at(now.proxy);
  const Pixel hand = at(now.hip);
  s.canvas.line({tip, hand}, {kHipInk, s.px(2), {s.px(5), s.px(4)}});
  s.canvas.disk(hand, s.px(6), kHipInk);
  s.canvas.disk(tip, s.px(8), rgb(0xFFFFFF));
  s.canvas.disk(tip, s.px(6.5), kProxyInk);
  if (!(peak_ > 0.0)) return;
  const double scale = longest / peak_;
  s.canvas.arrow(tip,
                 {tip.x + scale * glm::dot(now.force, camera.right),
                  tip.y - scale * glm::dot(now.force, camera.up)},
                 {kForceInk, s.px(3)}, s.px(12));
}

void SpacePath::drawBar(Sheet& s, double y) const {
  if (shown_.empty()) return;
  const double x = s.options.width - s.side + s.px(4);
  y += s.px(24);
  if (y + s.px(46) > s.options.height) return;
  s.canvas.text({x, y}, "path of the tip, by the force on the hand", s.font(15));
  const double step = s.px(300) / kShades;
  for (int i = 0; i < kShades; ++i) {
    s.canvas.rectangle(x + i * step, y + s.px(10), step + 1.0, s.px(12),
                       forceColor((i + 0.5) / kShades));
  }
  s.canvas.text({x, y + s.px(40)}, "0", s.font(13, kFaintInk));
  TextStyle end = s.font(13, kFaintInk);
  end.align = Align::kRight;
  s.canvas.text({x + s.px(300), y + s.px(40)}, formatNumber(peak_, 3) + " N", end);
}

Color forceColor(double share) {
  // From dark to bright, blue to yellow, so that the order is visible to red-green color-blind
  // readers too.
  constexpr Color kLow = rgb(0x1F3FA8);
  constexpr Color kMiddle = rgb(0xC3426B);
  constexpr Color kHigh = rgb(0xF5B70B);
  return share < 0.5 ? mixed(kLow, kMiddle, 2.0 * share) : mixed(kMiddle, kHigh, 2.0 * share - 1.0);
}

}  // namespace palpate::tools
