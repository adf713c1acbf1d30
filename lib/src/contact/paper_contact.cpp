#include "palpate/contact/paper_contact.h"

#include <cmath>

namespace palpate {
namespace {

constexpr int kMaxDescent = 32;

/// -alpha S N / |N| or -alpha S N / (N.N); zero where there is no gradient.
Vec3 nudge(const PaperSurface& surface, const FieldSample& s) noexcept {
  const double square = glm::dot(s.gradient, s.gradient);
  if (!(square > 0.0)) return Vec3(0.0);
  const double scale = surface.newton_form ? square : std::sqrt(square);
  return -(surface.alpha * s.value / scale) * s.gradient;
}

Vec3 ontoNormalLine(const Vec3& point, const Vec3& normal, const Vec3& probe) noexcept {
  const double square = glm::dot(normal, normal);
  if (!(square > 0.0)) return probe;
  return point + normal * (glm::dot(normal, probe - point) / square);
}

Vec3 bisect(const PaperSurface& surface, Vec3 outside, Vec3 inside) noexcept {
  Vec3 middle = 0.5 * (outside + inside);
  for (int i = 0; i < surface.max_halvings; ++i) {
    const double value = surface.side * surface.field->value(middle);
    if (std::fabs(value) < surface.epsilon) break;
    (value > 0.0 ? outside : inside) = middle;
    middle = 0.5 * (outside + inside);
  }
  return middle;
}

/// Steps 2 and 3 of Algorithm I, starting at the point on the surface.
PaperContact contactAt(const PaperSurface& surface, const Vec3& point, const Vec3& probe) noexcept {
  const FieldSample s = surface.at(point);
  PaperContact out{point, ontoNormalLine(point, s.gradient, probe)};
  if (s.value < 0.0) out.surface_point += nudge(surface, s);
  return out;
}

}  // namespace

FieldSample PaperSurface::at(const Vec3& p) const noexcept {
  FieldSample s = field->sample(p);
  s.value *= side;
  s.gradient *= side;
  return s;
}

PaperContact firstContact(const PaperSurface& surface, const Vec3& outside,
                          const Vec3& probe) noexcept {
  if (surface.at(outside).value > 0.0) {
    return contactAt(surface, bisect(surface, outside, probe), probe);
  }
  Vec3 point = probe;
  for (int i = 0; i < kMaxDescent; ++i) {
    const FieldSample s = surface.at(point);
    const double square = glm::dot(s.gradient, s.gradient);
    if (std::fabs(s.value) < surface.epsilon || !(square > 0.0)) break;
    point -= s.gradient * (s.value / square);
  }
  return contactAt(surface, point, probe);
}

PaperContact trackContact(const PaperSurface& surface, const PaperContact& last,
                          const Vec3& last_probe, const Vec3& probe) noexcept {
  const FieldSample s = surface.at(last.surface_point);
  const double square = glm::dot(s.gradient, s.gradient);
  const Vec3 motion = probe - last_probe;
  Vec3 along = motion;
  if (square > 0.0) along -= s.gradient * (glm::dot(s.gradient, motion) / square);

  PaperContact out;
  out.surface_point = last.surface_point + along + nudge(surface, s);
  const FieldSample now = surface.at(out.surface_point);
  out.interaction_point = ontoNormalLine(out.surface_point, now.gradient, probe);
  if (now.value > surface.epsilon) {
    const bool bracketed = surface.at(out.interaction_point).value <= 0.0;
    const Vec3 end = bracketed ? out.interaction_point : probe;
    return contactAt(surface, bisect(surface, out.surface_point, end), probe);
  }
  return out;
}

}  // namespace palpate
