#pragma once
/// The circumstances of a record: FILE.npy.json, beside the ticks in FILE.npy and the states in
/// FILE.npy.states.

#include <cstdint>
#include <string>
#include <vector>

#include "options.h"
#include "palpate/devices/device.h"
#include "palpate/scene/scene.h"

namespace palpate::tools {

struct RecordAbout {
  std::string version;  ///< of palpate
  std::string build;    ///< devices::stateBuild()
  std::string scene;    ///< absolute path
  /// For a mesh, image or grid: the text of the scene that was made of it. For `view`: the text of
  /// the scene, whose file may be edited during the session. Else empty.
  std::string scene_text;
  std::string scene_hash;  ///< sceneHash()
  bool shows_all = false;  ///< whether the scene was compiled for Purpose::kShow
  std::string renderer;    ///< "constraint" or "paper"
  std::string device;      ///< its name
  devices::DeviceFrame frame = devices::DeviceFrame::kWorld;  ///< of its readings
  double max_force = 0.0;                                     ///< [N] of the device
  double rate = 0.0;                                          ///< [Hz]
  bool realtime = false;
  double period = 0.0;             ///< [s] ForceLimits::period
  std::uint64_t states_every = 0;  ///< [ticks] SessionSettings::checkpoint_every
  /// As the user gave them: the parameters of the paper's renderer, the limits of the force, set,
  /// device, hand, delay, passivity, hand_force, coupling.
  TouchOptions options;
  std::vector<std::string> regions;  ///< names by RegionId
  std::vector<std::string> ports;    ///< names by PortId
};

/// Fills in the circumstances of a touch, except `period` and the renderer.
void describe(RecordAbout& about, const TouchOptions& options, const devices::DeviceInfo& device,
              const Scene& scene, const std::string& scene_text);

/// FILE.npy -> FILE.npy.json, FILE.npy.states.
[[nodiscard]] std::string aboutFile(const std::string& record);
[[nodiscard]] std::string statesFile(const std::string& record);

/// As JSON, one object.
[[nodiscard]] std::string aboutText(const RecordAbout& about);

struct ReadAbout {
  RecordAbout about;
  std::string text;  ///< of the file
};
/// Reads the circumstances of the record FILE.npy. @throws Error (kInput, record.about) for a file
/// that is missing, or that aboutText() did not write.
[[nodiscard]] ReadAbout readAbout(const std::string& record);

}  // namespace palpate::tools
