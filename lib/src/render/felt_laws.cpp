#include <algorithm>
#include <array>

#include "felt_walls.h"
#include "palpate/contact/contact_patch.h"

// The force law of a wall at one place, alone and together with others on the same surface.

namespace palpate {

MaterialMap::Sample FeltWalls::stiffness(LeafId leaf, const Facet& facet, const HeldWall& held,
                                         const Vec3& x) noexcept {
  const Material& wall = material(facet);
  if (wall.composite.radius > 0.0 && facet.beyond != walker_.region()) {
    return beneath_.stiffness(leaf, x, held, facet, wall);
  }
  return wall.stiffness.sample(x);
}

SharedWall FeltWalls::felt(LeafId leaf, const Facet& facet, const HeldWall& held, const Vec3& x,
                           SmoothedField& smoothed) noexcept {
  SharedWall out;
  const Material& wall = material(facet);
  MaterialMap::Sample linear;
  const double contrast = contrast_[static_cast<std::size_t>(facet.material)];
  if (contrast < kInfinity) {
    const PatchSample patch = overPatch(wall.stiffness, x, press_, contrast);
    linear = {patch.value, patch.by_place};
    out.stiffness_press = patch.by_press;
  } else {
    linear = stiffness(leaf, facet, held, x);
  }
  const MaterialMap::Sample stiffening = wall.curve.stiffening.sample(x);
  out.law.spring = {linear.value, stiffening.value, wall.curve.exponent, wall.curve.reference};
  out.stiffness_rise = linear.gradient;
  out.stiffening_rise = stiffening.gradient;
  if (wall.texture.wavelength > 0.0) {
    const FeltHeight bumps = textureHeight(wall.texture, x);
    out.law.height = bumps.value;
    out.law.held = kHeldTexture;
    out.law.reach = reach_[static_cast<std::size_t>(facet.material)];
    out.height_rise = bumps.gradient;
  }
  if (wall.shading > 0.0) {
    // Smooth the whole solid that the wall bounds, not the leaf, which may be one of its facets.
    const RegionId here = walker_.region();
    const Field* solid = held.field;
    double side = held.side;
    if (here != facet.beyond) {
      const RegionId inner = std::max(here, facet.beyond);
      solid = scene_.regions()[inner].field.get();
      side = here == inner ? -1.0 : 1.0;
    }
    const FeltHeight smooth = smoothed.at(*solid, wall.shading, x);
    out.law.height -= side * smooth.value;
    out.law.held = kHeldShading;
    out.law.reach = kInfinity;
    out.height_rise -= side * smooth.gradient;
  }
  for (Vec3* rise : {&out.stiffness_rise, &out.stiffening_rise, &out.height_rise}) {
    *rise = byProxy(held, *rise);
  }
  return out;
}

/// Turns `rise`, a gradient over the place on a wall, into the gradient by the proxy's place: the
/// proxy's foot point moves with the proxy, but stays on the wall.
Vec3 FeltWalls::byProxy(const HeldWall& held, const Vec3& rise) const noexcept {
  if (rise == Vec3(0.0)) return rise;
  const Vec3 along = rise - glm::dot(rise, held.normal) * held.normal;
  const double slope = glm::length(held.jet.gradient);
  if (!(slope > 0.0)) return along;
  // The derivative of footOn(): the normal turns as the proxy moves.
  const Vec3 turn = (held.jet.value / (slope * slope)) * (held.jet.hessian * along);
  return along - (turn - glm::dot(turn, held.normal) * held.normal);
}

/// Walls of one kind feel the same unless the regions behind them matter and differ.
bool FeltWalls::feelsAlike(const Facet& a, const Facet& b) const noexcept {
  const auto kind = [&](const Facet& facet) {
    return kind_[static_cast<std::size_t>(facet.material)];
  };
  if (kind(a) != kind(b)) return false;
  const Material& own = material(a);
  return a.beyond == b.beyond || (!(own.composite.radius > 0.0) && !(own.shading > 0.0));
}

SharedWalls FeltWalls::shared(LeafId leaf, const Facet& facet, const HeldWall& held, const Vec3& x,
                              SmoothedField& smoothed) noexcept {
  SharedWalls out;
  const std::span<const Seams::Part> parts = seams_.at(leaf, held, x, press_);
  std::array<bool, Seams::kMostParts> is_told{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (is_told[i]) continue;
    Seams::Part all = parts[i];
    bool is_only = i == 0;
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      if (!feelsAlike(all.facet, parts[k].facet)) {
        is_only = false;
        continue;
      }
      is_told[k] = true;
      all.share += parts[k].share;
      all.by_place += parts[k].by_place;
      all.by_press += parts[k].by_press;
    }
    if (is_only) break;
    out.add(felt(leaf, all.facet, held, x, smoothed), all.share, all.by_place, all.by_press);
  }
  if (out.count() == 0) out.add(felt(leaf, facet, held, x, smoothed));
  return out;
}

/// The point of the wall that the proxy would press: the wall need not hold the proxy now.
Vec3 FeltWalls::footOn(const HeldWall& held) const noexcept {
  const double slope = glm::length(held.jet.gradient);
  const double off = slope > 0.0 ? held.side * held.jet.value / slope : 0.0;
  return walker_.position() - off * held.normal;
}

void FeltWalls::setLaw(Group& group, SmoothedField& smoothed) noexcept {
  const Near& wall = group.wall[0];
  group.law = shared(wall.leaf, wall.facet, wall.held, footOn(wall.held), smoothed);
}

/// Whether walls of other kinds lie beside this one, within the patch of the press.
bool FeltWalls::isShared(const Near& wall) noexcept {
  const std::span<const Seams::Part> parts =
      seams_.at(wall.leaf, wall.held, footOn(wall.held), press_);
  return std::any_of(parts.begin(), parts.end(), [&](const Seams::Part& each) {
    return !feelsAlike(each.facet, parts[0].facet);
  });
}

}  // namespace palpate
