#include <array>
#include <utility>

#include "support/rivals/rival_renderer.h"
#include "support/rivals/rivals.h"

namespace palpate::rivals {
namespace {

/// A plane that the point may not go behind.
struct Plane {
  Vec3 point{0.0, 0.0, 0.0};   ///< [m]
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit
};

/// The point on up to three planes that is nearest to `p` [m]: Lagrange's conditions of min |x -
/// p|^2, solved plane by plane in an orthonormal basis of the normals.
Vec3 nearestOn(const std::array<Plane, 3>& planes, std::size_t count, const Vec3& p) noexcept {
  std::array<Vec3, 3> basis{};
  std::size_t rank = 0;
  Vec3 x = p;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 u = planes[i].normal;
    for (std::size_t k = 0; k < rank; ++k) u -= glm::dot(u, basis[k]) * basis[k];
    const double size = glm::length(u);
    if (size < 1e-6) continue;  // parallel to an earlier plane
    u /= size;
    // Moving along u keeps the earlier planes satisfied.
    x += glm::dot(planes[i].point - x, planes[i].normal) / size * u;
    basis[rank++] = u;
  }
  return x;
}

class GodObject : public RivalRenderer {
 public:
  GodObject(ScenePtr scene, TriangleMesh mesh)
      : RivalRenderer(std::move(scene)), facets_(std::move(mesh)) {}

 protected:
  [[nodiscard]] const Facets& facets() const noexcept { return facets_; }

  /// The new place of a point that is at `from` and is drawn towards `goal`; the facets that hold
  /// it are stored in `held_`.
  Vec3 draw(const Vec3& from, const Vec3& goal) noexcept {
    std::array<Plane, 3> planes{};
    count_ = 0;
    Vec3 to = goal;
    while (count_ < planes.size()) {
      const std::optional<Hit> hit = facets_.firstHit(from, to);
      if (!hit) return to;
      held_[count_] = hit->triangle;
      // The point stays a hair outside, so that it meets the facet again from there.
      planes[count_] = {facets_.cornerOf(hit->triangle) + kHair * facets_.normalOf(hit->triangle),
                        facets_.normalOf(hit->triangle)};
      ++count_;
      to = nearestOn(planes, count_, goal);
    }
    return facets_.firstHit(from, to) ? from : to;
  }
  [[nodiscard]] std::size_t heldBy() const noexcept { return count_; }
  [[nodiscard]] std::uint32_t facet(std::size_t n) const noexcept { return held_[n]; }

  Vec3 point_{0.0, 0.0, 0.0};  ///< [m]
  bool has_begun_ = false;

 private:
  static constexpr double kHair = 1e-9;  ///< [m]

  void forget() noexcept override { has_begun_ = false; }

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    if (!std::exchange(has_begun_, true)) point_ = hip.position;
    move(hip.position);
    if (count_ == 0) return untouched(hip);
    return spring(hip, point_, solids().front(), region());
  }

  virtual void move(const Vec3& hip) noexcept { point_ = draw(point_, hip); }

  Facets facets_;
  std::array<std::uint32_t, 3> held_{};
  std::size_t count_ = 0;
};

class ForceShading final : public GodObject {
 public:
  using GodObject::GodObject;

 private:
  void move(const Vec3& hip) noexcept override {
    const Vec3 plain = draw(point_, hip);
    if (heldBy() == 0) {
      point_ = plain;
      return;
    }
    // First move on planes through the point with the interpolated normals; then from there on the
    // true facets.
    std::array<Plane, 3> planes{};
    const std::size_t count = heldBy();
    for (std::size_t i = 0; i < count; ++i) {
      planes[i] = {point_, facets().shadedNormal(facet(i), point_)};
    }
    const Vec3 goal = nearestOn(planes, count, hip);
    point_ = draw(point_, below(goal, hip));
  }

  /// The goal, kept beneath the facet that held the point, so that contact ends only at the true
  /// surface.
  [[nodiscard]] Vec3 below(const Vec3& goal, const Vec3& hip) const noexcept {
    const Vec3& n = facets().normalOf(facet(0));
    const double depth = glm::dot(n, facets().cornerOf(facet(0)) - hip);
    const double left = glm::dot(n, facets().cornerOf(facet(0)) - goal);
    return left > 0.0 ? goal : goal + (left - depth) * n;
  }
};

}  // namespace

std::unique_ptr<HapticRenderer> godObject(ScenePtr scene, TriangleMesh mesh) {
  return std::make_unique<GodObject>(std::move(scene), std::move(mesh));
}

std::unique_ptr<HapticRenderer> forceShading(ScenePtr scene, TriangleMesh mesh) {
  return std::make_unique<ForceShading>(std::move(scene), std::move(mesh));
}

}  // namespace palpate::rivals
