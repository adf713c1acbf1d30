#include <array>
#include <cmath>
#include <numbers>

#include "bench/contact_case.h"
#include "bench/path.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::tools {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Shell {
  const char* name;
  double radius;     ///< [m]
  double stiffness;  ///< [N/m] in the mean
  double viscosity;  ///< [N s/m] in the mean
  double opens_at;   ///< [N] mean of opens_at; 0: the wall does not open
};
constexpr std::array<Shell, 5> kShells = {{{"skin", 0.050, 700.0, 2.0, 1.2},
                                           {"fat", 0.048, 300.0, 1.0, 0.3},
                                           {"muscle", 0.045, 500.0, 3.0, 0.6},
                                           {"bone", 0.038, 2000.0, 0.5, 0.0},
                                           {"marrow", 0.033, 400.0, 4.0, 0.0}}};

/// A map with values around `mean`, up to a fifth more or less, in waves of some centimeters, like
/// a scan of 2 mm; 16 bits.
MaterialMapPtr waves(double mean, double phase) {
  vdb::Image image;
  image.size = {61, 61, 61};
  image.axes = Mat3(2e-3);
  image.origin = Vec3(-0.06);
  image.values.reserve(std::size_t{61} * 61 * 61);
  for (int k = 0; k < 61; ++k) {
    for (int j = 0; j < 61; ++j) {
      for (int i = 0; i < 61; ++i) {
        const Vec3 p = image.toWorld(Vec3(i, j, k));
        const double wave = (std::sin(160.0 * p.x + phase) + std::sin(190.0 * p.y + 2.0 * phase) +
                             std::sin(230.0 * p.z + 3.0 * phase)) /
                            3.0;
        image.values.push_back(static_cast<float>(mean * (1.0 + 0.2 * wave)));
      }
    }
  }
  return std::make_shared<const vdb::MaterialGrid>(std::move(image), 1e-4 * mean);
}

ScenePtr fiveLayerScene() {
  SceneDescription scene;
  vdb::BakeOptions options;
  options.voxel_size = 1e-3;
  double phase = 0.0;
  const char* outer = "outside";
  for (const Shell& shell : kShells) {
    Material material;
    material.name = shell.name;
    material.stiffness = waves(shell.stiffness, phase += 1.0);
    material.damping = waves(0.5, phase += 1.0);
    material.friction = {waves(0.2, phase += 1.0), waves(0.1, phase += 1.0)};
    material.viscosity = waves(shell.viscosity, phase += 1.0);
    scene.materials.push_back(material);
    LayerDescription layer;
    layer.name = shell.name;
    layer.inside = std::make_shared<FieldSource>(
        vdb::gridField(vdb::bake(*sphere(Vec3(0.0), shell.radius), options)));
    layer.wall.material = layer.content = material.name;
    scene.layers.push_back(layer);
    if (shell.opens_at > 0.0) {
      PortDescription port;
      port.name = std::string("through_") + shell.name;
      port.from = outer;
      port.to = shell.name;
      port.opens_at = waves(shell.opens_at, phase += 1.0);
      port.back = 0.1;
      scene.ports.push_back(port);
    }
    outer = shell.name;
  }
  return compile(scene);
}

/// No judgment: where stiffness differs from place to place, no formula gives the force.
Judge timesOnly() {
  return [](std::span<const Vec3> path, std::span<const TickResult>, const Progress&) {
    return Truth(path.size());
  };
}

}  // namespace

ContactCase fiveLayers() {
  const auto round = [](double radius) {
    return [=](double s) { return radius * windingDirection(s); };
  };
  ContactCase out;
  PathMaker maker(0.055 * windingDirection(0.0));
  out.first = maker.size();
  maker.go(round(0.037)(0.0), 0.05);
  maker.follow(round(0.037), 0.0, 5.0 * kTurn, 0.2);
  const Vec3 last = glm::normalize(maker.at());
  maker.go(0.055 * last, 0.05);
  maker.go(0.055 * windingDirection(0.0), 0.2);
  maker.follow(round(0.0495), 0.0, 5.0 * kTurn, 0.2);
  out.end = maker.size();
  out.path = maker.take();
  out.scene = fiveLayerScene();
  out.judge = timesOnly();
  return out;
}

ContactCase lumpUnderSkin() {
  const Curve curve = [](double s) {
    return Vec3(0.02 * std::cos(s), 0.013 * std::sin(1.3 * s), -1e-3);
  };
  ContactCase out;
  PathMaker maker(Vec3(0.02, 0.0, 0.01));
  maker.go(curve(0.0), 0.05);
  out.first = maker.size();
  maker.follow(curve, 0.0, 10.0 * kTurn, 0.2);
  out.end = maker.size();
  out.path = maker.take();
  out.scene = compile(parseScene(R"(
    palpate: 1
    length: mm
    materials:
      skin: {stiffness: 400 N/m, composite: {radius: 5, depth: 120}}
      knot: {stiffness: 4000 N/m}
      table: {stiffness: 8000 N/m}
    layers:
      - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
      - {name: lump, inside: {sphere: {center: [0, 0, -13], radius: 5}}, wall: knot}
      - {name: ground, inside: {half_space: {point: [0, 0, -40], normal: [0, 0, 1]}}, wall: table})",
                                 "lump"));
  out.judge = timesOnly();
  return out;
}

}  // namespace palpate::tools
