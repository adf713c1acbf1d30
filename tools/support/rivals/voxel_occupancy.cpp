#include <utility>
#include <vector>

#include "palpate/core/error.h"
#include "support/rivals/rival_renderer.h"
#include "support/rivals/rivals.h"
#include "support/rivals/voxel_grid.h"

namespace palpate::rivals {
namespace {

class VoxelOccupancy final : public RivalRenderer {
 public:
  VoxelOccupancy(ScenePtr scene, const Voxels& voxels) : RivalRenderer(std::move(scene)) {
    depth_ = std::max(voxels.ramp, 1.0) * voxels.size;
    for (const Solid& solid : solids()) {
      const Box3 box = solid.field->bounds();
      if (!box.isBounded()) {
        throw inputError("rivals.unbounded", "a solid without end has no voxels");
      }
      grids_.emplace_back(*solid.field, box.grownBy(2.0 * depth_ + 4.0 * voxels.size), voxels);
    }
  }

 private:
  void forget() noexcept override {}

  /// The depth follows from the value as if the value rose linearly: at most half the distance over
  /// which it rises.
  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    TickResult out = untouched(hip);
    double most = 0.5;
    for (std::size_t i = 0; i < grids_.size(); ++i) {
      const double value = grids_[i].value(hip.position);
      if (!(value > most)) continue;
      most = value;
      const Vec3 n = unitOr(-grids_[i].gradient(hip.position), Vec3(0.0));
      out = spring(hip, hip.position + (value - 0.5) * depth_ * n, solids()[i], region());
    }
    return out;
  }

  double depth_ = 0.0;  ///< [m] distance over which the value rises from 0 to 1
  std::vector<VoxelGrid> grids_;
};

}  // namespace

std::unique_ptr<HapticRenderer> voxelOccupancy(ScenePtr scene, const Voxels& voxels) {
  return std::make_unique<VoxelOccupancy>(std::move(scene), voxels);
}

}  // namespace palpate::rivals
