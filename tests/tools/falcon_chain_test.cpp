// `palpate touch` with an emulated Falcon behind the usual libusb: everything from the command line
// to the kernel.

// The hand of the emulated Falcon follows a path, held by a spring of 250 N/m.

// A sanitizer's runtime must itself be loaded before all other libraries.
#if defined(PALPATE_LIBUSB) && !defined(__SANITIZE_ADDRESS__)

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "palpate/core/math.h"
#include "palpate/devices/falcon.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

using Numbers = std::vector<double>;

/// The `count` numbers from column `first` on, of each row after the first `head` rows.
std::vector<Numbers> columns(const std::string& file, std::size_t head, std::size_t first,
                             std::size_t count) {
  std::vector<Numbers> out;
  const std::vector<std::string> rows = linesOf(textOf(file));
  for (std::size_t i = head; i < rows.size(); ++i) {
    const std::vector<std::string> cells = cellsOf(rows[i]);
    Numbers& numbers = out.emplace_back();
    for (std::size_t k = first; k < first + count; ++k) numbers.push_back(std::stod(cells.at(k)));
  }
  return out;
}

double length(const Numbers& v) { return std::hypot(v[0], v[1], v[2]); }
double distance(const Numbers& a, const Numbers& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Rotation of a scene's `device` about `axis`, by the right-hand rule.
struct Turn {
  Vec3 axis{0.0, 0.0, 1.0};
  double degrees = 0.0;

  /// A force in the world's frame, converted to the device's frame.
  [[nodiscard]] Numbers toDevice(const Numbers& force) const {
    const Vec3 f(force[0], force[1], force[2]);
    const Vec3 k = glm::normalize(axis);
    const double angle = -degrees * std::numbers::pi / 180.0;
    const Vec3 turned = std::cos(angle) * f + std::sin(angle) * glm::cross(k, f) +
                        (1.0 - std::cos(angle)) * glm::dot(k, f) * k;
    return {turned.x, turned.y, turned.z};
  }
};

/// Sets environment variables as long as it exists.
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
  /// Runs the command with a Falcon on descriptor 100, in the Falcon's time. At command `at` the
  /// process gets `signal`, or the cable is unplugged if that is 0.
  CommandResult run(std::vector<std::string> arguments, std::size_t at = 1'000'000,
                    int signal = 0) {
    if (arguments.front() == "touch") arguments.insert(arguments.end(), {"--device", "falcon"});
    arguments.insert(arguments.end(), {"--descriptor", "100"});
    const Environment world(
        {{"LD_PRELOAD", test::buildFolder() + "/tests/libpalpate_fake_falcon.so"},
         {"FAKE_FALCON_HAND", folder_.path() + "/hand"},
         {"FAKE_FALCON_LOG", folder_.path() + "/motors"},
         {"FAKE_FALCON_AT", std::to_string(at)},
         {"FAKE_FALCON_SIGNAL", std::to_string(signal)}});
    return runPalpate(arguments, folder_.path());
  }

  static std::vector<std::string> regionsOf(const Json& report) {
    std::vector<std::string> out;
    for (const Json& visit : report["regions"]) out.push_back(visit["region"]);
    return out;
  }

  /// Feels `scene` with the Falcon for `seconds`, reaching `most` [N] or more somewhere, and again
  /// with the virtual device on the same path of the hand: the motors must have given the virtual
  /// device's forces. Returns the report.
  Json feel(const std::string& scene, const std::string& seconds, double most,
            const Turn& turn = {}) {
    const CommandResult result = run({"touch", scene, "--seconds", seconds, "--trace", "felt.csv",
                                      "--record", "felt.npy", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
    if (result.exit_code != 0) return {};
    Json report = parseOnly(result);
    EXPECT_EQ(report["device"]["simulated"], false);
    EXPECT_EQ(report["safety"]["state"], "active");
    EXPECT_EQ(report["safety"]["fault"], "no fault");
    EXPECT_EQ(report["realtime"]["clock"], "device");
    EXPECT_FALSE(report["realtime"].contains("late_ns")) << "nothing says when a reply was due";

    std::string path = "t,x,y,z\n";
    const std::vector<std::string> rows = linesOf(textOf(folder_.path("felt.csv")));
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const std::vector<std::string> cells = cellsOf(rows[i]);
      path += cells[0] + "," + cells[1] + "," + cells[2] + "," + cells[3] + "\n";
    }
    (void)folder_.file("way.csv", path);
    const CommandResult again = runPalpate(
        {"touch", scene, "--path", "way.csv", "--trace", "virtual.csv", "--json"}, folder_.path());
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(regionsOf(parseOnly(again)), regionsOf(report));

    std::vector<Numbers> asked = columns(folder_.path("virtual.csv"), 1, 7, 3);
    for (Numbers& force : asked) force = turn.toDevice(force);
    const std::vector<Numbers> given = columns(folder_.path("motors"), 0, 0, 4);
    EXPECT_GT(asked.size(), 5000U);
    EXPECT_EQ(asked.size() + 1, rows.size());
    double largest = 0.0;
    double best = kInfinity;
    // Set-up sends a few commands before that of the first tick.
    for (std::size_t offset = 0; offset < 10; ++offset) {
      double worst = 0.0;
      for (std::size_t i = 0; i < asked.size() && i + offset < given.size(); ++i) {
        largest = std::max(largest, length(asked[i]));
        // Half a count of each motor, in N at that place. The arms are taken to be where the
        // encoders say, which turns a force by less than two parts in a thousand.
        const double allowed = given[i + offset][3] + 2e-3 * length(asked[i]);
        worst = std::max(worst, distance(asked[i], given[i + offset]) / allowed);
      }
      best = std::min(best, worst);
    }
    EXPECT_LE(best, 1.0);
    EXPECT_GT(largest, most);
    std::printf("  at most %.2f N; motors against the virtual device: %.2f of the packet's step\n",
                largest, best);
    for (std::size_t i = given.size() - 3; i < given.size(); ++i) EXPECT_EQ(length(given[i]), 0.0);
    return report;
  }

  TempFolder folder_;
};

/// From 30 mm above the middle to 60 mm below it and back: through the container's mouth to its
/// bottom.
constexpr const char* kToTheBottom = "0.8 0.005 0 0.03\n2.8 0.005 0 -0.06\n4.8 0.005 0 0.03\n";

TEST_F(FalconChain, InByTheMouthAlongTheWallAndOutAndTheMotorsGiveWhatTheSceneAsks) {
  (void)folder_.file("hand", kToTheBottom);
  const Json report = feel(scenePath("container.yaml"), "5.2", 2.0);
  EXPECT_EQ(regionsOf(report), (std::vector<std::string>{"outside", "liquid", "outside"}));
  // Replayed from the record: the same forces, bit for bit.
  EXPECT_EQ(runPalpate({"replay", "felt.npy"}, folder_.path()).exit_code, 0);
}

// The hand goes through the incision and the opened dura 15 mm deep into the brain, 14 mm sideways,
// back against the dura from inside, and by the first way into the thalamus and out again. The path
// is in the scene's device frame, whose z points out of the head.
TEST_F(FalconChain, IntoAScannedHeadAgainstTheDuraFromInsideIntoTheThalamusAndOut) {
  (void)folder_.file("hand",
                     "0.8 0 0 0.042\n1.8 0 0 -0.004\n2.3 0.0037 -0.0135 -0.004\n"
                     "3.3 0.0037 -0.0135 0.024\n4.3 0.0037 -0.0135 -0.004\n4.8 0 0 -0.004\n"
                     "5.6 0 0 -0.043\n6.4 0 0 -0.004\n7.6 0 0 0.042\n");
  const Json report = feel(scenePath("head.yaml"), "8.2", 1.0, {Vec3(24.0, -88.0, 0.0), 60.3});
  EXPECT_EQ(regionsOf(report), (std::vector<std::string>{"outside", "skin", "brain", "thalamus",
                                                         "brain", "skin", "outside"}));
  // Beside the opening the dura holds the hand in. The hand's spring and the wall's 400 N/m are in
  // series: the proxy stays at the wall, 1 mm or more in front of the hand.
  double most_held = 0.0;
  for (const std::string& line : linesOf(textOf(folder_.path("felt.csv")))) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells[10] != "brain" || cells[11] != "1") continue;
    most_held = std::max(most_held, std::hypot(std::stod(cells[1]) - std::stod(cells[4]),
                                               std::stod(cells[2]) - std::stod(cells[5]),
                                               std::stod(cells[3]) - std::stod(cells[6])));
  }
  EXPECT_GT(most_held, 1e-3);
}

