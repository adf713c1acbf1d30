#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "bake/agreement.h"
#include "bake/bake_plan.h"
#include "bake/columns.h"
#include "bake/curved.h"
#include "bake/edges.h"
#include "bake/empty_solid.h"
#include "bake/facet.h"
#include "bake/leaf_distance.h"
#include "bake/lost_plates.h"
#include "bake/solid.h"
#include "bake/triangle_bins.h"
#include "bake/walls.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Upper = Tree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;

/// [voxels] Longest side of the triangles that smooth facets are cut into: too small to be felt.
constexpr double kSmoothSide = 0.6;

/// [voxels^2] An area from which the number of leaves of the band follows. A long needle has almost
/// no area, but leaves all along its length.
double estimatedArea(const Solid& solid) {
  double sum = 0.0;
  for (const auto& [i, j, k] : solid.triangles) {
    const Vec3& a = solid.vertices[i];
    const Vec3& b = solid.vertices[j];
    const Vec3& c = solid.vertices[k];
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    if (longest > 32.0) sum += 8.0 * longest;
  }
  return sum;
}

Box3 boundsOf(const Solid& solid) {
  Box3 bounds;
  for (const auto& triangle : solid.triangles) {
    for (const std::uint32_t vertex : triangle) bounds.include(solid.vertices[vertex]);
  }
  return bounds;
}

/// Finishes a grid of unsigned distances.
LevelSet finishUnsigned(const openvdb::FloatGrid::Ptr& grid, const BakeOptions& options) {
  auto metadata = options.metadata;
  metadata.try_emplace("frame", "world");
  metadata[kDistanceKey] = kUnsignedDistance;
  LevelSet result = makeLevelSet(grid, options.length_unit, metadata);
  grid->setGridClass(openvdb::GRID_UNKNOWN);
  return result;
}

class MeshBaker {
 public:
  MeshBaker(const Mesh& mesh, const BakeOptions& options, const Progress& progress)
      : mesh_(mesh), options_(options), progress_(progress), plan_(checkOptions(options)) {
    const double half = 0.5 * options.shell_thickness / plan_.voxel;
    if (!(half >= 0.0) || !std::isfinite(half)) {
      throw inputError("bake.shell_thickness", "the shell's thickness is " +
                                                   inMillimeters(options.shell_thickness) +
                                                   "; it must be a length, or 0 for a solid");
    }
    if (half > 0.0 && half <= 0.5) {
      throw inputError("bake.too_thin",
                       "a shell of " + inMillimeters(options.shell_thickness) +
                           " would have holes in a grid of " + inMillimeters(plan_.voxel) +
                           " voxels",
                       "use voxels of " + inMillimeters(options.shell_thickness / kHeld) +
                           ", or a thicker shell");
    }
    if (half > 0.0 && options.mesh_sign == MeshSign::kUnsigned) {
      throw inputError("bake.shell_thickness",
                       "a shell and unsigned distances cannot be combined: a shell has an inside",
                       "leave out one of the two");
    }
    if (half > 0.0) shell_ = static_cast<float>(half);
    if (!(options.smooth_angle >= 0.0 && options.smooth_angle <= std::numbers::pi)) {
      throw inputError("bake.smooth_angle",
                       "the angle up to which facets become smooth must be from 0 to 180 degrees");
    }
    search_ = plan_;
    search_.half_width += half;
    search_.band += half * plan_.voxel;
  }

