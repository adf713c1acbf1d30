#include "palpate/vdb/sharp_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/edges.h"
#include "bake/solid.h"
#include "mesh/edge_cells.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

/// [voxels] As near to a sharp edge the triangles answer; a grid's spline reaches 4.9 voxels and is at full accuracy
/// beyond four of an edge. Over the next voxel they hand over.
constexpr double kExact = 4.0;
constexpr double kReach = 5.0;
/// [voxels] The grid rounds an edge off by less: what is farther from its surface is none of it.
constexpr double kMostRounding = 2.0;

/// [voxels] Nearer to an edge or corner than that nothing is said to bend.
constexpr double kCreep = 0.1;

struct Surface {
  std::vector<Vec3> vertices;
  std::vector<MeshTriangle> triangles;
  std::vector<Vec3> normals;                      ///< of triangles
  std::vector<std::array<Vec3, 3>> side_normals;  ///< of triangles: the mean of both at each side
  std::vector<Vec3> corner_normals;               ///< of vertices: weighted by angle
  std::vector<std::array<std::uint32_t, 2>> sharp;
};

class SharpEdges final : public Field {
 public:
  SharpEdges(FieldPtr baked, Surface surface, double voxel)
      : baked_(std::move(baked)),
        surface_(std::move(surface)),
        cells_(surface_.vertices, surface_.triangles, surface_.sharp, kReach * voxel, 2.0 * voxel),
        voxel_(voxel),
        lipschitz_(std::max(1.0, baked_->lipschitz()) + 0.05) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample smooth = baked_->sample(p);
    const Share share = shareAt(p, smooth.in_band);
    if (!(share.weight > 0.0)) return smooth;
    const Exact exact = exactAt(p, share.triangles);
    const double w = share.weight;
    return {smooth.value + w * (exact.value - smooth.value),
            smooth.gradient + w * (exact.gradient - smooth.gradient) +
                (exact.value - smooth.value) * share.gradient,
            true};
  }

  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet smooth = baked_->jet(p);
    const Share share = shareAt(p, smooth.in_band);
    if (!(share.weight > 0.0)) return smooth;
    const Exact exact = exactAt(p, share.triangles);
    const double w = share.weight;
    smooth.gradient +=
        w * (exact.gradient - smooth.gradient) + (exact.value - smooth.value) * share.gradient;
    smooth.value += w * (exact.value - smooth.value);
    smooth.hessian = smooth.hessian * (1.0 - w) + exact.hessian * w;
    return smooth;
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return baked_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return baked_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return baked_->lipschitzDomain(); }
  [[nodiscard]] double featureSize() const noexcept override { return baked_->featureSize(); }

 private:
  struct Share {
    double weight = 0.0;  ///< of the triangles
    Vec3 gradient{0.0};   ///< [1/m]
    std::span<const std::uint32_t> triangles;
  };
  struct Exact {
    double value = 0.0;
    Vec3 gradient{0.0};
    Mat3 hessian{0.0};
  };

  [[nodiscard]] Share shareAt(const Vec3& p, bool in_band) const noexcept {
    if (!in_band) return {};
    const EdgeCells::Lists lists = cells_.at(p);
    double least = kReach * voxel_ * kReach * voxel_;
    Vec3 nearest(0.0);
    for (const std::uint32_t edge : lists.edges) {
      const auto& [a, b] = surface_.sharp[edge];
      const Vec3 at = nearestOf(surface_.vertices[a], surface_.vertices[b], p);
      const double square = glm::dot(p - at, p - at);
      if (square >= least) continue;
      least = square;
      nearest = at;
    }
    const double distance = std::sqrt(least);
    const double t = (kReach * voxel_ - distance) / ((kReach - kExact) * voxel_);
    if (t >= 1.0) return {1.0, Vec3(0.0), lists.triangles};
    if (!(t > 0.0)) return {};
    // 3 t^2 - 2 t^3, and its slope down along the way from the edge.
    return {t * t * (3.0 - 2.0 * t),
            -6.0 * t * (1.0 - t) / ((kReach - kExact) * voxel_) * (p - nearest) / distance,
            lists.triangles};
  }

  [[nodiscard]] Exact exactAt(const Vec3& p,
                              std::span<const std::uint32_t> triangles) const noexcept {
    NearestPoint best;
    std::uint32_t which = triangles.front();
    for (const std::uint32_t t : triangles) {
      const auto& [a, b, c] = surface_.triangles[t];
      const NearestPoint here =
          nearestOf(surface_.vertices[a], surface_.vertices[b], surface_.vertices[c], p);
      if (here.square >= best.square) continue;
      best = here;
      which = t;
    }
    const Vec3& face = surface_.normals[which];
    const auto feature = static_cast<std::size_t>(best.feature);
    const Vec3 outward = feature == 0 ? face
                         : feature < 4
                             ? surface_.side_normals[which][feature - 1]
                             : surface_.corner_normals[surface_.triangles[which][feature - 4]];
    const Vec3 way = p - best.point;
    const double sign = glm::dot(way, outward) < 0.0 ? -1.0 : 1.0;
    const double distance = std::sqrt(best.square);
    Exact out;
    out.value = sign * distance;
    if (feature == 0 || distance < 1e-9 * voxel_) {
      out.gradient = face;
      return out;
    }
    out.gradient = sign / distance * way;
    // By an edge the surface bends all at once. As a slide goes no farther than the normal turns by half a radian, it
    // would creep over the edge; taken for flat, it goes over it and is pulled back.
    if (distance < kCreep * voxel_) return out;
    const double bend = sign / distance;
    out.hessian = (Mat3(1.0) - outer(out.gradient, out.gradient)) * bend;
    if (feature < 4) {
      const MeshTriangle& t = surface_.triangles[which];
      const Vec3 along =
          unitOr(surface_.vertices[t[feature % 3]] - surface_.vertices[t[feature - 1]], Vec3(0.0));
      out.hessian = out.hessian - outer(along, along) * bend;
    }
    return out;
  }

  FieldPtr baked_;
  Surface surface_;
  EdgeCells cells_;
  double voxel_;
  double lipschitz_;
};

