#include "safety_report.h"

#include "text.h"

namespace palpate::tools {

Json safetyJson(const devices::ServoReport& servo) {
  const devices::SafetyCounts& counts = servo.safety;
  return {{"state", devices::nameOf(servo.state)},
          {"fault", devices::textOf(servo.fault)},
          {"stale", servo.stale},
          {"jumps", counts.jumps},
          {"not_finite", counts.zeroed},
          {"shortened", counts.shortened},
          {"held_back_by_heat", counts.warm},
          {"heat", counts.heat},
          {"hangs", counts.hangs}};
}

std::string safetyText(const devices::ServoReport& servo) {
  const devices::SafetyCounts& counts = servo.safety;
  std::string text;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(servo.stale, "turns without a reading");
  add(counts.jumps, "jumps dropped");
  add(counts.zeroed, "forces not finite");
  add(counts.shortened, "forces shortened");
  add(counts.warm, "forces held back by the motors' heat");
  add(counts.hangs, "hangs of the loop");
  return "Safety      ended " + std::string(devices::nameOf(servo.state)) + "; heat up to " +
         formatNumber(1e2 * counts.heat, 3) + " %" + (text.empty() ? "" : "; ") + text + "\n";
}

}  // namespace palpate::tools
