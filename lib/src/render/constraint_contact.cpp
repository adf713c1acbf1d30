#include <algorithm>
#include <cmath>

#include "constraint_renderer.h"
#include "palpate/contact/crease.h"

// What the proxy feels where it is: the closed walls, the local problem, friction and rest.

namespace palpate {
namespace {

/// Walls within this many tolerances of the proxy take part in the local problem.
constexpr double kNear = 100.0;
/// The proxy has arrived when what is left to slide is this share of the depth: 6e-8 degree of the
/// force's direction.
constexpr double kSettled = 1e-9;
/// A slope below this share of the Lipschitz bound is not made up for in tolerances.
constexpr double kFlattest = 1e-3;
/// A slide ends within this share of where the kinetic cone holds it.
constexpr double kSticksWithin = 1e-6;
/// Share of the feature size that a crease's walls are asked for beside it: several times what fields take
/// differences over, and so short that what they bend over it is below every tolerance.
constexpr double kBeside = 1e-4;
/// Walls of one crease whose normals' cosine differs from 1 by less are one wall: 1.4e-3 rad.
constexpr double kSameWall = 1e-6;

}  // namespace

double ConstraintRenderer::Contact::load() const noexcept {
  Vec3 sum(0.0);
  for (const HeldWall& wall : walls()) sum += wall.multiplier * wall.normal;
  return glm::length(sum);
}

double ConstraintRenderer::reachOf(LeafId leaf) const noexcept {
  return kBeside * walker_.leaf(leaf).feature;
}

void ConstraintRenderer::findContact(const Vec3& hip) noexcept {
  Contact& c = contact_;
  c.planes = 0;
  c.count = 0;
  c.sliding_count = 0;
  walker_.forNear(kNear, [&](LeafId leaf, double value, const Facet& facet) {
    if (!facet.isClosed() || c.planes == kMaxPlanes) return;
    if (piece_count_ > 0 && feelPieces(leaf, facet)) return;
    const FieldJet& jet = walker_.jetHere(leaf);
    const double slope = glm::length(jet.gradient);
    if (!(slope > 0.0)) return;
    if (is_pressed_ && value > 0.0 && value <= walker_.tolerance(leaf)) value = 0.0;
    c.leaf[c.planes] = leaf;
    c.facet[c.planes] = facet;
    c.jet[c.planes] = jet;
    c.plane[c.planes] = {walker_.side(leaf) / slope * jet.gradient, value / slope};
    c.probe[c.planes] = Vec3(0.0);
    ++c.planes;
  });
  if (piece_count_ > 0) forgetPieces();
  const Vec3 wish = hip - walker_.position();
  const PlaneSolution solution = closestStep(wish, std::span(c.plane.data(), c.planes));
  c.step = solution.step;
  for (int i = 0; i < solution.count; ++i) {
    const auto k = static_cast<std::size_t>(solution.plane[static_cast<std::size_t>(i)]);
    const double multiplier = solution.multiplier[static_cast<std::size_t>(i)];
    if (!(multiplier > 0.0)) continue;
    HeldWall& wall = c.held[c.count];
    wall.field = walker_.leaf(c.leaf[k]).field.get();
    wall.side = walker_.side(c.leaf[k]);
    // As a distance, where the field rises less than its bound; but never down to rounding.
    const double share = glm::length(c.jet[k].gradient) / walker_.leaf(c.leaf[k]).lipschitz;
    wall.tolerance = walker_.tolerance(c.leaf[k]) * std::clamp(share, kFlattest, 1.0);
    wall.jet = c.jet[k];
    wall.normal = c.plane[k].normal;
    wall.multiplier = multiplier;
    wall.probe = c.probe[k];
    wall.reach = reachOf(c.leaf[k]);
    c.index[c.count] = k;
    ++c.count;
  }
  // Walls parallel to a held one are the same wall twice.
  for (std::size_t k = 0; k < c.planes; ++k) {
    c.slides[k] = false;
    for (const HeldWall& wall : c.walls()) {
      if (glm::dot(wall.normal, c.plane[k].normal) > 1.0 - 1e-6) {
        c.slides[k] = true;
        c.sliding[c.sliding_count++] = c.leaf[k];
        break;
      }
    }
  }
  c.pull = tangentialPart(wish, c.walls());
  c.lag = Vec3(0.0);
  if (c.count > 0) holdByFriction();
}

/// The walls that meet in a crease of `leaf` at the proxy, each asked for beside it. False (and they are
/// forgotten) where there is only one by now.
bool ConstraintRenderer::feelPieces(LeafId leaf, const Facet& facet) noexcept {
  Contact& c = contact_;
  const std::size_t first = c.planes;
  for (std::size_t i = 0; i < piece_count_; ++i) {
    Piece& piece = pieces_[i];
    if (piece.leaf != leaf) continue;
    HeldWall wall;
    piece.is_felt =
        c.planes < kMaxPlanes && wallBeside(*walker_.leaf(leaf).field, walker_.side(leaf),
                                            walker_.position(), piece.probe, reachOf(leaf), wall);
    for (std::size_t k = first; piece.is_felt && k < c.planes; ++k) {
      piece.is_felt = glm::dot(wall.normal, c.plane[k].normal) < 1.0 - kSameWall;
    }
    if (!piece.is_felt) continue;
    piece.normal = wall.normal;
    c.leaf[c.planes] = leaf;
    c.facet[c.planes] = facet;
    c.jet[c.planes] = wall.jet;
    c.plane[c.planes] = {wall.normal, wall.side * wall.jet.value / glm::length(wall.jet.gradient)};
    piece.plane = c.planes++;
  }
  if (c.planes - first >= 2) {
    double lowest = kInfinity;
    for (std::size_t k = first; k < c.planes; ++k) {
      lowest = std::min(lowest, c.plane[k].gap * glm::length(c.jet[k].gradient));
    }
    const double by =
        misfit(*walker_.leaf(leaf).field, walker_.side(leaf), walker_.position(), lowest);
    for (std::size_t k = first; k < c.planes; ++k) {
      c.plane[k].gap += by / glm::length(c.jet[k].gradient);
    }
    return true;
  }
  c.planes = first;
  for (std::size_t i = 0; i < piece_count_; ++i) {
    if (pieces_[i].leaf == leaf) pieces_[i].is_felt = false;
  }
  return false;
}

/// Keeps the pieces that were felt, and looks where they are from now on.
void ConstraintRenderer::forgetPieces() noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < piece_count_; ++i) {
    if (!pieces_[i].is_felt) continue;
    pieces_[kept] = pieces_[i];
    pieces_[kept++].is_felt = false;
  }
  piece_count_ = kept;
  aimProbes();
  for (std::size_t i = 0; i < piece_count_; ++i)
    contact_.probe[pieces_[i].plane] = pieces_[i].probe;
}