double angleAt(const Vec3& corner, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - corner;
  const Vec3 v = c - corner;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

Surface surfaceOf(Solid&& solid, double angle) {
  Surface surface;
  surface.vertices = std::move(solid.vertices);
  surface.triangles = std::move(solid.triangles);
  double volume = 0.0;
  for (const SolidPart& part : solid.parts) volume += part.volume;
  if (volume < 0.0) {
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  }
  surface.corner_normals.assign(surface.vertices.size(), Vec3(0.0));
  for (const auto& t : surface.triangles) {
    const Vec3& a = surface.vertices[t[0]];
    const Vec3& b = surface.vertices[t[1]];
    const Vec3& c = surface.vertices[t[2]];
    surface.normals.push_back(unitOr(glm::cross(b - a, c - a), Vec3(0.0)));
    surface.corner_normals[t[0]] += angleAt(a, b, c) * surface.normals.back();
    surface.corner_normals[t[1]] += angleAt(b, c, a) * surface.normals.back();
    surface.corner_normals[t[2]] += angleAt(c, a, b) * surface.normals.back();
  }
  surface.side_normals.resize(surface.triangles.size());
  const std::vector<Side> sides = sortedSides(surface.triangles);
  const double cosine = std::cos(angle);
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    Vec3 sum(0.0);
    for (std::size_t n = begin; n < end; ++n) sum += surface.normals[sides[n].triangle];
    for (std::size_t n = begin; n < end; ++n) {
      const MeshTriangle& t = surface.triangles[sides[n].triangle];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
        if (low == sides[n].low && high == sides[n].high) {
          surface.side_normals[sides[n].triangle][k] = sum;
        }
      }
    }
    const Vec3& first = surface.normals[sides[begin].triangle];
    const Vec3& last = surface.normals[sides[end - 1].triangle];
    if (glm::dot(first, last) < cosine)
      surface.sharp.push_back({sides[begin].low, sides[begin].high});
  });
  return surface;
}

/// Of triangles that have a corner on a sharp edge, corners and middles must lie on the grid's surface.
void requireSurface(const Field& baked, const Surface& surface, const Mesh& mesh, double voxel) {
  for (const auto& [a, b] : surface.sharp) {
    const Vec3 middle = 0.5 * (surface.vertices[a] + surface.vertices[b]);
    const FieldSample here = baked.sample(middle);
    if (here.in_band && std::abs(here.value) <= kMostRounding * voxel) continue;
    throw inputError("mesh.sharp_inner",
                     "an edge at " + placeText(middle, 1.0) +
                         " is not on the surface of the solid: parts overlap there, or the grid "
                         "has lost it",
                     "make the mesh one solid in a mesh editor; or leave sharp edges to the grid",
                     mesh.source);
  }
}

}  // namespace

FieldPtr withSharpEdges(FieldPtr baked, const Mesh& mesh, double angle, double voxel) {
  if (!baked || !(angle >= 0.0 && angle <= std::numbers::pi) || !(voxel > 0.0)) {
    throw inputError("mesh.sharp",
                     "sharp edges need a field, an angle from 0 to 180 degrees and a "
                     "voxel size of more than 0");
  }
  // In voxels, as what is open is judged by them.
  Solid solid = makeSolid(mesh, voxel, MeshSign::kVote);
  if (!solid.was_closed) {
    throw inputError("mesh.sharp_open",
                     "exact triangles by sharp edges need a mesh that is closed, with triangles "
                     "turned alike",
                     "mend it in a mesh editor; or leave sharp edges to the grid", mesh.source);
  }
  for (Vec3& v : solid.vertices) v *= voxel;
  Surface surface = surfaceOf(std::move(solid), angle);
  if (surface.sharp.empty()) return baked;
  requireSurface(*baked, surface, mesh, voxel);
  return std::make_shared<SharpEdges>(std::move(baked), std::move(surface), voxel);
}

}  // namespace palpate::vdb
