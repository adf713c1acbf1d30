#include "palpate/contact/shaft_slip.h"

#include <algorithm>
#include <cmath>

namespace palpate {

double ShaftSlip::step(const ShaftLaw& law, double length, double advance, double speed) noexcept {
  if (!(length > 0.0) || !(law.stiffness > 0.0)) {
    stretch_ = 0.0;
    length_ = std::max(length, 0.0);
    is_sliding_ = false;
    return 0.0;
  }
  if (length > length_) stretch_ *= length_ / length;
  length_ = length;
  stretch_ += advance;
  const bool inward = stretch_ > 0.0;
  const ShaftLaw::Way& way = inward ? law.in : law.out;
  const double kinetic_force = std::min(way.kinetic_force, way.static_force);
  const double turned = inward ? speed : -speed;
  // When the hand rests, creeps or turns around, the tissue sticks to the shaft again.
  if (is_sliding_ && (turned <= 0.0 || turned < law.stick_speed)) is_sliding_ = false;
  if (!is_sliding_ && law.stiffness * std::fabs(stretch_) > way.static_force) is_sliding_ = true;
  if (is_sliding_) {
    const double most = kinetic_force / law.stiffness;
    stretch_ = std::clamp(stretch_, -most, most);
  }
  double force = law.stiffness * stretch_;
  if (is_sliding_) force += way.damping * speed;
  return force * length;
}

}  // namespace palpate
