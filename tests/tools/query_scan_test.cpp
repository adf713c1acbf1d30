// palpate query at points of an oblique scan, compared with nibabel and scipy.

#include <cmath>

#include "palpate/vdb/image.h"
#include "support/scan_folder.h"
#include "tools/helpers.h"
#include "vdb/made_scans.h"
#include "vdb/python_oracle.h"

namespace palpate::testing {
namespace {

void expectTenPointsAsScipyHasThem(const std::string& scan) {
  const vdb::Image image = vdb::readNifti(scan);
  const Vec3 last(image.size[0] - 1, image.size[1] - 1, image.size[2] - 1);

  // Ten places well inside, at whole thousandths of a millimeter so that both programs parse the
  // same numbers.
  std::vector<std::string> arguments{"query", scan, "--json", "--at"};
  std::string lines;
  for (int i = 0; i < 10; ++i) {
    const Vec3 share(0.3 + 0.04 * i, 0.7 - 0.03 * i, 0.35 + 0.031 * i);
    const Vec3 p = image.toWorld(share * last) * 1e3;
    char text[96];
    std::snprintf(text, sizeof text, "%.3f,%.3f,%.3f", p.x, p.y, p.z);
    arguments.emplace_back(text);
    std::string row = text;
    std::replace(row.begin(), row.end(), ',', ' ');
    lines += row + "\n";
  }
  const TempFolder folder;
  const auto expected =
      vdb::test::askPython("interpolate", {scan, folder.file("points.txt", lines)});
  ASSERT_EQ(expected.size(), 10U);

  const CommandResult result = runPalpate(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parseOnly(result);
  ASSERT_EQ(json["points"].size(), 10U);
  double brightest = 0.0;
  for (std::size_t i = 0; i < 10; ++i) {
    // The same formula in the same precision; gray values reach some hundreds.
    EXPECT_NEAR(json["points"][i]["value"].get<double>(), expected[i].at(0), 1e-8) << i;
    brightest = std::max(brightest, expected[i][0]);
  }
  EXPECT_GT(brightest, 50.0);  // this is not a comparison of background only
}

TEST(QueryScan, TenPointsOfAMadeLimbAreAsScipyHasThem) {
  const TempFolder folder;
  expectTenPointsAsScipyHasThem(vdb::test::writeNifti(
      vdb::test::Limb().scan(vdb::test::obliqueAxes(Vec3(-1, 1.3, 2))), folder, "limb.nii.gz"));
}

TEST(QueryScan, TenPointsOfAnObliqueScanAreAsScipyHasThem) {
  const std::string scan = scanPath("orientation_pair/FLAIR.nii.gz");
  PALPATE_NEEDS_SCAN(scan);
  expectTenPointsAsScipyHasThem(scan);
}

}  // namespace
}  // namespace palpate::testing
