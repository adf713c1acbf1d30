// The search of lost_plates.h from the triangles of a mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "bake/lost_plates.h"
#include "bake/solid_inside.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

/// [voxels] Depths that are looked at first: where the grid is negative at all of them it has no hole. Its values
/// in a plate are least in the middle, so that a hole shows at the next of them too.
constexpr std::array<double, 3> kFirstDepths{0.2, 0.5, 0.8};
/// [voxels] A way down along a direction that is known no better ends at its beginning.
constexpr double kHair = 1e-4;

/// Cosine between the way down and the wall opposite: others are the two sides of an edge.
constexpr double kOpposite = 0.7;

struct Place {
  Vec3 middle;  ///< [voxels]
  Vec3 in;      ///< across the plate
  double thickness;
};

Vec3 closestOn(const std::array<Vec3, 3>& t, const Vec3& p) noexcept {
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

/// How far along a ray a triangle is met, from either side; sides belong to it.
std::optional<double> meets(const std::array<Vec3, 3>& t, const Vec3& from,
                            const Vec3& along) noexcept {
  const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double steep = glm::dot(normal, along);
  if (steep == 0.0) return {};
  const double way = glm::dot(normal, t[0] - from) / steep;
  const Vec3 at = from + way * along;
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 side = t[(n + 1) % 3] - t[n];
    const double slack = 1e-9 * glm::dot(normal, normal);
    if (glm::dot(glm::cross(side, at - t[n]), normal) < -slack) return {};
  }
  return way;
}

/// Looks at the grid of one thread.
class Search {
 public:
  Search(const BakedMesh& mesh, const LevelSet& grid, const BakePlan& plan)
      : mesh_(mesh),
        values_(grid.impl().grid->tree()),
        voxels_per_unit_(plan.metres_per_unit / plan.voxel) {}

  void in(std::size_t number, std::vector<Place>& places) const {
    const Leaf* const leaf = values_.probeConstLeaf(mesh_.bins.origin(number));
    if (leaf == nullptr) return;
    for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
      if (std::fabs(*voxel * voxels_per_unit_) >= kBySurface) continue;
      const openvdb::Coord at = voxel.getCoord();
      const Vec3 p(at.x(), at.y(), at.z());
      if (!isHeldBy(at)) look(p, *voxel < 0.0F, mesh_.bins.triangles(number), places);
    }
  }

 private:
  [[nodiscard]] double voxelAt(const openvdb::Coord& at) const {
    return values_.getValue(at) * voxels_per_unit_;
  }

  /// [voxels] trilinear
  [[nodiscard]] double valueAt(const Vec3& p) const {
    const Vec3 low = glm::floor(p);
    const openvdb::Coord at(static_cast<int>(low.x), static_cast<int>(low.y),
                            static_cast<int>(low.z));
    const auto along_z = [&](int x, int y) {
      const openvdb::Coord begin = at.offsetBy(x, y, 0);
      return glm::mix(voxelAt(begin), voxelAt(begin.offsetBy(0, 0, 1)), p.z - low.z);
    };
    return glm::mix(glm::mix(along_z(0, 0), along_z(0, 1), p.y - low.y),
                    glm::mix(along_z(1, 0), along_z(1, 1), p.y - low.y), p.x - low.x);
  }

  /// Whether the grid alone goes down from a voxel as into a thick part.
  [[nodiscard]] bool isHeldBy(const openvdb::Coord& at) const {
    const auto slope = [&](int x, int y, int z) {
      return 0.5 * (voxelAt(at.offsetBy(x, y, z)) - voxelAt(at.offsetBy(-x, -y, -z)));
    };
    const Vec3 p(at.x(), at.y(), at.z());
    const Vec3 gradient(slope(1, 0, 0), slope(0, 1, 0), slope(0, 0, 1));
    const double length = glm::length(gradient);
    if (!(length > 0.7)) return false;
    const Vec3 in = -gradient / length;
    const Vec3 foot = p + voxelAt(at) * in;
    return std::all_of(kFirstDepths.begin(), kFirstDepths.end(),
                       [&](double depth) { return valueAt(foot + depth * in) < 0.0; });
  }

  [[nodiscard]] std::array<Vec3, 3> cornersOf(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.walls.triangles[triangle];
    return {mesh_.walls.vertices[a], mesh_.walls.vertices[b], mesh_.walls.vertices[c]};
  }

  void look(const Vec3& p, bool is_inside, std::span<const std::uint32_t> triangles,
            std::vector<Place>& places) const {
    double least = kInfinity;
    Vec3 foot = p;
    std::uint32_t nearest = triangles.front();
    for (const std::uint32_t triangle : triangles) {
      const Vec3 at = closestOn(cornersOf(triangle), p);
      const double here = glm::dot(p - at, p - at);
      if (here >= least) continue;
      least = here;
      foot = at;
      nearest = triangle;
    }
    const double distance = std::sqrt(least);
    if (distance > kHair) {
      goDown(foot, (is_inside ? p - foot : foot - p) / distance, triangles, places);
      return;
    }
    const std::array<Vec3, 3> t = cornersOf(nearest);
    const Vec3 normal = unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), Vec3(0.0, 0.0, 1.0));
    goDown(foot, normal, triangles, places);
    goDown(foot, -normal, triangles, places);
  }

  /// To the wall opposite, and by what the grid has in the middle.
  void goDown(const Vec3& foot, const Vec3& in, std::span<const std::uint32_t> triangles,
              std::vector<Place>& places) const {
    double thickness = kHeld;
    double opposite = 0.0;
    for (const std::uint32_t triangle : triangles) {
      const std::array<Vec3, 3> t = cornersOf(triangle);
      const auto way = meets(t, foot, in);
      if (!way || *way <= kHair || *way >= thickness) continue;
      thickness = *way;
      opposite = std::fabs(glm::dot(unitOr(glm::cross(t[1] - t[0], t[2] - t[0]), in), in));
    }
    if (opposite < kOpposite) return;
    const Vec3 middle = foot + 0.5 * thickness * in;
    if (valueAt(middle) >= 0.0) places.push_back({middle, in, thickness});
  }

  const BakedMesh& mesh_;
  openvdb::FloatGrid::ConstAccessor values_;
  double voxels_per_unit_;
};

/// Whether a place is in the solid, which goes on from there.
bool isPlate(const Place& place, const SolidInside& inside, WallCount& count) {
  if (!inside.at(place.middle, count)) return false;
  const Vec3 across = std::fabs(place.in.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 u = glm::normalize(glm::cross(place.in, across));
  const Vec3 v = glm::cross(place.in, u);
  // In steps, lest another part beyond a gap is taken for the same.
  constexpr int kSteps = 8;
  for (const Vec3& way : {u, -u, v, -v}) {
    for (int step = 1; step <= kSteps; ++step) {
      if (!inside.at(place.middle + kGoesOn * step / kSteps * way, count)) return false;
    }
  }
  return true;
}

}  // namespace

void refuseLostPlates(const BakedMesh& mesh, const LevelSet& grid, const BakePlan& plan,
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
    return;
  }
  const SolidInside inside(mesh.solid, mesh.columns);
  WallCount count = inside.counter();
  LostPlates all;
  for (const std::vector<Place>& list : places) {
    for (const Place& place : list) {
      if (isPlate(place, inside, count)) {
        all.add(place.middle * plan.voxel, place.thickness * plan.voxel);
      }
    }
  }
  all.refuse(plan, options);
}

}  // namespace palpate::vdb
