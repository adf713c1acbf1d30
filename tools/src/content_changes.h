#pragma once
/// `touch --set`: contents that change while the hand moves.

#include <string>
#include <vector>

#include "palpate/devices/session.h"
#include "report.h"

namespace palpate::tools {

/// One parsed `--set`.
struct ContentSetting {
  std::string material;
  std::string key;      ///< viscosity, flow, lattice.force or cutting
  double number = 0.0;  ///< [SI] for all keys but flow
  Vec3 velocity{0.0};   ///< [m/s] for flow
  double time = 0.0;    ///< [s]
};

/// Parses texts MATERIAL.KEY=VALUE@TIME, sorted by time. @throws Error (kUsage) for a text of
/// another form.
[[nodiscard]] std::vector<ContentSetting> readSettings(const std::vector<std::string>& texts);

/// The resulting changes in a scene, sorted by time, each including the earlier ones, for a motion
/// that lasts until `end` [s]. @throws Error (kInput) for a material that is not a region's
/// content, a value that it cannot have, or a time after the end.
[[nodiscard]] std::vector<devices::ContentEvent> contentEvents(
    const std::vector<ContentSetting>& settings, const Scene& scene, double end);

[[nodiscard]] Json settingsJson(const std::vector<ContentSetting>& settings);

}  // namespace palpate::tools
