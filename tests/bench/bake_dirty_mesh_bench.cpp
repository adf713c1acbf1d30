// Meshes as found in practice, compared with OpenVDB's meshToVolume in the same run: clean, two
// hundred overlapping balls, with specks, and as a triangle soup. `worst` is the largest error of
// some voxels of the band, found by brute force [voxels].

#include <benchmark/benchmark.h>
#include <openvdb/tools/MeshToVolume.h>

#include <cmath>
#include <map>
#include <random>

#include "bench/bake_bench.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"
#include "vdb/union_oracle.h"

namespace palpate::vdb {
namespace {

constexpr double kVoxel = 0.5e-3;

enum Kind { kClean, kBalls, kFewBalls, kSpecks, kSoup };
const char* const kNames[] = {"clean", "200 balls", "27 balls", "specks", "soup"};

void append(Mesh& mesh, const Mesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) {
    mesh.triangles.push_back({a + first, b + first, c + first});
  }
}

struct Case {
  Mesh mesh;
  std::vector<Mesh> parts;  ///< convex parts; the mesh is their union
};

const Case& caseOf(int kind) {
  static std::map<int, Case> cases;
  Case& made = cases[kind];
  if (!made.parts.empty()) return made;
  std::mt19937 random(1);
  const auto anywhere = [&](double reach) {
    std::uniform_real_distribution<double> any(-reach, reach);
    return Vec3(any(random), any(random), any(random));
  };
  if (kind == kBalls || kind == kFewBalls) {
    for (int n = 0; n < (kind == kBalls ? 200 : 27); ++n) {
      made.parts.push_back(kind == kBalls ? test::ballMesh(anywhere(40e-3), 10e-3, 3)
                                          : test::ballMesh(anywhere(15e-3), 10e-3, 2));
    }
  } else {
    made.parts.push_back(test::ballMesh(Vec3(0.31e-3, -0.17e-3, 0.23e-3), 50e-3, 6));
  }
  for (const Mesh& part : made.parts) append(made.mesh, part);
  if (kind == kSpecks) {
    for (int n = 0; n < 200; ++n) {
      Mesh speck = test::ballMesh(anywhere(55e-3), 0.2e-3, 1);
      speck.triangles.resize(40);  // half of its triangles
      append(made.mesh, speck);
    }
  }
  if (kind == kSoup) {
    Mesh soup;
    for (const auto& t : made.mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(soup.vertices.size());
      for (const std::uint32_t v : t) {
        soup.vertices.push_back(made.mesh.vertices[v] + anywhere(1e-5 * 50e-3));
      }
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    made.mesh = soup;
  }
  return made;
}

void addWorst(benchmark::State& state, const LevelSet& set, const Case& from) {
  const test::UnionOracle oracle(from.parts);
  const std::uint64_t step = std::max<std::uint64_t>(1, set.info().active_voxels / 500);
  double worst = 0.0;
  std::uint64_t n = 0;
  for (auto at = set.impl().grid->cbeginValueOn(); at; ++at) {
    if (n++ % step != 0) continue;
    const openvdb::Coord c = at.getCoord();
    const double exact = oracle.at(kVoxel * Vec3(c.x(), c.y(), c.z()), 4.0 * kVoxel);
    worst = std::max(worst, std::abs(static_cast<double>(*at) * 1e-3 - exact) / kVoxel);
  }
  state.counters["worst"] = worst;
}

void ours(benchmark::State& state) {
  const Case& from = caseOf(static_cast<int>(state.range(0)));
  state.SetLabel(kNames[state.range(0)]);
  const bench::Threads threads(1);
  LevelSet set;
  for (auto run : state) set = bakeMesh(from.mesh, test::voxels(kVoxel, bench::kHalfWidth));
  bench::perVoxel(state, set.info().active_voxels);
  state.counters["triangles"] = static_cast<double>(from.mesh.triangles.size());
  addWorst(state, set, from);
}

struct Adapter {
  const Mesh& mesh;
  [[nodiscard]] std::size_t polygonCount() const { return mesh.triangles.size(); }
  [[nodiscard]] std::size_t pointCount() const { return mesh.vertices.size(); }
  [[nodiscard]] static std::size_t vertexCount(std::size_t) { return 3; }
  void getIndexSpacePoint(std::size_t n, std::size_t v, openvdb::Vec3d& point) const {
    const Vec3 p = mesh.vertices[mesh.triangles[n][v]] / kVoxel;
    point = openvdb::Vec3d(p.x, p.y, p.z);
  }
};

void meshToVolume(benchmark::State& state) {
  openvdb::initialize();
  const Case& from = caseOf(static_cast<int>(state.range(0)));
  state.SetLabel(kNames[state.range(0)]);
  const bench::Threads threads(1);
  const auto transform = openvdb::math::Transform::createLinearTransform(kVoxel * 1e3);
  const auto width = static_cast<float>(bench::kHalfWidth);
  openvdb::FloatGrid::Ptr grid;
  for (auto run : state) {
    grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(Adapter{from.mesh}, *transform, width,
                                                            width);
  }
  bench::perVoxel(state, grid->activeVoxelCount());
  state.counters["triangles"] = static_cast<double>(from.mesh.triangles.size());
}

void kinds(benchmark::internal::Benchmark* bench) {
  bench->ArgName("mesh")->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int kind : {kClean, kBalls, kFewBalls, kSpecks, kSoup}) bench->Arg(kind);
}

BENCHMARK(ours)->Name("dirty_mesh/palpate")->Apply(kinds);
BENCHMARK(meshToVolume)->Name("dirty_mesh/meshToVolume")->Apply(kinds);

}  // namespace
}  // namespace palpate::vdb
