// Grids that scenes bake for themselves are kept by content: a second load bakes nothing and feels
// the same, and whatever happens to the folder costs only time.
#include "palpate/vdb/kept_grids.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "palpate/core/error.h"
#include "palpate/vdb/register.h"
#include "support/temp_file.h"
#include "vdb/made_scans.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

constexpr double kMm = 1e-3;

/// All kinds of layers that a scene may bake for itself.
constexpr const char* kLayers =
    "images: {seg: {file: labels.nii}, ct: {file: ct.nrrd}}\n"
    "layers:\n"
    "  - {name: body, threshold: {image: ct, above: -500}}\n"
    "  - {name: fat, labels: {image: seg, match: [3]}}\n"
    "  - {name: flesh, labels: {image: seg, match: [2]}}\n"
    "  - {name: bone, labels: {image: seg, match: [1]}}\n"
    "  - {name: stone, inside: {mesh: {file: stone.obj, voxel: 0.5}}}\n";

constexpr std::size_t kCount = 5;

/// The result of loading a scene.
struct Loaded {
  std::vector<FieldPtr> fields;
  std::vector<Box3> boxes;
  std::vector<GridRecord> grids;
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t kept() const {
    return static_cast<std::size_t>(std::count_if(
        grids.begin(), grids.end(), [](const GridRecord& grid) { return wasKept(grid.info); }));
  }
};

class KeptGrids : public ::testing::Test {
 protected:
  KeptGrids() {
    const test::Limb limb;
    labels_ = limb.labels(test::obliqueAxes(Vec3(1.5, 1.5, 2.0)));
    (void)test::writeNifti(labels_, folder_, "labels.nii");
    (void)test::writeNrrd(limb.scan(test::obliqueAxes(Vec3(2.0), 0.3)), folder_, "ct.nrrd");
    writeStone(10.0);
  }

  void writeStone(double tip) {
    std::ostringstream text;
    text << "v " << tip << " 0 0\n"
         << "v -10 0 0\nv 0 10 0\nv 0 -10 0\nv 0 0 10\nv 0 0 -10\n"
            "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    (void)folder_.file("stone.obj", text.str());
  }

  /// Makes every layer of a scene.
  Loaded load(const std::string& layers, const std::string& cache = "cache",
              const BundleOptions& bundle = {}) {
    Loaded out;
    RegisterOptions options;
    options.cache_folder = cache.empty() ? "" : folder_.path(cache);
    options.on_grid = [&](const GridRecord& record) { out.grids.push_back(record); };
    options.on_note = [&](const std::string& note) { out.notes.push_back(note); };
    SceneRegistry registry;
    registerKinds(registry, options, bundle);
    const SceneDescription scene =
        readScene(folder_.file("scene.yaml", "palpate: 1\nlength: mm\n" + layers), registry);
    for (const LayerDescription& layer : scene.layers) {
      out.boxes.push_back(layer.inside->bounds().value());
    }
    for (const LayerDescription& layer : scene.layers) out.fields.push_back(layer.inside->get());
    return out;
  }

  [[nodiscard]] std::vector<fs::path> files(const char* extension) const {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(folder_.path("cache"))) {
      if (entry.path().extension() == extension) all.push_back(entry.path());
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  /// Equal bit for bit, in and around the layers' boxes.
  static void expectSame(const Loaded& a, const Loaded& b, unsigned seed) {
    ASSERT_EQ(a.fields.size(), b.fields.size());
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-0.1, 1.1);
    for (std::size_t layer = 0; layer < a.fields.size(); ++layer) {
      EXPECT_EQ(a.boxes[layer].lo, b.boxes[layer].lo) << layer;
      EXPECT_EQ(a.boxes[layer].hi, b.boxes[layer].hi) << layer;
      EXPECT_EQ(a.fields[layer]->lipschitz(), b.fields[layer]->lipschitz());
      const Box3 box = a.fields[layer]->bounds();
      EXPECT_EQ(box.lo, b.fields[layer]->bounds().lo);
      EXPECT_EQ(box.hi, b.fields[layer]->bounds().hi);
      for (int i = 0; i < 1000; ++i) {
        const double x = unit(random);
        const double y = unit(random);
        const Vec3 p = box.lo + Vec3(x, y, unit(random)) * box.size();
        const FieldSample of_a = a.fields[layer]->sample(p);
        const FieldSample of_b = b.fields[layer]->sample(p);
        ASSERT_EQ(of_a.value, of_b.value) << layer;
        ASSERT_EQ(of_a.gradient, of_b.gradient) << layer;
        ASSERT_EQ(of_a.in_band, of_b.in_band) << layer;
      }
    }
  }

  palpate::testing::TempFolder folder_;
  Image labels_;
};

