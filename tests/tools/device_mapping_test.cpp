// A device with its own axes, scale and force scale, through the command.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

class MappedDevice : public ::testing::Test {
 protected:
  MappedDevice() {
    (void)folder_.file("m.yaml",
                       std::string(kContainer) +
                           "device: {offset: [1, 2, -3], rotate: {axis: [0, 0, 1], "
                           "degrees: 90}, scale: 0.25, force: 2, workspace: {box: {center: "
                           "[0, 0, 0], size: [800, 800, 800]}}}\n");
  }
  TempFolder folder_;
};

TEST_F(MappedDevice, ItsPathIsFeltAsThatOfTheWorldIs) {
  std::string world = "t,x,y,z\n";
  std::string device = "t,device_x,device_y,device_z\n";
  for (int n = 0; n < 400; ++n) {
    // The path goes into the mouth and around below it, against the bowl.
    const double s = n / 400.0;
    const double x = 0.035 * s * std::sin(9.0 * s);
    const double y = 0.03 * s;
    const double z = 0.03 - 0.06 * s;
    const std::string t = std::to_string(0.001 * n);
    std::ostringstream of_world;
    std::ostringstream of_device;
    of_world.precision(17);
    of_device.precision(17);
    of_world << t << "," << x << "," << y << "," << z << "\n";
    // Converted back by a rotation of -90 degrees about z, (x, y) to (y, -x), and a factor of four.
    of_device << t << "," << 4.0 * (y - 0.002) << "," << -4.0 * (x - 0.001) << ","
              << 4.0 * (z + 0.003) << "\n";
    world += of_world.str();
    device += of_device.str();
  }
  (void)folder_.file("w.csv", world);
  (void)folder_.file("d.csv", device);
  for (const std::string name : {"w", "d"}) {
    const CommandResult result =
        runPalpate({"touch", "m.yaml", "--path", name + ".csv", "--trace", name + "_trace.csv"},
                   folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  const auto by_world = linesOf(textOf(folder_.path("w_trace.csv")));
  const auto by_device = linesOf(textOf(folder_.path("d_trace.csv")));
  ASSERT_EQ(by_world.size(), 401U);
  ASSERT_EQ(by_device.size(), 401U);
  double most = 0.0;
  for (std::size_t i = 1; i < by_world.size(); ++i) {
    const auto one = cellsOf(by_world[i]);
    const auto other = cellsOf(by_device[i]);
    for (std::size_t k = 0; k < 10; ++k) {
      // Rounding of positions of 0.2 m is 3e-17 m. A step into a wall ends within a share of the
      // wall's feature size of 40 mm, which may add as much at each step: 1e-12 m, times 1.5 kN/m
      // of the wall or 4 N s/m over a millisecond.
      const double allowed = k < 4 ? 1e-15 : k < 7 ? 1e-12 : 4e-9;
      EXPECT_NEAR(std::stod(one[k]), std::stod(other[k]), allowed)
          << "row " << i << " column " << k;
    }
    for (const std::size_t k : {10U, 11U, 12U}) EXPECT_EQ(one[k], other[k]) << "row " << i;
    most = std::max(most, std::fabs(std::stod(one[8])));
  }
  EXPECT_GT(most, 0.5);
}

TEST_F(MappedDevice, ExplainSaysHowItLiesAndWhatItsHandFeels) {
  const CommandResult json = runPalpate({"explain", "m.yaml", "--json"}, folder_.path());
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const Json device = parseOnly(json)["device"];
  EXPECT_EQ(device["scale"], 0.25);
  EXPECT_EQ(device["force"], 2.0);
  EXPECT_EQ(device["stiffness_at_hand"], 0.5);
  // The device's x is the world's y, and its y the world's -x.
  const std::vector<std::vector<double>> axes = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(device["axes"][axis][k].get<double>(), axes[axis][k], 1e-15);
    }
  }
  const std::string text = runPalpate({"explain", "m.yaml"}, folder_.path()).out;
  EXPECT_NE(text.find("The device reaches from (-99, -98, -103) to (101, 102, 97)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("The device's x, y and z point along (0, 1, 0), (-1, 0, 0) and (0, 0, 1)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("At the hand a stiffness is 0.5 times that of the scene"), std::string::npos)
      << text;
}

}  // namespace
}  // namespace palpate::testing
