// An outside user of each component: checks that installed functions can be linked and do what the
// headers say.
#include <palpate/core/error.h>
#include <palpate/fields/primitives.h>
#include <palpate/render/haptic_renderer.h>
#include <palpate/scene/scene_file.h>
#include <palpate/version.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#ifdef WITH_devices
#include <palpate/devices/falcon.h>
#include <palpate/devices/passivity.h>
#include <palpate/devices/path.h>
#include <palpate/devices/virtual_coupling.h>
#endif
#ifdef WITH_vdb
#include <palpate/vdb/bake.h>
#endif

namespace {

void require(bool holds, const char* what) {
  std::cout << (holds ? "ok      " : "FAILED  ") << what << '\n';
  if (!holds) std::exit(EXIT_FAILURE);
}

/// A map implemented outside: the library calls it.
class Even final : public palpate::MaterialMap {
 public:
  [[nodiscard]] Sample sample(const palpate::Vec3& p) const noexcept override {
    return {value(p), palpate::Vec3(0.0)};
  }
  [[nodiscard]] double value(const palpate::Vec3& /*p*/) const noexcept override { return 2000.0; }
  [[nodiscard]] Range range() const noexcept override { return {2000.0, 2000.0}; }
};

void useRenderer() {
  palpate::SceneDescription description;
  palpate::Material skin;
  skin.name = "skin";
  skin.stiffness = palpate::MaterialMapPtr(std::make_shared<const Even>());
  description.materials.push_back(skin);
  palpate::LayerDescription ball;
  ball.name = "ball";
  ball.inside =
      std::make_shared<const palpate::FieldSource>(palpate::sphere(palpate::Vec3(0.0), 0.02));
  ball.wall.material = "skin";
  description.layers.push_back(ball);
  const palpate::ScenePtr scene = palpate::compile(description);
  const auto renderer = palpate::makeRenderer(scene);
  (void)renderer->update({.position = {0.021, 0.0, 0.0}});
  const palpate::RendererState before = renderer->checkpoint();
  const palpate::TickResult pressed = renderer->update({.position = {0.019, 0.0, 0.0}});
  require(std::abs(pressed.force.x - 2.0) < 1e-9, "core: a map of one's own is felt");
  require(renderer->setState(before), "core: a state is given back");
  require(renderer->update({.position = {0.019, 0.0, 0.0}}).force == pressed.force,
          "core: and the same is felt again");
}

}  // namespace

int main() {
  require(std::string(palpate::version()) == PALPATE_VERSION_STRING,
          "core: headers and library are of one version");
  bool is_refused = false;
  try {
    (void)palpate::sphere(palpate::Vec3(0.0), -1.0);
  } catch (const palpate::Error& error) {
    is_refused = error.kind() == palpate::ErrorKind::kInput;
  }
  require(is_refused, "core: an error is caught as what it is");
  useRenderer();

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
  require(palpate::devices::makeFalcon({})->info().name == "Novint Falcon",
          "devices: a driver is linked with all that it needs");
  palpate::devices::VirtualCoupling coupling({.stiffness = 1000.0, .damping = 1.0});
  require(coupling.reach(above, 1e-3).position == above, "devices: a coupling begins at the hand");
  palpate::devices::PassivityController passivity({.mass = 0.1});
  require(passivity.step(above, 1e-3, {0.0, 0.0, 1.0}, 0.0).force.z == 1.0,
          "devices: a first force is nothing to damp");
#endif

#ifdef WITH_vdb
  const palpate::vdb::LevelSet grid = palpate::vdb::bake(*ball, {.voxel_size = 0.0005});
  const palpate::FieldPtr baked = palpate::vdb::gridField(grid);
  // Trilinear in a sphere of 40 voxels: the error is at most h^2 / R = 1.3e-5 m.
  require(std::abs(baked->sample(above).value - 0.001) < 1.3e-5, "vdb: the ball as a grid");
#endif
}
