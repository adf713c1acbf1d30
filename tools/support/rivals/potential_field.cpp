#include <utility>

#include "support/rivals/rival_renderer.h"
#include "support/rivals/rivals.h"

namespace palpate::rivals {
namespace {

class PotentialField final : public RivalRenderer {
 public:
  explicit PotentialField(ScenePtr scene) : RivalRenderer(std::move(scene)) {}

 private:
  void forget() noexcept override {}

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    TickResult out = untouched(hip);
    for (const Solid& solid : solids()) {
      const FieldSample s = solid.field->sample(hip.position);
      if (!(s.value < 0.0)) continue;
      const Vec3 foot = hip.position - s.value * unitOr(s.gradient, Vec3(0.0));
      out.force += spring(hip, foot, solid, region()).force;
      out.proxy = foot;
      out.contact = true;
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<HapticRenderer> potentialField(ScenePtr scene) {
  return std::make_unique<PotentialField>(std::move(scene));
}

}  // namespace palpate::rivals
