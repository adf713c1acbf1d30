#include "palpate/contact/shaft_channel.h"

namespace palpate {

Vec3 ShaftChannel::step(const ChannelLaw& law, double begin, double end,
                        const Vec3& direction) noexcept {
  if (!(end > begin) || !(begin >= 0.0)) {
    *this = {};
    return Vec3(0.0);
  }
  const double moment = (end * end * end - begin * begin * begin) / 3.0;
  if (moment > moment_) direction_ += (1.0 - moment_ / moment) * (direction - direction_);
  moment_ = moment;
  if (!(law.stiffness > 0.0)) {
    direction_ = direction;
    return Vec3(0.0);
  }
  Vec3 aside = direction_ - direction;
  const double load =
      law.stiffness * 0.5 * (begin + end) * glm::length(aside);  // [N/m] mean load per length
  if (load > law.strength) {
    aside *= law.strength / load;
    direction_ = direction + aside;
  }
  return law.stiffness * moment * (aside - glm::dot(aside, direction) * direction);
}

}  // namespace palpate
