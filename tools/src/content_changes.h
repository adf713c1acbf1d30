#pragma once
/// `touch --set`: contents that become others while the hand moves.

#include <string>
#include <vector>

#include "palpate/devices/session.h"
#include "report.h"

namespace palpate::tools {

/// One `--set`, read.
struct ContentSetting {
  std::string material;
  std::string key;      ///< viscosity, flow, lattice.force or cutting
  double number = 0.0;  ///< [SI] of all keys but flow
  Vec3 velocity{0.0};   ///< [m/s] of flow
  double time = 0.0;    ///< [s]
};

/// From texts MATERIAL.KEY=VALUE@TIME, by time. @throws Error (kUsage) for one that is not such a
/// text.
[[nodiscard]] std::vector<ContentSetting> readSettings(const std::vector<std::string>& texts);

/// What they come to in a scene, by time and each with what was set before, for a motion that lasts
/// to `end` [s]. @throws Error (kInput) for a material that is not a region's content, a value that
/// it cannot have, or a time after the end.
[[nodiscard]] std::vector<devices::ContentEvent> contentEvents(
    const std::vector<ContentSetting>& settings, const Scene& scene, double end);

[[nodiscard]] Json settingsJson(const std::vector<ContentSetting>& settings);

}  // namespace palpate::tools
