#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/edges.h"
#include "bake/solid.h"
#include "mesh/edge_cells.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

/// [voxels] Up to this distance from a sharp edge the triangles answer. A grid's spline has full
/// accuracy farther than four voxels from an edge. Over the next voxel the triangles' answer blends
/// into the grid's.
constexpr double kExact = 4.0;
constexpr double kReach = 5.0;
/// [voxels] A grid rounds an edge off by less than this: a triangle farther from the grid's surface
/// is not part of the surface.
constexpr double kMostRounding = 2.0;
/// [voxels] The same for places farther than kMostRounding from every sharp edge, where the grid is
/// far more accurate.
constexpr double kMostOff = 0.5;

/// [voxels] Nearer to an edge or corner than this, the Hessian is taken as 0.
constexpr double kCreep = 0.1;

struct Surface {
  std::vector<Vec3> vertices;
  std::vector<MeshTriangle> triangles;
  std::vector<Vec3> normals;  ///< for each triangle
  /// For each triangle: at each side the mean normal of both triangles
  std::vector<std::array<Vec3, 3>> side_normals;
  std::vector<Vec3> corner_normals;  ///< for each vertex: weighted by angle
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

  /// Calls tell() with places [m] on triangles, within the range where triangles answer, that are
  /// not on the surface of the solid but on walls inside it.
  template <typename Tell>
  void forInnerWalls(const Tell& tell) const {
    for (const MeshTriangle& t : surface_.triangles) {
      pollStop();
      // The places lie in rows along the longest side, so that the number of places for a needle
      // depends only on its length.
      std::size_t apex = 0;
      for (std::size_t n = 1; n < 3; ++n) {
        if (glm::length(sideOpposite(t, n)) > glm::length(sideOpposite(t, apex))) apex = n;
      }
      const Vec3& top = surface_.vertices[t[apex]];
      const Vec3 down = surface_.vertices[t[(apex + 1) % 3]] - top;
      const Vec3 base = sideOpposite(t, apex);
      const double length = glm::length(base);
      const double height = length > 0.0 ? glm::length(glm::cross(down, base)) / length : 0.0;
      const int rows = stepsOf(height);
      for (int i = 0; i <= rows; ++i) {
        const double share = static_cast<double>(i) / rows;
        const int places = stepsOf(share * length);
        for (int j = 0; j <= places; ++j) {
          const Vec3 p = top + share * (down + (static_cast<double>(j) / places) * base);
          const double to_edge = edgeNear(p).distance;
          if (to_edge >= kReach * voxel_) continue;
          const double most = to_edge < kMostRounding * voxel_ ? kMostRounding : kMostOff;
          const FieldSample here = baked_->sample(p);
          if (!here.in_band || std::abs(here.value) > most * voxel_) tell(p);
        }
      }
    }
  }

  /// Numbers of the sharp edges within reach of a place.
  template <typename Tell>
  void forEdgesNear(const Vec3& p, const Tell& tell) const {
    for (const std::uint32_t edge : cells_.at(p).edges) {
      const auto& [a, b] = surface_.sharp[edge];
      const Vec3 way = p - nearestOf(surface_.vertices[a], surface_.vertices[b], p);
      if (glm::length(way) < kReach * voxel_) tell(edge);
    }
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return baked_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return baked_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return baked_->lipschitzDomain(); }
  [[nodiscard]] double featureSize() const noexcept override { return baked_->featureSize(); }

 private:
  struct Share {
    double weight = 0.0;  ///< weight of the triangles' answer
    Vec3 gradient{0.0};   ///< [1/m] gradient of the weight
    std::span<const std::uint32_t> triangles;
  };
  struct Exact {
    double value = 0.0;
    Vec3 gradient{0.0};
    Mat3 hessian{0.0};
  };

  /// [m] The side opposite to a corner, from the next corner to the one after.
  [[nodiscard]] Vec3 sideOpposite(const MeshTriangle& t, std::size_t corner) const noexcept {
    return surface_.vertices[t[(corner + 2) % 3]] - surface_.vertices[t[(corner + 1) % 3]];
  }
  /// The number of steps of at most a voxel that cover this length.
  [[nodiscard]] int stepsOf(double way) const noexcept {
    return std::max(1, static_cast<int>(std::ceil(way / voxel_)));
  }

  struct EdgeNear {
    Vec3 place{0.0};        ///< nearest point of a sharp edge
    double distance = 0.0;  ///< [m] kReach if none is nearer
    std::span<const std::uint32_t> triangles;
  };
  [[nodiscard]] EdgeNear edgeNear(const Vec3& p) const noexcept {
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
    return {nearest, std::sqrt(least), lists.triangles};
  }