TEST_F(FalconChain, ASelfTestAndACalibrationReadWhereTheGripIsHeldAndPushNobody) {
  (void)folder_.file("hand", "0 0.01 0 0.005\n");
  const CommandResult tested = run({"devices", "--test", "falcon", "--seconds", "2", "--json"});
  ASSERT_EQ(tested.exit_code, 0) << tested.err << tested.out;
  const Json result = parseOnly(tested)["result"];
  EXPECT_EQ(result["state"], "active");
  EXPECT_EQ(result["fault"], "no fault");
  EXPECT_EQ(result["jumps"], 0);
  // One reply in each millisecond of the Falcon's time, which also advances by half a microsecond
  // at each look at the clock, some of them in each turn.
  EXPECT_NEAR(result["ticks"].get<double>(), 1950.0, 50.0);
  EXPECT_NEAR(result["interval_ns"]["p50"].get<double>(), 1.05e6, 0.05e6);

  const CommandResult calibrated = run({"devices", "--calibrate", "constants", "--seconds", "2"});
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.err;
  const devices::FalconCalibration read = devices::readFalconCalibration(folder_.path("constants"));
  // Half a count of each arm is at most 0.1 mm.
  EXPECT_LT(glm::length(read.origin - Vec3(0.01, 0.0, 0.13)), 1e-4);
  for (const Numbers& force : columns(folder_.path("motors"), 0, 0, 4)) {
    ASSERT_EQ(length(force), 0.0);
  }
}

