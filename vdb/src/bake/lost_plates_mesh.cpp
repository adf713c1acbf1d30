// The search of lost_plates.h, started from the triangles of a mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "bake/grid_values.h"
#include "bake/lost_wires.h"
#include "bake/mesh_solid.h"

namespace palpate::vdb {
namespace {

/// [voxels] Depths that are looked at first: where the grid is negative at all of them it has no
/// hole. Inside a plate its values are least in the middle, so that a hole also shows at the next
/// of these depths.
constexpr std::array<double, 3> kFirstDepths{0.2, 0.5, 0.8};
/// [voxels] Tolerance for a search along a direction that is not known more accurately.
constexpr double kHair = 1e-4;

/// Cosine between the search direction and the opposite wall's normal; with a smaller one the walls
/// are the two sides of an edge.
constexpr double kOpposite = 0.7;
/// The same for a wire, which may have three sides.
constexpr double kOppositeOfWire = 0.4;
/// [voxels] Places this near to a place that is not a wire are not wires either.
constexpr double kSamePlace = 0.5;

struct Place {
  Vec3 middle;  ///< [voxels]
  Vec3 in;      ///< across the plate
  double thickness;
  bool may_be_plate;
};

Vec3 closestOn(const Corners& t, const Vec3& p) noexcept {
  const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double square = glm::dot(normal, normal);
  bool over = square > 0.0;
  double least = kInfinity;
  Vec3 best = t[0];
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 side = t[(n + 1) % 3] - t[n];
    const double length = glm::dot(side, side);
    if (over && glm::dot(glm::cross(side, p - t[n]), normal) < 0.0) over = false;
    const double along =
        length > 0.0 ? std::clamp(glm::dot(side, p - t[n]) / length, 0.0, 1.0) : 0.0;
    const Vec3 at = t[n] + along * side;
    const double here = glm::dot(p - at, p - at);
    if (here < least) {
      least = here;
      best = at;
    }
  }
  return over ? p - glm::dot(p - t[0], normal) / square * normal : best;
}

/// Searches the grid; one object for each thread.
class Search {
 public:
  Search(const BakedMesh& mesh, const LevelSet& grid, const BakePlan& plan)
      : mesh_(mesh), values_(grid, plan) {}

  void in(std::size_t number, std::vector<Place>& places) const {
    const GridValues::Leaf* const leaf = values_.leafAt(mesh_.bins.origin(number));
    if (leaf == nullptr) return;
    for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
      if (std::fabs(values_.inVoxels(*voxel)) >= kBySurface) continue;
      const openvdb::Coord at = voxel.getCoord();
      const Vec3 p(at.x(), at.y(), at.z());
      if (!isHeldBy(at)) look(p, *voxel < 0.0F, mesh_.bins.triangles(number), places);
    }
  }

 private:
  /// Whether the grid's values below a voxel decrease as in a thick part, so that nothing is lost.
  [[nodiscard]] bool isHeldBy(const openvdb::Coord& at) const {
    const auto slope = [&](int x, int y, int z) {
      return 0.5 * (values_.at(at.offsetBy(x, y, z)) - values_.at(at.offsetBy(-x, -y, -z)));
    };
    const Vec3 p(at.x(), at.y(), at.z());
    const Vec3 gradient(slope(1, 0, 0), slope(0, 1, 0), slope(0, 0, 1));
    const double length = glm::length(gradient);
    if (!(length > 0.7)) return false;
    const Vec3 in = -gradient / length;
    const Vec3 foot = p + values_.at(at) * in;
    return std::all_of(kFirstDepths.begin(), kFirstDepths.end(),
                       [&](double depth) { return values_.at(foot + depth * in) < 0.0; });
  }