  LevelSet run() {
    report(progress_, "bake mesh: checking", 0.0);
    const bool is_solid = !shell_ && options_.mesh_sign != MeshSign::kUnsigned;
    solid_ = is_solid ? makeSolid(mesh_, plan_.voxel, options_.mesh_sign)
                      : makeSurface(mesh_, plan_.voxel);
    if (options_.smooth_angle > 0.0) smooth(is_solid);
    const Box3 bounds = boundsOf(solid_);
    range_ = voxelRange({bounds.lo * plan_.voxel, bounds.hi * plan_.voxel}, search_, options_.name);
    refuseTooLong();
    requireMemory(estimatedArea(solid_), 1.0, search_);
    // The solid with all its walls, if some are dropped: columns_ belongs to that one
    std::optional<Solid> whole;
    if (is_solid) {
      columns_.emplace(solid_, options_.mesh_sign, progress_);
      if (options_.mesh_sign == MeshSign::kVote)
        requireAgreement(mesh_, solid_, *columns_, plan_.voxel);
      if (columns_->hasIdleWalls() || columns_->isFilled() || !solid_.was_closed) {
        whole = solid_;
        dropIdleWalls(solid_, *columns_, progress_);
      }
    }
    const TriangleBins bins(solid_.vertices, solid_.triangles, range_, search_, progress_);
    grid_ = emptyGrid(plan_, options_);
    fillLeaves(bins);
    if (columns_) fillInside();
    report(progress_, "bake mesh", 1.0);
    if (options_.mesh_sign == MeshSign::kUnsigned) return finishUnsigned(grid_, options_);
    if (!columns_) return finishGrid(grid_, plan_, options_);
    const Solid& told = whole ? *whole : solid_;
    const LevelSet result = finished(told);
    const BakedMesh baked{solid_, bins, faces_itself_, told, *columns_};
    std::string lost = refuseLostPlates(baked, result, plan_, options_);
    if (!solid_.dropped.empty()) lost = solid_.dropped + (lost.empty() ? "" : "; ") + lost;
    return withLostParts(result, lost);
  }

 private:
  [[nodiscard]] LevelSet finished(const Solid& solid) const {
    try {
      return finishGrid(grid_, plan_, options_);
    } catch (const Error& error) {
      if (error.problem().code != "bake.empty") throw;
      throw emptySolidError(mesh_, solid, plan_);
    }
  }

  /// The lists below that are sorted by place take at most 2^24 voxels along an axis. Only a mesh
  /// with parts far from each other reaches this limit before that of memory.
  void refuseTooLong() const {
    constexpr int kMost = 1 << 24;
    const Coord dim = range_.dim();
    if (std::max({dim.x(), dim.y(), dim.z()}) < kMost) return;
    throw Error(ErrorKind::kOperation,
                {"bake.too_fine",
                 "'" + options_.name + "' is more than 2^24 voxels of " +
                     inMillimeters(plan_.voxel) + " long",
                 "use larger voxels; also check that the mesh has the length unit it should"});
  }

  void smooth(bool is_turned) {
    if (!is_turned) turnAlike(solid_.vertices, sortedSides(solid_.triangles), solid_.triangles);
    report(progress_, "bake mesh: smoothing", 0.05);
    makeCurved(solid_, options_.smooth_angle, kSmoothSide, plan_.max_memory);
  }

  struct Local {
    LeafScratch scratch;
    std::vector<Facet> facets;
    std::array<float, Leaf::SIZE> squares{};
  };

  void fillLeaves(const TriangleBins& bins) {
    std::vector<std::unique_ptr<Leaf>> leaves(bins.size());
    tbb::enumerable_thread_specific<Local> locals;
    faces_itself_.resize(bins.size());
    parallelWithProgress(bins.size(), progress_, "bake mesh", 0.2, 1.0, [&](std::size_t i) {
      Local& local = locals.local();
      leaves[i] = makeLeaf(bins.origin(i), bins.triangles(i), local);
      faces_itself_[i] = facesItself(local.facets) ? 1 : 0;
    });
    for (auto& leaf : leaves) {
      if (leaf) grid_->tree().addLeaf(leaf.release());
    }
  }

