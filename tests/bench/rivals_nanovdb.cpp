#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include "palpate/vdb/openvdb_access.h"
#include "rivals.h"

namespace palpate::bench {
namespace {

using Accessor = nanovdb::DefaultReadAccessor<float>;

struct Sampled {
  float value;
  nanovdb::Vec3f gradient;
};

/// The grid converted to NanoVDB; shared by the runs.
struct NanoGrid {
  explicit NanoGrid(const vdb::LevelSet& grid)
      : handle(nanovdb::openToNanoVDB(*grid.impl().grid)),
        accessor(handle.grid<float>()->getAccessor()),
        origin(grid.impl().origin),
        per_voxel(1.0 / grid.info().voxel_size) {}

  [[nodiscard]] nanovdb::Vec3d index(const Vec3& p) const {
    const Vec3 q = (p - origin) * per_voxel;
    return {q.x, q.y, q.z};
  }

  nanovdb::GridHandle<> handle;
  Accessor accessor;
  Vec3 origin;
  double per_voxel;
};

template <int Order>
Run withDifferences(const char* name, const std::shared_ptr<NanoGrid>& grid) {
  return makeRun(
      name, [grid, sampler = nanovdb::createSampler<Order>(grid->accessor)](const Vec3& p) mutable {
        const nanovdb::Vec3d at = grid->index(p);
        Sampled out{sampler(at), nanovdb::Vec3f(0.0F)};
        for (int axis = 0; axis < 3; ++axis) {
          nanovdb::Vec3d ahead = at, behind = at;
          ahead[axis] += 0.5;
          behind[axis] -= 0.5;
          out.gradient[axis] = sampler(ahead) - sampler(behind);
        }
        return out;
      });
}

}  // namespace

std::vector<Run> nanovdbRuns(const vdb::LevelSet& grid) {
  const auto nano = std::make_shared<NanoGrid>(grid);
  std::vector<Run> runs;
  runs.push_back(
      makeRun("NanoVDB order 1 with gradient",
              [nano, sampler = nanovdb::createSampler<1>(nano->accessor)](const Vec3& p) mutable {
                const nanovdb::Vec3d at = nano->index(p);
                return Sampled{sampler(at), sampler.gradient(at)};
              }));
  runs.push_back(withDifferences<2>("NanoVDB order 2 + 6 differences", nano));
  runs.push_back(withDifferences<3>("NanoVDB order 3 + 6 differences", nano));
  return runs;
}

}  // namespace palpate::bench