  void look(const Vec3& p, bool is_inside, std::span<const std::uint32_t> triangles,
            std::vector<Place>& places) const {
    double least = kInfinity;
    Vec3 foot = p;
    std::uint32_t nearest = triangles.front();
    for (const std::uint32_t triangle : triangles) {
      const Vec3 at = closestOn(cornersOf(mesh_.walls, triangle), p);
      const double here = glm::dot(p - at, p - at);
      if (here >= least) continue;
      least = here;
      foot = at;
      nearest = triangle;
    }
    const double distance = std::sqrt(least);
    if (distance > kHair) {
      const bool met =
          goDown(foot, (is_inside ? p - foot : foot - p) / distance, triangles, places);
      if (!met && !is_inside) goDownFromEdge(p, foot, distance, triangles, places);
      return;
    }
    const Corners t = cornersOf(mesh_.walls, nearest);
    const Vec3 normal = unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), Vec3(0.0, 0.0, 1.0));
    goDown(foot, normal, triangles, places);
    goDown(foot, -normal, triangles, places);
  }

  /// At an edge of less than a right angle, the normal of a wall does not always lead into the
  /// part; the direction halfway between the walls that meet there does. This finds wires of three
  /// sides.
  void goDownFromEdge(const Vec3& p, const Vec3& foot, double distance,
                      std::span<const std::uint32_t> triangles, std::vector<Place>& places) const {
    Vec3 sum(0.0);
    double most = 0.0;  // the normal most towards the voxel: its sign tells whether the normals
                        // point out of the part
    for (const std::uint32_t triangle : triangles) {
      const Corners t = cornersOf(mesh_.walls, triangle);
      if (glm::distance(closestOn(t, p), p) > distance + kHair) continue;
      const Vec3 normal = unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), Vec3(0.0));
      const double towards = glm::dot(normal, p - foot);
      if (std::fabs(towards) > std::fabs(most)) most = towards;
      sum += normal;
    }
    const Vec3 out = most < 0.0 ? -sum : sum;
    if (glm::length(out) > kHair) goDown(foot, -glm::normalize(out), triangles, places, true);
  }

  /// Follows `in` to the opposite wall, and checks the grid's value half-way; false if there is no
  /// such wall.
  bool goDown(const Vec3& foot, const Vec3& in, std::span<const std::uint32_t> triangles,
              std::vector<Place>& places, bool from_edge = false) const {
    double thickness = kHeld;
    double opposite = 0.0;
    for (const std::uint32_t triangle : triangles) {
      const Corners t = cornersOf(mesh_.walls, triangle);
      const auto way = wayTo(t, foot, in);
      if (!way || *way <= kHair || *way >= thickness) continue;
      thickness = *way;
      opposite = std::fabs(glm::dot(unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), in), in));
    }
    if (opposite < kOppositeOfWire) return false;
    const Vec3 middle = foot + 0.5 * thickness * in;
    if (values_.at(middle) >= 0.0) {
      places.push_back({middle, in, thickness, opposite >= kOpposite && !from_edge});
    }
    return true;
  }

  const BakedMesh& mesh_;
  GridValues values_;
};

/// Whether the solid goes on to all sides of a place in it.
bool isPlate(const Place& place, const MeshSolid& solid) {
  const Vec3 across = std::fabs(place.in.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 u = glm::normalize(glm::cross(place.in, across));
  const Vec3 v = glm::cross(place.in, u);
  // Several places on the way are checked, so that another part beyond a gap is not taken for the
  // same one.
  constexpr int kSteps = 8;
  for (const Vec3& way : {u, -u, v, -v}) {
    for (int step = 1; step <= kSteps; ++step) {
      if (!solid.isInside(place.middle + kGoesOn * step / kSteps * way)) return false;
    }
  }
  return true;
}

/// Returns every plate and at most one wire or crumb among the places of one leaf.
LostPlaces lostAmong(const std::vector<Place>& places, const MeshSolid& solid,
                     const BakePlan& plan) {
  LostPlaces lost;
  std::vector<Vec3> none;  // middles of places that are neither
  for (const Place& place : places) {
    if (!solid.isInside(place.middle)) continue;
    const auto add = [&](LostShape shape) {
      lost.add({place.middle * plan.voxel, place.thickness * plan.voxel, shape});
    };
    if (place.may_be_plate && isPlate(place, solid)) {
      add(LostShape::kPlate);
      continue;
    }
    if (!lost.empty() || std::any_of(none.begin(), none.end(), [&](const Vec3& other) {
          return glm::distance(other, place.middle) < kSamePlace;
        })) {
      continue;
    }
    if (const auto shape = ThinPart(solid).lostAt(place.middle, place.in)) {
      add(*shape);
    } else {
      none.push_back(place.middle);
    }
  }
  return lost;
}

}  // namespace

std::string refuseLostPlates(const BakedMesh& mesh, const LevelSet& grid, const BakePlan& plan,
                             const BakeOptions& options) {
  std::vector<std::vector<Place>> places(mesh.bins.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const Search search(mesh, grid, plan);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        if (mesh.faces_itself[i] != 0) search.in(i, places[i]);
                      }
                    });
  if (std::all_of(places.begin(), places.end(), [](const auto& list) { return list.empty(); })) {
    return {};
  }
  const SolidInside inside(mesh.solid, mesh.columns);
  std::vector<LostPlaces> found(places.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const GridValues values(grid, plan);
                      const MeshSolid solid(mesh, inside, values);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        found[i] = lostAmong(places[i], solid, plan);
                      }
                    });
  LostPlaces all;
  for (const LostPlaces& lost : found) all.add(lost);
  all.refusePlates(plan, options);
  return all.wiresAndCrumbs(plan);
}

}  // namespace palpate::vdb