  std::unique_ptr<Leaf> makeLeaf(const Coord& origin, std::span<const std::uint32_t> triangles,
                                 Local& local) const {
    const Vec3 middle = Vec3(origin.x(), origin.y(), origin.z()) + 3.5;
    local.facets.clear();
    for (const std::uint32_t triangle : triangles) {
      const auto& [a, b, c] = solid_.triangles[triangle];
      local.facets.push_back(makeFacet(solid_.vertices[a] - middle, solid_.vertices[b] - middle,
                                       solid_.vertices[c] - middle));
    }
    findSquares(makeQuery(local.facets, static_cast<float>(search_.half_width), local.scratch,
                          local.squares.data()));
    auto leaf = std::make_unique<Leaf>(origin, plan_.background, false);
    float* const values = leaf->buffer().data();
    const auto unit = static_cast<float>(plan_.voxel / plan_.meters_per_unit);
    const float shell = shell_.value_or(0.0F);
    const float background = plan_.background;
    Leaf::NodeMaskType active = leaf->getValueMask();
    bool any = false;
    // The active voxels of eight columns are the 64 bits of a word, ordered by y and z.
    for (int x = 0; x < 8; ++x) {
      std::array<std::uint8_t, 8> inside{};
      if (columns_) inside = columns_->areInside(origin.x() + x, origin.y(), origin.z());
      std::uint64_t word = 0;
      for (unsigned n = 0; n < 64; ++n) {
        const std::size_t place = static_cast<std::size_t>(x) * 64 + n;
        const float distance = (std::sqrt(local.squares[place]) - shell) * unit;
        const float value = (inside[n >> 3] >> (n & 7) & 1) != 0 ? -distance : distance;
        const bool is_active = std::abs(value) < background;
        word |= std::uint64_t{is_active} << n;
        any = any || (shell_ && value < 0.0F);
        values[place] = is_active ? value : std::copysign(background, value);
      }
      active.getWord<std::uint64_t>(static_cast<openvdb::Index>(x)) = word;
      any = any || word != 0;
    }
    leaf->setValueMask(active);
    if (!any) leaf.reset();
    return leaf;
  }

  /// Whether walls here may be the two sides of a plate. They are not if all normals are close to
  /// the first.
  static bool facesItself(const std::vector<Facet>& facets) {
    const float* const first = facets.front().normal;
    return std::any_of(facets.begin(), facets.end(), [&](const Facet& facet) {
      const float* const n = facet.normal;
      return n[0] * first[0] + n[1] * first[1] + n[2] * first[2] < 0.71F;
    });
  }

  /// Gives every tile beside the leaves its sign.
  void fillInside() {
    Tree& tree = grid_->tree();
    const auto inside = [&](const Coord& at) { return columns_->isInside(at.x(), at.y(), at.z()); };
    std::vector<Lower*> lower_nodes;
    for (auto upper = tree.root().beginChildOn(); upper; ++upper) {
      for (auto lower = upper->beginChildOn(); lower; ++lower) lower_nodes.push_back(&*lower);
      for (auto tile = upper->beginChildOff(); tile; ++tile) {
        if (inside(tile.getCoord())) tile.setValue(-plan_.background);
      }
    }
    parallelWithProgress(lower_nodes.size(), {}, "", 1.0, 1.0, [&](std::size_t i) {
      for (auto tile = lower_nodes[i]->beginChildOff(); tile; ++tile) {
        if (inside(tile.getCoord())) tile.setValue(-plan_.background);
      }
    });
    constexpr int kUpper = static_cast<int>(Upper::DIM);
    const auto down = [](int value) { return value & ~(kUpper - 1); };
    for (int x = down(range_.min().x()); x <= range_.max().x(); x += kUpper) {
      for (int y = down(range_.min().y()); y <= range_.max().y(); y += kUpper) {
        for (int z = down(range_.min().z()); z <= range_.max().z(); z += kUpper) {
          const Coord at(x, y, z);
          if (tree.root().probeConstNode<Upper>(at) == nullptr && inside(at)) {
            tree.addTile(Upper::LEVEL + 1, at, -plan_.background, false);
          }
        }
      }
    }
  }

  const Mesh& mesh_;
  const BakeOptions& options_;
  const Progress& progress_;
  BakePlan plan_;
  BakePlan search_;             ///< the same, but with the band in which distances are needed
  std::optional<float> shell_;  ///< [voxels] half of its thickness
  Solid solid_;
  CoordBBox range_;  ///< the voxels that the band can touch
  std::optional<Columns> columns_;
  std::vector<std::uint8_t> faces_itself_;  ///< for each leaf: facesItself()
  openvdb::FloatGrid::Ptr grid_;
};

}  // namespace

LevelSet bakeMesh(const Mesh& mesh, const BakeOptions& options, const Progress& progress) {
  return MeshBaker(mesh, options, progress).run();
}

}  // namespace palpate::vdb
