#include <utility>

#include "support/rivals/rival_renderer.h"
#include "support/rivals/rivals.h"

namespace palpate::rivals {
namespace {

class TangentTracking final : public RivalRenderer {
 public:
  explicit TangentTracking(ScenePtr scene) : RivalRenderer(std::move(scene)) {}

 private:
  void forget() noexcept override { touched_ = nullptr; }

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    if (touched_ == nullptr) {
      touched_ = deepestAt(hip.position);
      if (touched_ == nullptr) return untouched(hip);
      point_ = downTheGradient(*touched_->field, hip.position);
    } else {
      const Vec3 n = unitOr(touched_->field->sample(point_).gradient, Vec3(0.0));
      const Vec3 on_plane = hip.position + glm::dot(point_ - hip.position, n) * n;
      const FieldSample s = touched_->field->sample(on_plane);
      const double square = glm::dot(s.gradient, s.gradient);
      point_ = square > 0.0 ? on_plane - s.value / square * s.gradient : on_plane;
    }
    if (touched_->field->value(hip.position) >= 0.0) {
      touched_ = nullptr;
      return untouched(hip);
    }
    return spring(hip, point_, *touched_, region());
  }

  const Solid* touched_ = nullptr;
  Vec3 point_{0.0, 0.0, 0.0};  ///< [m] of contact
};

}  // namespace

std::unique_ptr<HapticRenderer> tangentTracking(ScenePtr scene) {
  return std::make_unique<TangentTracking>(std::move(scene));
}

}  // namespace palpate::rivals