TEST_F(KeptGrids, TheSecondLoadBakesNothingAndSaysTheSame) {
  const Loaded without = load(kLayers, "");
  const Loaded first = load(kLayers);
  const Loaded second = load(kLayers);
  ASSERT_EQ(first.grids.size(), kCount);
  EXPECT_EQ(first.kept(), 0U);
  ASSERT_EQ(second.grids.size(), kCount);
  EXPECT_EQ(second.kept(), kCount);
  EXPECT_EQ(first.notes, without.notes);
  std::vector<std::string> a = first.notes;
  std::vector<std::string> b = second.notes;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b);
  expectSame(without, first, 1);
  expectSame(first, second, 2);
  for (std::size_t i = 0; i < first.grids.size(); ++i) {
    const LevelSetInfo& made = first.grids[i].info;
    const LevelSetInfo& kept = second.grids[i].info;
    EXPECT_EQ(first.grids[i].what, second.grids[i].what);
    EXPECT_EQ(made.name, kept.name);
    EXPECT_EQ(made.voxel_size, kept.voxel_size);
    EXPECT_EQ(made.half_width, kept.half_width);
    EXPECT_EQ(made.active_voxels, kept.active_voxels);
    EXPECT_EQ(made.bounds.lo, kept.bounds.lo);
    EXPECT_EQ(made.bounds.hi, kept.bounds.hi);
    for (const auto& [key, value] : made.metadata) {
      EXPECT_TRUE(kept.metadata.contains(key)) << key;
      if (!kept.metadata.contains(key)) continue;
      EXPECT_EQ(kept.metadata.at(key), value) << key;
    }
  }
}

// Voxel sizes are stored in the scene's unit: exactly the same number must come back.
TEST_F(KeptGrids, VoxelsOfAnySizeComeBackAsTheyWere) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> size(0.7, 3.0);
  for (int i = 0; i < 12; ++i) {
    std::ostringstream layers;
    layers.precision(i % 3 == 0 ? 3 : 17);
    layers << "images: {seg: {file: labels.nii}}\nlayers:\n  - {name: bone, labels: {image: seg, "
              "match: [1], voxel: "
           << size(random) << "}}\n";
    const Loaded first = load(layers.str());
    const Loaded second = load(layers.str());
    EXPECT_EQ(first.kept(), 0U) << layers.str();
    EXPECT_EQ(second.kept(), 1U) << layers.str();
    expectSame(first, second, 3);
  }
}

TEST_F(KeptGrids, DamagedFilesAreMadeAgain) {
  const std::string layers =
      "images: {seg: {file: labels.nii}}\nlayers:\n"
      "  - {name: flesh, labels: {image: seg, match: [2]}}\n"
      "  - {name: bone, labels: {image: seg, match: [1]}}\n";
  const Loaded first = load(layers);
  const std::vector<fs::path> grids = files(".vdb");
  ASSERT_EQ(grids.size(), 2U);
  const auto text = [](const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  };
  const auto write = [](const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  };
  const fs::path damaged = grids[0];
  const std::string whole = text(damaged);
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return random() % n; };
  std::vector<std::pair<std::string, std::string>> damages = {
      {"empty", ""},
      {"foreign", "palpate kept 1 nothing\n"},
      {"another grid", text(grids[1])},
      {"twice", whole + whole},
      {"more at its end", whole + "\n"},
      {"zeros", std::string(whole.size(), '\0')}};
  for (int i = 0; i < 4; ++i) {
    damages.emplace_back("cut", whole.substr(0, below(whole.size())));
    std::string flipped = whole;
    const std::size_t at = i < 2 ? whole.size() - 1 - below(60) : below(whole.size());
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << below(8)));
    damages.emplace_back("flipped at " + std::to_string(at), flipped);
    std::string lost = whole;
    const std::size_t begin = below(whole.size());
    lost.erase(begin, 1 + below(std::min<std::size_t>(4096, whole.size() - begin)));
    damages.emplace_back("a piece lost", lost);
  }
  for (const auto& [what, bytes] : damages) {
    write(damaged, bytes);
    const Loaded again = load(layers);
    EXPECT_EQ(again.kept(), 1U) << what;
    expectSame(first, again, 5);
    EXPECT_EQ(text(damaged).size(), whole.size()) << what << ": it was not kept anew";
  }
  EXPECT_EQ(load(layers).kept(), 2U);

  // Texts about places are sealed as well.
  for (const fs::path& path : files(".txt")) write(path, "0x1p+9 0 0 0 0 0\n");
  expectSame(first, load(layers), 6);

  // A folder in place of a file.
  fs::remove(damaged);
  fs::create_directory(damaged);
  expectSame(first, load(layers), 7);
  fs::remove(damaged);
  ASSERT_EQ(mkfifo(damaged.c_str(), 0600), 0);
  expectSame(first, load(layers), 8);
}

