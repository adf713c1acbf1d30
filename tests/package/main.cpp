// An outside user of each component: what it gets must be linkable and mean what the headers say.
#include <palpate/fields/primitives.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#ifdef WITH_devices
#include <palpate/devices/path.h>
#endif
#ifdef WITH_vdb
#include <palpate/vdb/bake.h>
#endif

namespace {

void require(bool holds, const char* what) {
  std::cout << (holds ? "ok      " : "FAILED  ") << what << '\n';
  if (!holds) std::exit(EXIT_FAILURE);
}

}  // namespace

int main() {
  const palpate::FieldPtr ball = palpate::sphere(palpate::Vec3(0.0), 0.02);
  const palpate::Vec3 above(0.0, 0.0, 0.021);
  require(std::abs(ball->sample(above).value - 0.001) < 1e-15, "core: distance to a ball");

#ifdef WITH_devices
  palpate::devices::VirtualDevice hand(
      palpate::devices::generate(palpate::devices::PressPath{.surface = {0.0, 0.0, 0.02}}, 1000.0));
  hand.open();
  palpate::devices::DeviceState state;
  require(hand.read(state) == palpate::devices::DeviceStatus::kOk, "devices: a hand that moves");
  require(std::abs(state.position.z - 0.025) < 1e-12, "devices: it starts at its clearance");
#endif

#ifdef WITH_vdb
  const palpate::vdb::LevelSet grid = palpate::vdb::bake(*ball, {.voxel_size = 0.0005});
  const palpate::FieldPtr baked = palpate::vdb::gridField(grid);
  // Trilinear in a sphere of 40 voxels: h^2 / R = 1.3e-5 m at the very worst.
  require(std::abs(baked->sample(above).value - 0.001) < 1.3e-5, "vdb: the ball as a grid");
#endif
}
