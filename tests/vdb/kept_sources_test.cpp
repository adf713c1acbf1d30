// What grids that are kept were made of: masks, meshes of several files; and who is asked whether
// one is kept.

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>

#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/register.h"
#include "support/temp_file.h"
#include "vdb/made_scans.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

class KeptSources : public ::testing::Test {
 protected:
  KeptSources() { initializeOpenVdb(); }

  struct Loaded {
    FieldPtr field;
    std::size_t kept = 0;
    std::size_t made = 0;
  };

  /// The one field of a scene.
  Loaded load(const std::string& field, const BundleOptions& bundle = {}) {
    Loaded out;
    RegisterOptions options;
    options.cache_folder = folder_.path("cache");
    options.on_grid = [&](const GridRecord& record) {
      (wasKept(record.info) ? out.kept : out.made) += 1;
    };
    SceneRegistry registry;
    registerKinds(registry, options, bundle);
    const SceneDescription scene = readScene(
        folder_.file("scene.yaml",
                     "palpate: 1\nlength: mm\nlayers: [{name: it, inside: " + field + "}]\n"),
        registry);
    out.field = scene.layers.front().inside->get();
    return out;
  }

  static void expectSame(const Loaded& a, const Loaded& b) {
    const Box3 box = a.field->bounds();
    EXPECT_EQ(box.lo, b.field->bounds().lo);
    EXPECT_EQ(box.hi, b.field->bounds().hi);
    for (int i = 0; i < 4096; ++i) {
      const Vec3 share = Vec3(i & 15, (i >> 4) & 15, i >> 8) / 15.0;
      const Vec3 p = box.lo + (1.2 * share - 0.1) * box.size();
      ASSERT_EQ(a.field->sample(p).value, b.field->sample(p).value) << i;
      ASSERT_EQ(a.field->sample(p).gradient, b.field->sample(p).gradient) << i;
    }
  }

  /// A fog volume, or booleans, of a ball of 6 mm; `more` is a voxel that is changed.
  template <typename Grid>
  void writeBall(const std::string& file, const openvdb::Coord& more) {
    auto grid = Grid::create();
    grid->setName("opening");
    if constexpr (std::is_same_v<Grid, openvdb::FloatGrid>) {
      grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    }
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    auto accessor = grid->getAccessor();
    for (int n = 0; n < 26 * 26 * 26; ++n) {
      const openvdb::Coord at(n % 26 - 13, n / 26 % 26 - 13, n / 676 - 13);
      const double inside = 12.5 - at.asVec3d().length();
      if (inside <= 0.0 && at != more) continue;
      accessor.setValue(at, typename Grid::ValueType(std::min(1.0, 0.25 * inside + 0.1)));
    }
    openvdb::io::File(folder_.path(file)).write(openvdb::GridPtrVec{grid});
  }

  palpate::testing::TempFolder folder_;
};

TEST_F(KeptSources, AMaskIsKeptByItsVoxelsAndByHowItIsRead) {
  writeBall<openvdb::FloatGrid>("fog.vdb", {0, 0, 0});
  writeBall<openvdb::BoolGrid>("bool.vdb", {0, 0, 0});
  const std::vector<std::string> ways = {
      "{mask: {file: fog.vdb, units: mm}}",
      "{mask: {file: fog.vdb, units: mm, above: 0.7}}",
      "{mask: {file: fog.vdb, units: mm, above: 0.7, voxel: 0.8}}",
      "{mask: {file: fog.vdb, units: cm}}",
      "{mask: {file: bool.vdb, units: mm, name: opening}}",
      "{mask: {file: bool.vdb, units: mm, name: opening, sampler: trilinear}}"};
  for (const std::string& way : ways) {
    SCOPED_TRACE(way);
    const Loaded first = load(way);
    EXPECT_EQ(first.made, 1U) << "none of the others is taken for it";
    const Loaded second = load(way);
    EXPECT_EQ(second.kept, 1U);
    EXPECT_EQ(second.made, 0U);
    expectSame(first, second);
  }
  // One voxel more, beside the ball.
  writeBall<openvdb::BoolGrid>("bool.vdb", {12, 6, 0});
  EXPECT_EQ(load(ways[4]).made, 1U);
  EXPECT_EQ(load(ways[0]).kept, 1U);
}