TEST_F(KeptGrids, WhereNothingCanBeKeptNothingIsWrong) {
  const std::string layers =
      "images: {seg: {file: labels.nii}}\nlayers:\n"
      "  - {name: bone, labels: {image: seg, match: [1]}}\n";
  const Loaded without = load(layers, "");
  (void)folder_.file("file", "not a folder");
  fs::create_directory(folder_.path("open"));
  fs::permissions(folder_.path("open"), fs::perms::all);
  fs::create_symlink(folder_.path("nowhere/at/all"), folder_.path("dangling"));
  for (const char* cache : {"file", "file/below", "open", "dangling"}) {
    for (int i = 0; i < 2; ++i) {
      const Loaded loaded = load(layers, cache);
      EXPECT_EQ(loaded.kept(), 0U) << cache;
      expectSame(without, loaded, 9);
    }
  }
  EXPECT_TRUE(fs::is_empty(folder_.path("open"))) << "anybody could have put a grid there";
  // A link of the user's own to a folder of the user's own is accepted.
  fs::create_directory(folder_.path("elsewhere"));
  fs::permissions(folder_.path("elsewhere"), fs::perms::owner_all);
  fs::create_directory_symlink(folder_.path("elsewhere"), folder_.path("linked"));
  (void)load(layers, "linked");
  EXPECT_EQ(load(layers, "linked").kept(), 1U);
}

TEST_F(KeptGrids, WhateverCountsMakesAnotherGrid) {
  const auto labels = [](const std::string& image, const std::string& layer) {
    return "images: {seg: {" + image + "}}\nlayers:\n  - {name: bone, labels: {image: seg, " +
           layer + "}}\n";
  };
  const auto stone = [](const std::string& more) {
    return "layers:\n  - {name: stone, inside: {mesh: {file: stone.obj, voxel: 1" + more + "}}}\n";
  };
  const auto ct = [](const std::string& what) {
    return "images: {ct: {file: ct.nrrd}}\nlayers:\n  - {name: body, threshold: {image: ct, " +
           what + "}}\n";
  };
  const std::string plain = labels("file: labels.nii", "match: [1]");
  const std::vector<std::string> all = {
      plain,
      labels("file: labels.nii", "match: [2]"),
      labels("file: labels.nii", "match: [1, 2]"),
      labels("file: labels.nii", "match: [1], voxel: 1.25"),
      labels("file: labels.nii", "match: [1], sampler: trilinear"),
      plain + "  - {name: flesh, labels: {image: seg, match: [2]}}\n",
      ct("above: -500"),
      ct("above: -499.5"),
      ct("below: -500"),
      ct("above: -500, keep: all"),
      ct("above: -500, fill: true"),
      stone(""),
      stone(", half_width: 7"),
      stone(", sign: flood"),
      stone(", shell: 4"),
      stone(", smooth: 100"),
      stone(", units: cm")};
  for (const std::string& layers : all) {
    EXPECT_EQ(load(layers).kept(), 0U) << layers;
    const Loaded again = load(layers);
    EXPECT_EQ(again.kept(), again.grids.size()) << layers;
  }
  // The same content under other names counts as the same.
  fs::copy_file(folder_.path("labels.nii"), folder_.path("copy.nii"));
  std::string renamed = labels("file: copy.nii", "match: [1]");
  renamed.replace(renamed.find("bone"), 4, "thigh");
  const Loaded copy = load(renamed);
  ASSERT_EQ(copy.kept(), 1U);
  EXPECT_EQ(copy.grids[0].info.name, "thigh/surface");
  EXPECT_EQ(copy.grids[0].info.metadata.at("layer"), "thigh");
  EXPECT_EQ(copy.grids[0].info.metadata.at("source"), folder_.path("copy.nii"));
  // A changed vertex, and a changed voxel.
  writeStone(10.001);
  EXPECT_EQ(load(stone("")).kept(), 0U);
  std::mt19937 random(11);
  for (int i = 0; i < 3; ++i) {
    float& voxel = labels_.values[random() % labels_.values.size()];
    voxel = voxel == 1.0F ? 2.0F : 1.0F;
    (void)test::writeNifti(labels_, folder_, "labels.nii");
    const Loaded changed = load(plain);
    EXPECT_EQ(changed.kept(), 0U);
    expectSame(load(plain, ""), changed, 12);
  }
}