void ConstraintRenderer::aimProbes() noexcept {
  for (std::size_t i = 0; i < piece_count_; ++i) {
    std::array<Vec3, kMaxPieces> normals{};
    std::size_t count = 0;
    std::size_t own = 0;
    for (std::size_t j = 0; j < piece_count_; ++j) {
      if (pieces_[j].leaf != pieces_[i].leaf) continue;
      if (j == i) own = count;
      normals[count++] = pieces_[j].normal;
    }
    pieces_[i].probe = probeDirection(std::span(normals.data(), count), own);
  }
}

/// The cone: while it sticks the proxy may lag by static_ratio of the load, else it slides until it lags
/// by kinetic_ratio of it. Where stiffness varies, its own lean pulls at the proxy too: the cone is about where the
/// proxy would rest without friction. So the lean is felt through the lag, the same whether it sticks or slides.
void ConstraintRenderer::holdByFriction() noexcept {
  Contact& c = contact_;
  const Vec3& x = walker_.position();
  double static_ratio = 0.0;
  double kinetic_ratio = 0.0;
  for (std::size_t i = 0; i < c.count; ++i) {
    const Friction& own = wallMaterial(c.facet[c.index[i]]).friction;
    static_ratio = std::max(static_ratio, own.static_ratio.at(x));
    kinetic_ratio = std::max(kinetic_ratio, own.kinetic_ratio.at(x));
  }
  if (static_ratio <= 0.0 || walker_.isSealed()) {
    sticking_ = false;
    has_friction_ = false;
    return;
  }
  has_friction_ = true;
  kinetic_ratio = std::min(kinetic_ratio, static_ratio);
  const Vec3 rest = tangentialPart(lean_, c.walls());
  const Vec3 off = c.pull - rest;
  const double pull = glm::length(off);
  const double load = c.load();
  const double kinetic = kinetic_ratio * load;
  if (sticking_ && pull > static_ratio * load) sticking_ = false;
  // What slides sticks again when the hand no longer pulls it on, which shows when a tick begins: at the
  // end of its own slide it is always where the cone just holds it, and a hand that moves on would
  // feel a saw.
  if (!sticking_ && tick_begins_ && pull <= kinetic * (1.0 + kSticksWithin)) sticking_ = true;
  c.lag = sticking_ || pull <= kinetic ? c.pull : rest + off * (kinetic / pull);
  c.pull -= c.lag;
}

bool ConstraintRenderer::puncture() noexcept {
  const Contact& c = contact_;
  for (std::size_t i = 0; i < c.count; ++i) {
    const Facet& facet = c.facet[c.index[i]];
    if (!facet.opens) continue;
    const double elastic = springOf(i).force(c.held[i].multiplier);
    if (elastic >= facet.opens_at &&
        c.held[i].multiplier >= walker_.punctures().restOf(facet.port)) {
      walker_.cross(c.leaf[c.index[i]], facet, elastic);
      return true;
    }
  }
  return false;
}

/// The slide went over a rim: where a held wall is no wall any more, the pull that pressed the proxy against
/// it takes it through, here and now. Left to the next straight move, the facet just crossed could be
/// crossed back first, and the proxy would hang on the rim.
void ConstraintRenderer::letGoAtRim() noexcept {
  for (std::size_t i = 0; i < contact_.count; ++i) {
    const LeafId leaf = contact_.leaf[contact_.index[i]];
    const double value = walker_.leaf(leaf).field->value(walker_.position());
    if (std::fabs(value) > 2.0 * walker_.tolerance(leaf)) continue;  // in the air above it
    const Facet facet = walker_.facetAt(leaf);
    if (!facet.isClosed()) walker_.cross(leaf, facet);
  }
}

bool ConstraintRenderer::isSettled(const Vec3& hip) const noexcept {
  const double depth = glm::length(hip - walker_.position());
  return glm::length(contact_.pull) <= kSettled * depth && isOnWalls();
}

bool ConstraintRenderer::isOnWalls() const noexcept {
  for (std::size_t i = 0; i < contact_.count; ++i) {
    const std::size_t k = contact_.index[i];
    const double slack =
        walker_.tolerance(contact_.leaf[k]) / walker_.leaf(contact_.leaf[k]).lipschitz;
    if (std::fabs(contact_.plane[k].gap) > 2.0 * slack) return false;
  }
  return true;
}

}  // namespace palpate
