#include "open_device.h"

#include <cmath>
#include <string_view>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/device_presets.h"
#include "real_device.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr std::string_view kSimulated = "virtual:";

/// The preset for a name given on the command line.
const devices::DevicePreset& presetOf(const DeviceOptions& options) {
  if (isInputDevice(options.name)) {
    throw Error(ErrorKind::kUsage,
                {"usage.device", options.name + " has no motors, so there is no model of it",
                 "name a model: touch, premium_1_5, omega_3, ..."});
  }
  if (options.name == "hd" || options.name == "dhd") {
    throw Error(
        ErrorKind::kUsage,
        {"usage.device",
         options.name + " stands for any device that its maker's library finds, not for one model",
         "name the model: touch, premium_1_5, omega_3, ..."});
  }
  const bool is_prefixed = options.name.rfind(kSimulated, 0) == 0;
  return devices::devicePreset(is_prefixed ? options.name.substr(kSimulated.size()) : options.name);
}

/// Whether a model of the device is known; the device may be simulated or real.
bool hasModel(const DeviceOptions& options) {
  const std::string& name = options.name;
  return !name.empty() && name != "hd" && name != "dhd" && !isInputDevice(name);
}

std::string handName(const DeviceOptions& options) {
  return options.hand.empty() ? "relaxed" : options.hand;
}

/// The same motion in the device's own space.
Motion inDevice(Motion motion, const DeviceMapping& mapping, double rate) {
  if (motion.formula) {
    const devices::PathFormula world = std::move(*motion.formula);
    const std::size_t last = world.size() - 1;
    const auto position = [world, mapping, rate](double t) {
      return toDevice(mapping, world.at(static_cast<std::size_t>(std::llround(t * rate))).position);
    };
    motion.formula =
        devices::PathFormula(last, rate, toDevice(mapping, world.at(last).position), position);
  } else if (motion.recorded.frame == devices::DeviceFrame::kWorld) {
    for (devices::PathPoint& point : motion.recorded.points) {
      point.position = toDevice(mapping, point.position);
    }
    motion.recorded.frame = devices::DeviceFrame::kDevice;
  }
  return motion;
}

bool staysWithin(const Motion& motion, const Box3& box) {
  const std::size_t size = motion.formula ? motion.formula->size() : motion.recorded.points.size();
  for (std::size_t i = 0; i < size; ++i) {
    const Vec3 p =
        motion.formula ? motion.formula->at(i).position : motion.recorded.points[i].position;
    if (!box.contains(p)) return false;
  }
  return true;
}

/// "45 g (not verified)"
std::string quantityText(const devices::Quantity& quantity, double per_unit, const char* unit) {
  return formatNumber(quantity.value * per_unit, 4) + " " + unit +
         std::string(devices::markOf(quantity.known));
}

Json quantityJson(const devices::Quantity& quantity) {
  const char* known = "assumed";
  if (quantity.known == devices::Known::kSourced) known = "sourced";
  if (quantity.known == devices::Known::kUnverified) known = "not verified";
  return {{"value", quantity.value}, {"known", known}, {"source", std::string(quantity.source)}};
}

}  // namespace

Vec3 toDevice(const DeviceMapping& mapping, const Vec3& world) {
  return glm::transpose(mapping.rotation) * (world - mapping.offset) / mapping.scale;
}

std::optional<devices::SimulationSettings> simulationOf(const DeviceOptions& options, double rate) {
  if (options.name.empty()) {
    if (options.hand.empty() && !options.delay) return std::nullopt;
    throw Error(ErrorKind::kUsage,
                {"usage.device", "--hand and --delay need a device", "add --device NAME"});
  }
  devices::SimulationSettings settings{.device = presetOf(options).model(),
                                       .hand = devices::handPreset(handName(options)),
                                       .rate = rate,
                                       .delay = options.delay.value_or(0)};
  return settings;
}

devices::LoopModel loopOf(const devices::SimulationSettings& simulation) {
  devices::LoopModel loop;
  loop.device = simulation.device;
  loop.hand = simulation.hand;
  loop.period = 1.0 / simulation.rate;
  loop.delay = simulation.delay;
  return loop;
}

std::optional<devices::LoopModel> touchLoop(const TouchOptions& options) {
  if (!hasModel(options.device)) return std::nullopt;
  return loopOf(*simulationOf(options.device, options.rate));
}

