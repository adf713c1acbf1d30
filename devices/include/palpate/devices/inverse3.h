#pragma once
/// Haply's Inverse3, through the service that its maker installs. Protocol from public sources,
/// unverified on hardware.

#include <cstdint>
#include <memory>
#include <string>

#include "palpate/devices/device.h"
#include "palpate/export.h"

namespace palpate::devices {

/// Where the service of the Inverse3's maker listens, and which of its devices is meant.
struct Inverse3Settings {
  std::string host = "127.0.0.1";  ///< IP address of the service, not a name
  std::uint16_t port = 10001;      ///< TCP port of the service
  std::string id;                  ///< of the device; empty: the first that the service lists
};

/// WebSocket and JSON live in a thread of their own; read() and write() only exchange values with
/// it. Each write() sends a force, each answer of the service is a reading; the service forgets a
/// force that is not sent again. The frame is the service's. open() throws Error (kDevice) if
/// nothing answers at its address, or if the service does not know the device.
/// @throws Error (kDevice) in a build without Boost.Beast and nlohmann-json.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<Device> makeInverse3(const Inverse3Settings& settings);

/// Whether something listens at the service's address.
[[nodiscard]] PALPATE_EXPORT bool hasInverseService(const Inverse3Settings& settings) noexcept;

}  // namespace palpate::devices
