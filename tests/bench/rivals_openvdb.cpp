#include <openvdb/math/Stencils.h>
#include <openvdb/tools/Interpolation.h>

#include "palpate/vdb/openvdb_access.h"
#include "rivals.h"

namespace palpate::bench {
namespace {

struct Sampled {
  float value;
  openvdb::Vec3f gradient;
};

/// Converts a point [m] to voxels.
class ToIndex {
 public:
  explicit ToIndex(const vdb::LevelSet& grid)
      : origin_(grid.impl().origin), per_voxel_(1.0 / grid.info().voxel_size) {}
  [[nodiscard]] openvdb::Vec3d operator()(const Vec3& p) const {
    const Vec3 q = (p - origin_) * per_voxel_;
    return {q.x, q.y, q.z};
  }

 private:
  Vec3 origin_;
  double per_voxel_;
};

/// Value, and gradient by central differences over half a voxel to each side.
template <class Sampler>
Run withDifferences(const char* name, const vdb::LevelSet& grid) {
  return makeRun(name, [grid, index = ToIndex(grid),
                        accessor = grid.impl().grid->getConstAccessor()](const Vec3& p) {
    const openvdb::Vec3d at = index(p);
    Sampled out{Sampler::sample(accessor, at), {}};
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Vec3d ahead = at, behind = at;
      ahead[axis] += 0.5;
      behind[axis] -= 0.5;
      out.gradient[axis] = Sampler::sample(accessor, ahead) - Sampler::sample(accessor, behind);
    }
    return out;
  });
}

}  // namespace

std::vector<Run> openvdbRuns(const vdb::LevelSet& grid) {
  std::vector<Run> runs;
  using Stencil = openvdb::math::BoxStencil<openvdb::FloatGrid>;
  const auto stencil = std::make_shared<Stencil>(*grid.impl().grid);
  runs.push_back(
      makeRun(kYardstick, [grid, index = ToIndex(grid), stencil, &fast = *stencil](const Vec3& p) {
        const openvdb::Vec3d at = index(p);
        fast.moveTo(at);
        const openvdb::Vec3f where(at);
        return Sampled{fast.interpolation(where), fast.gradient(where)};
      }));
  runs.push_back(
      withDifferences<openvdb::tools::BoxSampler>("OpenVDB BoxSampler + 6 differences", grid));
  runs.push_back(withDifferences<openvdb::tools::QuadraticSampler>(
      "OpenVDB QuadraticSampler + 6 differences", grid));
  return runs;
}

}  // namespace palpate::bench
