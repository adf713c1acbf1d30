// palpate import of structures that were segmented one by one: folders and lists of masks, DICOM
// SEG and RTSTRUCT.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>

#include "tools/imported.h"
#include "vdb/nifti_writer.h"
#include "vdb/python_oracle.h"

namespace palpate::testing {
namespace {

constexpr const char* kOracle = "vdb/structures_oracle.py";
constexpr int kSize = 21;

/// Writes a mask to `folder`, with voxels of 1 mm, the middle one at the origin, shifted by `shift`
/// [mm] along x.
void writeMask(const TempFolder& folder, const std::string& name,
               const std::function<bool(int, int, int)>& is_in, double shift = 0.0) {
  vdb::test::NiftiFile file;
  file.dim = {kSize, kSize, kSize};
  constexpr int kMiddle = kSize / 2;
  file.sform = {{{1, 0, 0, shift - kMiddle}, {0, 1, 0, -kMiddle}, {0, 0, 1, -kMiddle}}};
  file.pixdim = {1, 1, 1, 1};
  for (int k = 0; k < kSize; ++k) {
    for (int j = 0; j < kSize; ++j) {
      for (int i = 0; i < kSize; ++i) {
        file.values.push_back(is_in(i - kMiddle, j - kMiddle, k - kMiddle) ? 1.0 : 0.0);
      }
    }
  }
  const auto bytes = vdb::test::gzipped(vdb::test::bytesOf(file));
  (void)folder.file(name,
                    std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// Muscle from 8 mm down along y, and a bone from -3 mm that the muscle's mask contains as well.
void writeLeg(const TempFolder& folder, const std::string& below) {
  std::filesystem::create_directory(folder.path(below));
  const auto from = [](int top) {
    return [top](int x, int y, int z) {
      return std::max(std::abs(x), std::abs(z)) < 10 && y > -10 && y <= top;
    };
  };
  writeMask(folder, below + "/a_vastus muscle.nii.gz", from(8));
  writeMask(folder, below + "/femur.nii.gz", from(-3));
  writeMask(folder, below + "/liver.nii.gz", [](int, int, int) { return false; });
}

/// Voxels of a layer one millimeter thick: 19 along x and along z.
constexpr std::uint64_t kLayer = 19 * 19;

/// Region -> voxels.
std::map<std::string, std::uint64_t> voxelsOf(const Json& json) {
  std::map<std::string, std::uint64_t> out;
  for (const Json& region : json["regions"]) out[region["name"]] = region["voxels"];
  return out;
}

TEST(ImportMasks, AFolderIsASceneThatAHandFeels) {
  const TempFolder folder;
  writeLeg(folder, "segmentations");
  const CommandResult result =
      runPalpate({"import", "segmentations", "-o", "leg.yaml", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_NE(result.err.find("femur has"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("1 of 3 masks have no voxel: liver"), std::string::npos) << result.err;
  EXPECT_EQ(voxelsOf(parseOnly(result)),
            (std::map<std::string, std::uint64_t>{{"a_vastus muscle", 11 * kLayer},
                                                  {"femur", 7 * kLayer}}));
  // The scene names the folder; a needle goes through the muscle and stops at the bone, whose
  // border is at -2.5 mm.
  EXPECT_NE(textOf(folder.path("leg.yaml")).find("labels: {file: \"segmentations\"}"),
            std::string::npos);
  const std::vector<TracedTick> ticks =
      touched(folder, "leg.yaml", {Vec3(0, 12, 0), Vec3(0, -9, 0)}, "20mm/s");
  ASSERT_FALSE(ticks.empty());
  EXPECT_EQ(ticks.back().region, "a_vastus muscle");
  EXPECT_NEAR(ticks.back().proxy.y, -2.5, 0.5);
}

TEST(ImportMasks, ListedOnesAreReadAgainAsTheSceneSays) {
  const TempFolder folder;
  writeLeg(folder, "m");
  const Json json = run(folder, {"import", "m/femur.nii.gz", "m/a_vastus muscle.nii.gz",
                                 "--priority", "a_vastus muscle", "-o", "leg.yaml", "--json"});
  // The muscle gets all voxels that are in both masks, so that nothing is left of the bone.
  EXPECT_EQ(voxelsOf(json),
            (std::map<std::string, std::uint64_t>{{"a_vastus muscle", 18 * kLayer}}));
  const std::string scene = textOf(folder.path("leg.yaml"));
  const std::string with = R"(with: ["m/a_vastus muscle.nii.gz"])";
  EXPECT_NE(
      scene.find(R"({file: "m/femur.nii.gz", )" + with + R"(, priority: ["a_vastus muscle"]})"),
      std::string::npos)
      << scene;
  EXPECT_EQ(run(folder, {"query", "leg.yaml", "--at", "0,0,0", "--json"})["points"][0]["region"],
            "a_vastus muscle");
  // A scene in which a single word replaces a list is refused, with the place.
  std::string wrong = scene;
  ASSERT_NE(wrong.find(with), std::string::npos);
  wrong.replace(wrong.find(with), with.size(), "with: m/femur.nii.gz");
  (void)folder.file("wrong.yaml", wrong);
  const CommandResult refused = runPalpate({"explain", "wrong.yaml"}, folder.path());
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("wrong.yaml:"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("list of texts"), std::string::npos) << refused.err;
}

TEST(ImportMasks, OnShiftedGridsEndWithTheShiftAndNoFile) {
  const TempFolder folder;
  writeMask(folder, "a.nii.gz", [](int x, int, int) { return x > 0; });
  writeMask(
      folder, "b.nii.gz", [](int x, int, int) { return x < 0; }, 2.5);
  const CommandResult result =
      runPalpate({"import", "a.nii.gz", "b.nii.gz", "-o", "s.yaml", "--json"}, folder.path());
  EXPECT_EQ(result.exit_code, 3);
  const Json json = parseOnly(result);
  EXPECT_EQ(json["error"]["code"], "masks.grid");
  EXPECT_NE(json["error"]["message"].get<std::string>().find("(2.5, 0, 0) mm"), std::string::npos)
      << result.out;
  EXPECT_EQ(filesIn(folder.path()), (std::vector<std::string>{"a.nii.gz", "b.nii.gz"}));
}

TEST(ImportMasks, ADicomSegmentationHasTissuesByItsCodes) {
  const TempFolder folder;
  writeMask(folder, "ball.nii.gz", [](int x, int y, int z) { return x * x + y * y + z * z < 50; });
  (void)vdb::test::askScript(kOracle, "write_seg",
                             {folder.path("ball.nii.gz"), "binary", folder.path("seg.dcm")});
  const Json json = run(folder, {"import", "seg.dcm", "-o", "s.yaml", "--json"});
  ASSERT_EQ(json["regions"].size(), 1U);
  // Its name "part 1" tells nothing; its SNOMED code is that of the liver.
  EXPECT_EQ(json["regions"][0]["name"], "part 1");
  EXPECT_EQ(json["regions"][0]["tissue"], "liver");
  EXPECT_EQ(run(folder, {"query", "s.yaml", "--at", "0,0,0", "--json"})["points"][0]["region"],
            "part 1");
}

}  // namespace
}  // namespace palpate::testing