/// An octahedron with a tip at x = `tip` [m], in a buffer of its own.
std::string buffer(float tip) {
  const std::array<std::uint16_t, 24> faces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                               2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const std::array<float, 18> corners = {tip, 0,      0, -0.01F, 0, 0,     0, 0.01F, 0,
                                         0,   -0.01F, 0, 0,      0, 0.01F, 0, 0,     -0.01F};
  std::string bytes(sizeof faces + sizeof corners, '\0');
  std::memcpy(bytes.data(), faces.data(), sizeof faces);
  std::memcpy(bytes.data() + sizeof faces, corners.data(), sizeof corners);
  return bytes;
}

constexpr const char* kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)"
    R"("buffers":[{"byteLength":120,"uri":"stone.bin"}],)"
    R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
    R"({"buffer":0,"byteOffset":48,"byteLength":72}],"accessors":[)"
    R"({"bufferView":0,"componentType":5123,"count":24,"type":"SCALAR"},)"
    R"({"bufferView":1,"componentType":5126,"count":6,"type":"VEC3",)"
    R"("min":[-0.01,-0.01,-0.01],"max":[0.02,0.01,0.01]}]})";

TEST_F(KeptSources, AMeshIsKeptByTheBuffersThatLieBesideIt) {
  (void)folder_.file("stone.gltf", kGltf);
  (void)folder_.file("stone.bin", buffer(0.01F));
  const std::string way = "{mesh: {file: stone.gltf, voxel: 0.5}}";
  const Loaded first = load(way);
  EXPECT_EQ(first.made, 1U);
  const Loaded second = load(way);
  EXPECT_EQ(second.kept, 1U);
  expectSame(first, second);
  (void)folder_.file("stone.bin", buffer(0.012F));
  const Loaded third = load(way);
  EXPECT_EQ(third.made, 1U);
  EXPECT_GT(third.field->bounds().hi.x, first.field->bounds().hi.x + 0.001);
}

TEST_F(KeptSources, SayWhetherTheyAreKeptAndMakeNothingForThat) {
  const test::Limb limb;
  (void)test::writeNifti(limb.labels(test::obliqueAxes(Vec3(2.5))), folder_, "labels.nii");
  const auto ask = [&](const std::string& match) {
    std::map<std::string, std::function<bool()>> sources;
    BundleOptions asking;
    asking.on_source = [&](const std::string& what, std::function<bool()> is_kept) {
      sources[what] = std::move(is_kept);
    };
    RegisterOptions options;
    options.cache_folder = folder_.path("cache");
    options.on_grid = [](const GridRecord& record) { ADD_FAILURE() << record.what; };
    SceneRegistry registry;
    registerKinds(registry, options, asking);
    const SceneDescription scene = parseScene(
        "palpate: 1\nlength: mm\nimages: {seg: {file: labels.nii}}\nlayers:\n"
        "  - {name: flesh, labels: {image: seg, match: " +
            match +
            "}}\n"
            "  - {name: bone, labels: {image: seg, match: [1]}}\n",
        folder_.path("scene.yaml"), registry);
    std::map<std::string, bool> kept;
    for (const auto& [what, is_kept] : sources) kept[what] = is_kept();
    return kept;
  };
  using Kept = std::map<std::string, bool>;
  EXPECT_EQ(ask("[2]"), (Kept{{"bone", false}, {"flesh", false}}));
  EXPECT_FALSE(fs::exists(folder_.path("cache"))) << "nothing was written";
  {
    RegisterOptions options;
    options.cache_folder = folder_.path("cache");
    SceneRegistry registry;
    registerKinds(registry, options);
    const SceneDescription scene = parseScene(
        "palpate: 1\nlength: mm\nimages: {seg: {file: labels.nii}}\nlayers:\n"
        "  - {name: other, labels: {image: seg, match: [2]}}\n"
        "  - {name: bone, labels: {image: seg, match: [1]}}\n",
        folder_.path("scene.yaml"), registry);
    (void)scene.layers[1].inside->get();
  }
  EXPECT_EQ(ask("[2]"), (Kept{{"bone", true}, {"flesh", false}}));
  // Another neighbor, another bone.
  EXPECT_EQ(ask("[2, 3]"), (Kept{{"bone", false}, {"flesh", false}}));
}

}  // namespace
}  // namespace palpate::vdb
