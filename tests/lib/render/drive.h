#pragma once
// Shared by renderer tests: scenes from text, and a hand that moves the HIP tick by tick.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "folders/folders.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene_file.h"

namespace palpate::test {

inline ScenePtr sceneOf(const std::string& yaml) { return compile(parseScene(yaml, "test.yaml")); }

/// A scene of data/scenes.
inline ScenePtr sceneNamed(const std::string& name) {
  return compile(readScene(test::sourceFolder() + "/data/scenes/" + name + ".yaml"));
}

inline Vec3 mm(double x, double y, double z) { return {x * 1e-3, y * 1e-3, z * 1e-3}; }

/// The paper's container without friction and damping, so that closed forms hold: K = 1500 N/m,
/// Bv = 4 N s/m, a ball of 40 mm cut at z = 15 mm.
inline std::string containerText(const std::string& more = {}) {
  return R"(
palpate: 1
length: mm
fields:
  bowl: {sphere: {center: [0, 0, 0], radius: 40}}
  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}
materials: {glass: {stiffness: 1500 N/m}, syrup: {viscosity: 4 N.s/m}}
layers:
  - {name: liquid, inside: {intersection: [bowl, brim]}, content: syrup, wall: glass}
ports:
  - {name: mouth, between: [outside, liquid], on: brim}
)" + more;
}

/// One renderer, driven by positions; the velocity is the backward difference at 1 kHz, 0 at first.
class Drive {
 public:
  static constexpr double kTick = 1e-3;  // [s]

  explicit Drive(ScenePtr scene, RendererKind kind = RendererKind::kConstraint,
                 RendererSettings settings = {})
      : scene_(std::move(scene)) {
    settings.kind = kind;
    renderer_ = makeRenderer(scene_, settings);
  }

  TickResult to(const Vec3& hip) {
    const Vec3 velocity = started_ ? (hip - hip_) / kTick : Vec3(0.0);
    started_ = true;
    hip_ = hip;
    last_ = renderer_->update({hip, velocity});
    for (int i = 0; i < last_.event_count; ++i) {
      const PortId port = last_.events[static_cast<std::size_t>(i)];
      events_ += (events_.empty() ? "" : " ") + scene_->ports()[port].name;
    }
    return last_;
  }
  /// Straight to `hip` in steps of at most `step` [m], then one tick at rest.
  TickResult walk(const Vec3& hip, double step = 0.5e-3) {
    const Vec3 from = started_ ? hip_ : hip;
    const int n = std::max(1, static_cast<int>(std::ceil(glm::length(hip - from) / step)));
    for (int i = 1; i <= n; ++i) (void)to(from + (static_cast<double>(i) / n) * (hip - from));
    return to(hip);
  }
  /// Names of the ports passed since the last call.
  std::string events() { return std::exchange(events_, {}); }

  [[nodiscard]] std::string region() const { return scene_->regions()[last_.region].name; }
  [[nodiscard]] const TickResult& last() const { return last_; }
  [[nodiscard]] const Vec3& hip() const { return hip_; }
  [[nodiscard]] HapticRenderer& renderer() { return *renderer_; }
  [[nodiscard]] const Scene& scene() const { return *scene_; }

 private:
  ScenePtr scene_;
  std::unique_ptr<HapticRenderer> renderer_;
  Vec3 hip_{0.0};
  bool started_ = false;
  TickResult last_;
  std::string events_;
};

inline ::testing::AssertionResult isNear(const Vec3& a, const Vec3& b, double tolerance) {
  if (glm::length(a - b) <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", " << b.y << ", "
         << b.z << "), off by " << glm::length(a - b);
}

inline std::string kindName(const ::testing::TestParamInfo<RendererKind>& info) {
  return info.param == RendererKind::kPaper ? "paper" : "constraint";
}

}  // namespace palpate::test