/// A changed voxel changes the key, in whichever file a format keeps its voxels.
TEST_F(KeptGrids, AVoxelCountsWhereverItsFileIs) {
  const auto raw = [&](const std::string& name, std::uint8_t bone) {
    std::string bytes(std::size_t{12} * 12 * 12, '\0');
    for (std::size_t k = 3; k < 9; ++k) {
      for (std::size_t j = 3; j < 9; ++j) {
        for (std::size_t i = 3; i < 9; ++i) bytes[i + 12 * (j + 12 * k)] = 1;
      }
    }
    bytes[6 + 12 * (6 + 12 * 9)] = static_cast<char>(bone);
    (void)folder_.file(name, bytes);
  };
  fs::create_directory(folder_.path("masks"));
  fs::create_directory(folder_.path("voxels"));
  const std::string mhd =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "DimSize = 12 12 12\nElementSpacing = 1 1 1\nOffset = 0 0 0\nElementType = MET_UCHAR\n"
      "ElementDataFile = ";
  const std::string nhdr =
      "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 12 12 12\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n"
      "endian: little\ndata file: ";
  (void)folder_.file("one.mhd", mhd + "voxels/one.raw\n");
  (void)folder_.file("two.nhdr", nhdr + "voxels/two.raw\n");
  (void)folder_.file("masks/bone.mhd", mhd + "../voxels/three.raw\n");
  const std::vector<std::pair<std::string, std::string>> images = {
      {"one.mhd", "voxels/one.raw"}, {"two.nhdr", "voxels/two.raw"}, {"masks", "voxels/three.raw"}};
  for (const auto& [image, voxels] : images) {
    const std::string layers = "images: {seg: {file: " + image +
                               "}}\nlayers:\n  - {name: bone, labels: {image: seg, match: [1]}}\n";
    raw(voxels, 0);
    const Loaded before = load(layers, "cache_" + image);
    EXPECT_EQ(before.kept(), 0U) << image;
    EXPECT_EQ(load(layers, "cache_" + image).kept(), 1U) << image;
    raw(voxels, 1);
    EXPECT_EQ(load(layers, "cache_" + image).kept(), 0U) << image;
  }
}

// The grids of a bundle are enough, wherever it is and whoever owns it; a missing scan is an error
// only if a layer needs it.
TEST_F(KeptGrids, ABundleStandsForItsScans) {
  const std::string bundle = folder_.path("bundle");
  fs::create_directory(bundle);
  const auto load_from = [&](const std::string& layers, bool fills) {
    return load(layers, "", BundleOptions{bundle, fills});
  };
  const Loaded first = load_from(kLayers, true);
  EXPECT_EQ(first.kept(), 0U);
  (void)folder_.file("labels.scan.yaml", scanStandIn(folder_.path("labels.nii"), {}));
  (void)folder_.file("ct.scan.yaml", scanStandIn(folder_.path("ct.nrrd"), {}));
  fs::remove(folder_.path("labels.nii"));
  fs::remove(folder_.path("ct.nrrd"));
  fs::permissions(bundle, fs::perms::all);  // owned and writable by anybody
  std::string layers = kLayers;
  layers.replace(layers.find("labels.nii"), 10, "labels.scan.yaml");
  layers.replace(layers.find("ct.nrrd"), 7, "ct.scan.yaml");
  const Loaded second = load_from(layers, false);
  EXPECT_EQ(second.kept(), kCount);
  expectSame(first, second, 14);
  layers.replace(layers.find("match: [2]"), 10, "match: [2, 9]");
  try {
    (void)load_from(layers, false);
    ADD_FAILURE() << "the voxels are not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "pack.no_scan") << error.what();
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
  }
  (void)folder_.file("ct.scan.yaml", "name: nothing\n");
  EXPECT_THROW((void)load_from(layers, false), Error);
}

// If this fails because baking has changed, raise kBakerVersion in vdb/src/register.cpp and put the
// new values here: grids that users have kept must not be used in place of newly baked ones.
TEST_F(KeptGrids, WhatIsBakedIsWhatTheBakersVersionStandsFor) {
  const Loaded loaded = load(kLayers, "");
  const test::Limb limb;
  const std::vector<Vec3> places = {
      limb.center + test::Limb::kBody * limb.outwards(0.3),
      limb.center + test::Limb::kBody * limb.outwards(1.0) + 3.0 * limb.axis,
      limb.center + test::Limb::kMuscle * limb.outwards(2.0) - 5.0 * limb.axis,
      limb.center + test::Limb::kBone * limb.outwards(4.0) + 7.0 * limb.axis, Vec3(9.0, 0.5, 0.0)};
  const std::vector<double> golden = {0.140425, -0.004609, -0.695671, -0.404293, -0.285648};
  ASSERT_EQ(golden.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    // Far more than the difference between instruction sets, far less than a change of the method.
    EXPECT_NEAR(loaded.fields[i]->value(places[i] * kMm) / kMm, golden[i], 2e-5) << i;
  }
}

}  // namespace
}  // namespace palpate::vdb
