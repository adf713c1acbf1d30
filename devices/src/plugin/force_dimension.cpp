#include <optional>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/plugins.h"
#include "plugin/shared_library.h"
#include "servo_clock.h"

namespace palpate::devices {
namespace {

using plugin::SharedLibrary;

// Force Dimension's DHD interface, as programs that use it call it. The last argument of each call
// is the number of the device; a negative result is an error.
struct Functions {
  int (*open)();
  int (*close)(char);
  int (*enable_force)(unsigned char, char);
  int (*get_position)(double*, double*, double*, char);
  int (*get_velocity)(double*, double*, double*, char);
  int (*get_button)(int, char);
  int (*set_force)(double, double, double, char);
  const char* (*system_name)(char);
  const char* (*last_error)();

  explicit Functions(const SharedLibrary& from) : Functions() {
    from.find("dhdOpen", open);
    from.find("dhdClose", close);
    from.find("dhdEnableForce", enable_force);
    from.find("dhdGetPosition", get_position);
    from.find("dhdGetLinearVelocity", get_velocity);
    from.find("dhdGetButton", get_button);
    from.find("dhdSetForce", set_force);
    from.find("dhdGetSystemName", system_name);
    from.find("dhdErrorGetLastStr", last_error);
  }

 private:
  Functions() = default;
};

/// [N] That of the weakest of the family that CHAI3D lists (omega.3); the library limits the force
/// to that of the device.
constexpr double kMaxForce = 12.0;

constexpr const char* kHint = "install Force Dimension's SDK, or give the path of its library";

std::vector<std::string> namesOf(const PluginSettings& settings) {
  if (!settings.library.empty()) return {settings.library};
  return {"libdhd.so", "libdhd.so.3", "libdrd.so.3"};
}

class ForceDimensionDevice final : public Device {
 public:
  explicit ForceDimensionDevice(PluginSettings settings) : settings_(std::move(settings)) {
    info_.name = "Force Dimension device";
    info_.limits = handLimits();
    info_.buttons = 1;
    info_.max_force = kMaxForce;
  }
  ~ForceDimensionDevice() override { close(); }
  ForceDimensionDevice(const ForceDimensionDevice&) = delete;
  ForceDimensionDevice& operator=(const ForceDimensionDevice&) = delete;

  void open() override {
    close();
    library_.emplace(namesOf(settings_), kHint);
    dhd_.emplace(*library_);
    const int device = dhd_->open();
    if (device < 0) {
      const std::string why = dhd_->last_error();
      dhd_.reset();
      library_.reset();
      throw Error(ErrorKind::kDevice, {"device.none", "the DHD library opens no device: " + why,
                                       "plug it in, and try it with its maker's own program"});
    }
    device_ = static_cast<char>(device);
    if (const char* name = dhd_->system_name(device_)) info_.name = name;
    began_ = monotonicNs();
    (void)dhd_->set_force(0.0, 0.0, 0.0, device_);
    (void)dhd_->enable_force(1, device_);
  }

  void close() noexcept override {
    if (!dhd_) return;
    (void)dhd_->set_force(0.0, 0.0, 0.0, device_);
    (void)dhd_->enable_force(0, device_);
    (void)dhd_->close(device_);
    dhd_.reset();
    library_.reset();
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override {
    if (!dhd_) return DeviceStatus::kDisconnected;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    const int got = dhd_->get_position(&x, &y, &z, device_);
    if (got < 0) return DeviceStatus::kFault;
    if (got > 0) return DeviceStatus::kStale;  // the library has its own pace: no new reading yet
    out.position = {x, y, z};
    if (dhd_->get_velocity(&x, &y, &z, device_) < 0) return DeviceStatus::kFault;
    out.velocity = {x, y, z};
    out.buttons = dhd_->get_button(0, device_) > 0 ? 1 : 0;
    out.time = 1e-9 * static_cast<double>(monotonicNs() - began_);
    return DeviceStatus::kOk;
  }

  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override {
    if (!dhd_) return DeviceStatus::kDisconnected;
    // A positive result means that the motors are at their limit, which is not a fault.
    return dhd_->set_force(force.x, force.y, force.z, device_) < 0 ? DeviceStatus::kFault
                                                                   : DeviceStatus::kOk;
  }

  void cut() noexcept override {
    // The library may be called from several threads.
    if (dhd_) (void)dhd_->set_force(0.0, 0.0, 0.0, device_);
  }

 private:
  PluginSettings settings_;
  DeviceInfo info_;
  std::optional<SharedLibrary> library_;
  std::optional<Functions> dhd_;
  char device_ = 0;
  std::int64_t began_ = 0;
};

}  // namespace

std::unique_ptr<Device> makeForceDimension(const PluginSettings& settings) {
  return std::make_unique<ForceDimensionDevice>(settings);
}

bool hasForceDimension(const PluginSettings& settings) {
  return SharedLibrary::isThere(namesOf(settings));
}

}  // namespace palpate::devices
