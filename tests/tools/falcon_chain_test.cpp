// `palpate touch` with a Falcon that is not there, behind the libusb that everybody uses: from the command line to the kernel.

// A sanitizer wants to be loaded before all others itself.
#if defined(PALPATE_LIBUSB) && !defined(__SANITIZE_ADDRESS__)

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <utility>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

using Triple = std::array<double, 3>;

/// The three numbers from column `first` on of each row after `head` rows.
std::vector<Triple> triples(const std::string& file, std::size_t head, int first) {
  std::vector<Triple> out;
  const std::vector<std::string> rows = linesOf(textOf(file));
  for (std::size_t i = head; i < rows.size(); ++i) {
    std::istringstream row(rows[i]);
    std::string cell;
    Triple values{};
    for (int column = 0; column < first + 3 && std::getline(row, cell, ','); ++column) {
      if (column >= first) values[static_cast<std::size_t>(column - first)] = std::stod(cell);
    }
    out.push_back(values);
  }
  return out;
}

double length(const Triple& v) { return std::hypot(v[0], v[1], v[2]); }
double distance(const Triple& a, const Triple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Variables of the environment, for as long as it lives.
class Environment {
 public:
  explicit Environment(std::vector<std::pair<std::string, std::string>> variables)
      : variables_(std::move(variables)) {
    for (const auto& [name, value] : variables_) setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (const auto& each : variables_) unsetenv(each.first.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::pair<std::string, std::string>> variables_;
};

class FalconChain : public ::testing::Test {
 protected:
  /// The command with a Falcon on descriptor 100, in the Falcon's time. At command `at` the process gets `signal`, or the cable
  /// is pulled if that is 0.
  CommandResult run(std::vector<std::string> arguments, std::size_t at = 1'000'000,
                    int signal = 0) {
    for (const char* more : {"--device", "falcon", "--descriptor", "100"}) {
      arguments.emplace_back(more);
    }
    const Environment world(
        {{"LD_PRELOAD", test::buildFolder() + "/tests/libpalpate_fake_falcon.so"},
         {"FAKE_FALCON_LOG", folder_.path() + "/motors"},
         {"FAKE_FALCON_AT", std::to_string(at)},
         {"FAKE_FALCON_SIGNAL", std::to_string(signal)}});
    return runPalpate(arguments, folder_.path());
  }
  TempFolder folder_;
};

TEST_F(FalconChain, InByTheMouthAlongTheWallAndOutAndTheMotorsGiveWhatTheSceneAsks) {
  const std::string scene = test::sourceFolder() + "/data/scenes/container.yaml";
  const CommandResult result = run({"touch", scene, "--seconds", "5.2", "--trace", "felt.csv",
                                    "--record", "felt.npy", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const Json report = parseOnly(result);
  EXPECT_EQ(report["device"]["simulated"], false);
  EXPECT_EQ(report["safety"]["state"], "active");
  EXPECT_EQ(report["safety"]["fault"], "no fault");
  std::vector<std::string> regions;
  for (const Json& visit : report["regions"]) regions.push_back(visit["region"]);
  EXPECT_EQ(regions, (std::vector<std::string>{"outside", "liquid", "outside"}));

  const std::vector<Triple> asked = triples(folder_.path() + "/felt.csv", 1, 7);
  const std::vector<Triple> given = triples(folder_.path() + "/motors", 0, 0);
  ASSERT_GT(asked.size(), 5000U);
  double most = 0.0;
  // Set-up sends a few commands before the first tick's.
  double best = 1e9;
  for (std::size_t offset = 0; offset < 10; ++offset) {
    double worst = 0.0;
    for (std::size_t i = 0; i < asked.size() && i + offset < given.size(); ++i) {
      most = std::max(most, length(asked[i]));
      // Half a count of each motor is 0.5e-4 Nm, at 20 to 30 rad/m; and the arms are taken where the encoders say, which
      // turns a force by less than two parts in a thousand.
      const double allowed = 3e-3 + 2e-3 * length(asked[i]);
      worst = std::max(worst, distance(asked[i], given[i + offset]) / allowed);
    }
    best = std::min(best, worst);
  }
  EXPECT_LE(best, 1.0);
  EXPECT_GT(most, 2.0) << "the bottom, from inside";
  for (std::size_t i = given.size() - 3; i < given.size(); ++i) EXPECT_EQ(length(given[i]), 0.0);

  // The same hand, felt anew without a device: the same forces, bit for bit.
  EXPECT_EQ(runPalpate({"replay", "felt.npy"}, folder_.path()).exit_code, 0);
}

// At command 2700 the bowl's bottom is pressed from inside.
constexpr std::size_t kPressed = 2700;

TEST_F(FalconChain, AStopAndAPulledCableEndItWithZeroForceAndTheRecordKept) {
  const std::string scene = test::sourceFolder() + "/data/scenes/container.yaml";
  struct Case {
    int signal;  ///< 0: the cable
    int exit_code;
    const char* code;
  };
  for (const Case& each : {Case{SIGINT, 130, "cancelled"}, Case{SIGTERM, 130, "cancelled"},
                           Case{0, 4, "device.disconnected"}}) {
    const CommandResult result =
        run({"touch", scene, "--force", "--record", "felt.npy", "--json"}, kPressed, each.signal);
    EXPECT_EQ(result.exit_code, each.exit_code) << result.err << result.out;
    EXPECT_EQ(parseOnly(result)["error"]["code"], each.code);
    const std::vector<Triple> given = triples(folder_.path() + "/motors", 0, 0);
    ASSERT_GE(given.size(), kPressed);
    EXPECT_GT(length(given[kPressed - 1]), 0.5);
    if (each.signal != 0) {
      // The command that is under way, and zero from the next on.
      ASSERT_GT(given.size(), kPressed + 2);
      for (std::size_t i = kPressed + 2; i < given.size(); ++i) EXPECT_EQ(length(given[i]), 0.0);
    }
    EXPECT_EQ(runPalpate({"replay", "felt.npy"}, folder_.path()).exit_code, 0);
  }
}

}  // namespace
}  // namespace palpate::testing

#endif