// At command 2700 the hand presses on the bowl's bottom from inside.
constexpr std::size_t kPressed = 2700;

TEST_F(FalconChain, AStopAndAPulledCableEndItWithZeroForceAndTheRecordKept) {
  (void)folder_.file("hand", kToTheBottom);
  const std::string scene = scenePath("container.yaml");
  struct Case {
    int signal;  ///< 0: unplug the cable
    int exit_code;
    const char* code;
  };
  for (const Case& each : {Case{SIGINT, 130, "cancelled"}, Case{SIGTERM, 130, "cancelled"},
                           Case{0, 4, "device.disconnected"}}) {
    const CommandResult result =
        run({"touch", scene, "--force", "--record", "felt.npy", "--json"}, kPressed, each.signal);
    EXPECT_EQ(result.exit_code, each.exit_code) << result.err << result.out;
    EXPECT_EQ(parseOnly(result)["error"]["code"], each.code);
    const std::vector<Numbers> given = columns(folder_.path("motors"), 0, 0, 4);
    ASSERT_GE(given.size(), kPressed);
    EXPECT_GT(length(given[kPressed - 1]), 0.5);
    if (each.signal != 0) {
      // The command that is being sent may keep its force; all later ones must be zero.
      ASSERT_GT(given.size(), kPressed + 2);
      for (std::size_t i = kPressed + 2; i < given.size(); ++i) EXPECT_EQ(length(given[i]), 0.0);
    }
    EXPECT_EQ(runPalpate({"replay", "felt.npy"}, folder_.path()).exit_code, 0);
  }
}

}  // namespace
}  // namespace palpate::testing

#endif
