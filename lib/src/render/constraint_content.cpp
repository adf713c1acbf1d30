#include <algorithm>
#include <cmath>

#include "feel.h"

// The force of the contents on the hand.

namespace palpate {

double Feel::contentShare() noexcept {
  if (walker_.mouth() < 0) return 1.0;
  const auto mouth = static_cast<LeafId>(walker_.mouth());
  const double length = fade_.length(walker_.region(), mouth);
  const FieldSample s = walker_.leaf(mouth).field->sample(walker_.position());
  const double slope = s.in_band ? glm::length(s.gradient) : 1.0;
  const double behind = slope > 0.0 ? std::fabs(s.value) / slope : length;
  if (behind >= length) return 1.0;
  // The content fades in only behind a mouth that is open: behind a valve that has shut, and along
  // the wall beside the mouth, it is felt in full.
  const Facet::Kind kind = walker_.facetAt(mouth).kind;
  const bool is_open = kind == Facet::Kind::kOpen || kind == Facet::Kind::kAbsent;
  return is_open ? behind / length : 1.0;
}

/// The share of the content that is felt changes no faster than the hand moves, also where the
/// opening ends.
void Feel::fadeContent(const Vec3& hip) noexcept {
  const double share = contentShare();
  FadeState& fade = state_.fade;
  if (!state_.has_begun) {
    fade.share = share;
  } else {
    const int mouth = walker_.mouth();
    const double most = mouth < 0 ? 1.0
                                  : glm::length(hip - state_.hip) /
                                        fade_.length(walker_.region(), static_cast<LeafId>(mouth));
    if (walker_.region() != fade.region) fade.share = 0.0;
    fade.share = std::clamp(share, fade.share - most, fade.share + most);
  }
  fade.region = walker_.region();
}

}  // namespace palpate
