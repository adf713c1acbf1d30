#include "loop_guards.h"

#include <algorithm>

#include "palpate/devices/coupling_design.h"
#include "text.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.touch", std::move(message), std::move(hint)});
}

CouplingRequest couplingRequest(const std::string& text) {
  CouplingRequest request;
  if (text == "springs") return request;
  if (text == "any_scene") {
    request.design = CouplingRequest::For::kAnyScene;
    return request;
  }
  const auto parts = split(text, ',');
  if (parts.empty() || parts.size() > 2) {
    throw usageError("--coupling is springs, any_scene, or STIFFNESS,DAMPING",
                     "--coupling springs needs --device NAME, for which the coupling is designed");
  }
  request.stiffness = parseStiffness(parts[0], "--coupling");
  if (parts.size() == 2) request.damping = parseDamping(parts[1], "--coupling");
  if (!(*request.stiffness > 0.0) || request.damping < 0.0) {
    throw usageError("--coupling needs a stiffness of more than 0 and a damping of 0 or more", {});
  }
  return request;
}

}  // namespace

devices::HandGuards guardsOf(const TouchOptions& options, DeviceMapping mapping,
                             const std::optional<devices::LoopModel>& loop) {
  if (!options.passivity.empty()) {
    if (!mapping.passivity) mapping.passivity.emplace();
    mapping.passivity->controls = options.passivity == "control";
  }
  if (!options.hand_force.empty()) {
    if (!mapping.passivity) {
      throw usageError("--hand-force applies to the passivity controller only",
                       "add --passivity control");
    }
    mapping.passivity->hand_force = parseForce(options.hand_force, "--hand-force");
  }
  if (!options.coupling.empty()) mapping.coupling = couplingRequest(options.coupling);
  return devices::guardsOf(mapping, loop, 1.0 / options.rate);
}

Json guardsJson(const devices::HandGuards& guards, const devices::Session& session) {
  Json json = {{"passivity", Json()}, {"coupling", Json()}};
  if (guards.passivity) {
    const devices::PassivityObserver& seen = *session.observer();
    json["passivity"] = {{"control", guards.passivity->controls},
                         {"most_stiffness_N_per_m", Json()},
                         {"given_J", seen.given()},
                         {"reserve_J", seen.reserve()},
                         {"lowest_reserve_J", seen.lowest()},
                         {"doubt_J", seen.doubt()}};
    if (guards.passivity->controls) {
      json["passivity"]["most_stiffness_N_per_m"] =
          devices::PassivityController(*guards.passivity).mostStiffness();
    }
  }
  if (guards.coupling) {
    json["coupling"] = {{"stiffness_N_per_m", guards.coupling->stiffness},
                        {"damping_Ns_per_m", guards.coupling->damping}};
  }
  return json;
}

std::string guardsText(const devices::HandGuards& guards, const devices::Session& session) {
  std::string text;
  if (guards.coupling) {
    const devices::CouplingSettings& c = *guards.coupling;
    text += "Coupling    " + formatNumber(c.stiffness, 3) + " N/m, " + formatNumber(c.damping, 3) +
            " N.s/m: a wall of 1000 N/m feels like " +
            formatNumber(devices::feltStiffness(1000.0, c), 3) + " N/m\n";
  }
  if (guards.passivity) {
    const devices::PassivityObserver& seen = *session.observer();
    text += "Passivity   " + formatNumber(seen.given(), 3) +
            " J went from the motors to the tip; at most " +
            formatNumber(std::max(0.0, -seen.lowest()), 3) + " J more than the device took" +
            (guards.passivity->controls ? ", and damped away\n" : "\n");
    if (guards.passivity->controls) {
      const double most = devices::PassivityController(*guards.passivity).mostStiffness();
      text += "            stiffer walls feel like one of " + formatNumber(most, 3) + " N/m\n";
    }
  }
  return text;
}

}  // namespace palpate::tools
