#include <utility>

#include "support/rivals/rival_renderer.h"
#include "support/rivals/rivals.h"

namespace palpate::rivals {
namespace {

class ClosestPoint final : public RivalRenderer {
 public:
  explicit ClosestPoint(ScenePtr scene) : RivalRenderer(std::move(scene)) {}

 private:
  void forget() noexcept override {}

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    const Solid* best = nullptr;
    Vec3 nearest(0.0);
    for (const Solid& solid : solids()) {
      if (!(solid.field->value(hip.position) < 0.0)) continue;
      const Vec3 foot = downTheGradient(*solid.field, hip.position);
      if (isCovered(foot, solid)) continue;
      if (best != nullptr &&
          glm::distance(foot, hip.position) >= glm::distance(nearest, hip.position)) {
        continue;
      }
      best = &solid;
      nearest = foot;
    }
    if (best == nullptr) {
      best = deepestAt(hip.position);
      if (best == nullptr) return untouched(hip);
      nearest = downTheGradient(*best->field, hip.position);
    }
    return spring(hip, nearest, *best, region());
  }

  /// True if the foot is inside another solid: then it is not on the surface of the whole.
  [[nodiscard]] bool isCovered(const Vec3& foot, const Solid& own) const noexcept {
    for (const Solid& other : solids()) {
      if (&other != &own && other.field->value(foot) < -1e-9) return true;
    }
    return false;
  }
};

}  // namespace

std::unique_ptr<HapticRenderer> closestPoint(ScenePtr scene) {
  return std::make_unique<ClosestPoint>(std::move(scene));
}

}  // namespace palpate::rivals