void checkDevice(const TouchOptions& options) {
  if (isRealDevice(options.device.name)) {
    if (!options.device.hand.empty() || options.device.delay) {
      throw Error(
          ErrorKind::kUsage,
          {"usage.device", "--hand and --delay apply to simulated devices only",
           options.device.name + " is held by a real hand; --device virtual:NAME is simulated"});
    }
    return;
  }
  const std::string given = options.seconds ? "--seconds" : givenOption(options.real);
  if (!given.empty()) {
    throw Error(ErrorKind::kUsage, {"usage.device", given + " applies to devices that a hand holds",
                                    "add --device falcon, inverse3, hd, dhd or evdev"});
  }
  const bool is_simulated = simulationOf(options.device, options.rate).has_value();
  if (is_simulated && options.as_recorded) {
    throw Error(ErrorKind::kUsage,
                {"usage.device",
                 "--as-recorded cannot be used with a device: no device can follow the faults "
                 "of a record",
                 "leave out --device or --as-recorded"});
  }
}

std::unique_ptr<devices::Device> makeDevice(const TouchOptions& options, Motion motion,
                                            const DeviceMapping& mapping, Console& console) {
  auto settings = simulationOf(options.device, options.rate);
  if (!settings) {
    if (motion.formula) return std::make_unique<devices::VirtualDevice>(std::move(*motion.formula));
    return std::make_unique<devices::VirtualDevice>(std::move(motion.recorded.points),
                                                    motion.recorded.frame, motion.rules);
  }
  settings->realtime = options.realtime;
  motion = inDevice(std::move(motion), mapping, options.rate);
  if (!staysWithin(motion, settings->device.workspace)) {
    const Vec3 size = 1e3 * settings->device.workspace.size();
    console.warn(
        "the motion leaves the workspace of " + settings->device.name + " (" +
        formatVector(size, 3) +
        " mm about the device's origin), whose end stops are not simulated; the key `device` of "
        "a scene places the workspace");
  }
  if (motion.formula) {
    return std::make_unique<devices::SimulatedDevice>(*settings, std::move(*motion.formula));
  }
  return std::make_unique<devices::SimulatedDevice>(*settings, std::move(motion.recorded.points));
}

Json deviceJson(const DeviceOptions& options, double rate) {
  if (options.name.empty()) return {};
  if (isRealDevice(options.name)) {
    return {{"name", options.name}, {"simulated", false}, {"notice", noticeOf(options.name)}};
  }
  const devices::DevicePreset& preset = presetOf(options);
  Json json = {{"name", std::string(preset.name)},
               {"title", std::string(preset.title)},
               {"simulated", true},
               {"rate_Hz", rate},
               {"delay_samples", options.delay.value_or(0)},
               {"mass_kg", quantityJson(preset.mass)},
               {"damping_N_s_per_m", quantityJson(preset.damping)},
               {"friction_N", quantityJson(preset.friction)},
               {"encoder_m", quantityJson(preset.encoder)},
               {"max_force_N", quantityJson(preset.max_force)},
               {"workspace_m", Json::array({quantityJson(preset.width), quantityJson(preset.height),
                                            quantityJson(preset.depth)})},
               {"lag_s", quantityJson({0.0, devices::Known::kAssumed, "no source gives one"})}};
  const auto hand = devices::handPreset(handName(options));
  json["hand"] = !hand ? Json()
                       : Json{{"name", hand->name},
                              {"known", "assumed"},
                              {"mass_kg", hand->mass},
                              {"damping_N_s_per_m", hand->damping},
                              {"stiffness_N_per_m", hand->stiffness},
                              {"grip_stiffness_N_per_m", hand->grip_stiffness},
                              {"grip_damping_N_s_per_m", hand->grip_damping}};
  return json;
}

std::string deviceText(const DeviceOptions& options) {
  if (options.name.empty()) return {};
  if (isRealDevice(options.name)) {
    return "Device      " + options.name + ": " + noticeOf(options.name) + "\n";
  }
  const devices::DevicePreset& preset = presetOf(options);
  std::string text = "Device      " + std::string(preset.title) +
                     ", simulated: " + quantityText(preset.mass, 1.0, "kg") + ", " +
                     quantityText(preset.damping, 1.0, "N.s/m") + ", friction " +
                     quantityText(preset.friction, 1.0, "N") + ", encoder " +
                     quantityText(preset.encoder, 1e3, "mm") + ", at most " +
                     quantityText(preset.max_force, 1.0, "N") + "\n";
  const auto hand = devices::handPreset(handName(options));
  if (!hand) return text + "Hand        none: nobody holds it\n";
  return text + "Hand        " + hand->name + " (assumed): " + formatNumber(hand->mass) + " kg, " +
         formatNumber(hand->stiffness) + " N/m and " + formatNumber(hand->damping) +
         " N.s/m to the path; grip " + formatNumber(hand->grip_stiffness) + " N/m and " +
         formatNumber(hand->grip_damping) + " N.s/m\n";
}

}  // namespace palpate::tools
