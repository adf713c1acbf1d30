#include <algorithm>
#include <cmath>
#include <utility>

#include "support/rivals/rival_renderer.h"
#include "support/rivals/rivals.h"

namespace palpate::rivals {
namespace {

class SlowPlaneRenderer final : public RivalRenderer {
 public:
  SlowPlaneRenderer(ScenePtr scene, const SlowPlane& settings)
      : RivalRenderer(std::move(scene)), settings_(settings) {}

 private:
  void forget() noexcept override { felt_ = nullptr; }

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    age_ += hip.dt;
    // Times are sums of periods: the tolerance of half a period makes rounding irrelevant.
    if (felt_ == nullptr || age_ + 0.5 * hip.dt >= settings_.period) renew(hip.position);
    const double late =
        settings_.recovery > 0.0 ? late_ * std::max(0.0, 1.0 - age_ / settings_.recovery) : 0.0;
    const double depth = glm::dot(normal_, point_ - hip.position) - late;
    if (!(depth > 0.0)) return untouched(hip);
    return spring(hip, hip.position + depth * normal_, *felt_, region());
  }

  void renew(const Vec3& p) noexcept {
    const double before = felt_ != nullptr ? glm::dot(normal_, point_ - p) : 0.0;
    const bool was_felt = felt_ != nullptr;
    felt_ = &*std::min_element(
        solids().begin(), solids().end(),
        [&](const Solid& a, const Solid& b) { return a.field->value(p) < b.field->value(p); });
    point_ = downTheGradient(*felt_->field, p);
    normal_ = unitOr(felt_->field->sample(point_).gradient, Vec3(0.0));
    // How much deeper the probe is behind the new plane than it was behind the old one.
    late_ = was_felt ? glm::dot(normal_, point_ - p) - std::max(0.0, before) : 0.0;
    age_ = 0.0;
  }

  SlowPlane settings_;
  const Solid* felt_ = nullptr;
  Vec3 point_{0.0, 0.0, 0.0};   ///< [m] on the plane
  Vec3 normal_{0.0, 0.0, 0.0};  ///< [-]
  double late_ = 0.0;           ///< [m]
  double age_ = 0.0;            ///< [s]
};

}  // namespace

std::unique_ptr<HapticRenderer> slowPlane(ScenePtr scene, const SlowPlane& settings) {
  return std::make_unique<SlowPlaneRenderer>(std::move(scene), settings);
}

}  // namespace palpate::rivals