  [[nodiscard]] Share shareAt(const Vec3& p, bool in_band) const noexcept {
    if (!in_band) return {};
    const EdgeNear edge = edgeNear(p);
    const double t = (kReach * voxel_ - edge.distance) / ((kReach - kExact) * voxel_);
    if (t >= 1.0) return {1.0, Vec3(0.0), edge.triangles};
    if (!(t > 0.0)) return {};
    // 3 t^2 - 2 t^3, and its gradient, which points towards the edge.
    return {t * t * (3.0 - 2.0 * t),
            -6.0 * t * (1.0 - t) / ((kReach - kExact) * voxel_) * (p - edge.place) / edge.distance,
            edge.triangles};
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
    // Next to an edge the curvature is extreme. A slide ends where the normal has turned by half a
    // radian, so that it would only creep over the edge; with zero curvature it crosses the edge
    // and is projected back.
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

/// Turns each part the way it counts in the baked solid (a part that is inside out is still solid,
/// a part turned against the one around it is a cavity), and drops parts that are walls inside the
/// solid. Vertices are in meters.
void keepSurface(Solid& solid, const Field& baked, double voxel) {
  std::vector<double> outward(solid.parts.size(), 0.0);
  std::vector<bool> is_surface(solid.parts.size(), false);
  const auto is_on_surface = [&](const Vec3& p) {
    const FieldSample here = baked.sample(p);
    return here.in_band && std::abs(here.value) <= kMostRounding * voxel;
  };
  const auto middle_of = [&](const MeshTriangle& t) {
    return (solid.vertices[t[0]] + solid.vertices[t[1]] + solid.vertices[t[2]]) / 3.0;
  };
  for (std::size_t n = 0; n < solid.triangles.size(); ++n) {
    const MeshTriangle& t = solid.triangles[n];
    const Vec3& a = solid.vertices[t[0]];
    const Vec3 twice_area = glm::cross(solid.vertices[t[1]] - a, solid.vertices[t[2]] - a);
    const Vec3 step = voxel * unitOr(twice_area, Vec3(0.0));
    const Vec3 middle = middle_of(t);
    const std::uint32_t part = solid.part_of[n];
    if (is_on_surface(middle) || is_on_surface(a)) {
      is_surface[part] = true;
      outward[part] +=
          glm::length(twice_area) * (baked.value(middle + step) - baked.value(middle - step));
    }
  }
  std::vector<MeshTriangle> kept;
  for (std::size_t n = 0; n < solid.triangles.size(); ++n) {
    if (!is_surface[solid.part_of[n]]) continue;
    MeshTriangle t = solid.triangles[n];
    if (outward[solid.part_of[n]] < 0.0) std::swap(t[1], t[2]);
    kept.push_back(t);
  }
  solid.triangles = std::move(kept);
}

Surface surfaceOf(Solid&& solid, double angle) {
  Surface surface;
  surface.vertices = std::move(solid.vertices);
  surface.triangles = std::move(solid.triangles);
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

std::vector<std::array<std::uint32_t, 2>> without(
    const std::vector<std::array<std::uint32_t, 2>>& edges, const std::vector<bool>& is_left) {
  std::vector<std::array<std::uint32_t, 2>> kept;
  for (std::size_t n = 0; n < edges.size(); ++n) {
    if (!is_left[n]) kept.push_back(edges[n]);
  }
  return kept;
}

}  // namespace

SharpField withSharpEdges(FieldPtr baked, const Mesh& mesh, double angle, double voxel) {
  if (!baked || !(angle >= 0.0 && angle <= std::numbers::pi) || !(voxel > 0.0)) {
    throw inputError("mesh.sharp",
                     "sharp edges need a field, an angle from 0 to 180 degrees and a "
                     "voxel size of more than 0");
  }
  // In voxels, because makeSolid() judges openings in voxels.
  Solid solid = makeSolid(mesh, voxel, MeshSign::kVote);
  if (!solid.was_closed) {
    throw inputError("mesh.sharp_open",
                     "exact triangles at sharp edges need a closed mesh whose triangles all face "
                     "outwards, or all inwards",
                     "repair it in a mesh editor; or leave sharp edges to the grid", mesh.source);
  }
  for (Vec3& v : solid.vertices) v *= voxel;
  keepSurface(solid, *baked, voxel);
  Surface surface = surfaceOf(std::move(solid), angle);
  SharpField made;
  made.edges = surface.sharp.size();
  while (!surface.sharp.empty()) {
    auto sharp = std::make_shared<SharpEdges>(baked, surface, voxel);
    std::vector<bool> is_left(surface.sharp.size(), false);
    bool is_sound = true;
    sharp->forInnerWalls([&](const Vec3& p) {
      if (is_sound && made.left_to_grid == 0) made.place = p;
      is_sound = false;
      sharp->forEdgesNear(p, [&](std::uint32_t edge) { is_left[edge] = true; });
    });
    if (is_sound) {
      made.field = std::move(sharp);
      return made;
    }
    surface.sharp = without(surface.sharp, is_left);
    made.left_to_grid = made.edges - surface.sharp.size();
  }
  if (made.left_to_grid > 0) {
    throw inputError("mesh.sharp_inner",
                     "beside every sharp edge, for example at " + eachInMillimeters(made.place) +
                         ", lies a wall that is not on the surface of the solid: parts overlap "
                         "there, or the grid has lost it",
                     "make the mesh one solid in a mesh editor; or leave sharp edges to the grid",
                     mesh.source);
  }
  made.field = std::move(baked);
  return made;
}

}  // namespace palpate::vdb
