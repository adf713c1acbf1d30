#include <array>
#include <optional>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/plugins.h"
#include "plugin/mailbox.h"
#include "plugin/shared_library.h"
#include "servo_clock.h"

namespace palpate::devices {
namespace {

using plugin::Mailbox;
using plugin::SharedLibrary;

// OpenHaptics' HD interface, as programs that use it call it.
using Handle = unsigned;
constexpr Handle kNoDevice = 0xFFFFFFFF;
constexpr unsigned kButtons = 0x2000;
constexpr unsigned kPosition = 0x2050;         // 3 doubles [mm]
constexpr unsigned kVelocity = 0x2051;         // 3 doubles [mm/s]
constexpr unsigned kTransform = 0x2052;        // 16 doubles, column by column
constexpr unsigned kMaxForce = 0x2603;         // [N]
constexpr unsigned kContinuousForce = 0x2604;  // [N]
constexpr unsigned kForce = 0x2700;            // 3 doubles [N]
constexpr unsigned kForceOutput = 0x4000;
constexpr unsigned kGoOn = 1;
constexpr unsigned short kPriority = 0xFFFF;

struct HdError {
  unsigned code;
  int internal;
  Handle device;
};
using Callback = unsigned(void*);

struct Functions {
  Handle (*init)(const char*);
  void (*disable)(Handle);
  void (*enable)(unsigned);
  void (*start)();
  void (*stop)();
  unsigned long (*schedule)(Callback*, void*, unsigned short);
  void (*unschedule)(unsigned long);
  void (*begin_frame)(Handle);
  void (*end_frame)(Handle);
  void (*get_doubles)(unsigned, double*);
  void (*get_integers)(unsigned, int*);
  void (*set_doubles)(unsigned, const double*);
  HdError (*error)();

  explicit Functions(const SharedLibrary& from) : Functions() {
    from.find("hdInitDevice", init);
    from.find("hdDisableDevice", disable);
    from.find("hdEnable", enable);
    from.find("hdStartScheduler", start);
    from.find("hdStopScheduler", stop);
    from.find("hdScheduleAsynchronous", schedule);
    from.find("hdUnschedule", unschedule);
    from.find("hdBeginFrame", begin_frame);
    from.find("hdEndFrame", end_frame);
    from.find("hdGetDoublev", get_doubles);
    from.find("hdGetIntegerv", get_integers);
    from.find("hdSetDoublev", set_doubles);
    from.find("hdGetError", error);
  }

 private:
  Functions() = default;
};

constexpr int kPatience = 20;         // turns of 1 ms without a new force before it becomes zero
constexpr double kMillimeter = 1e-3;  // [m]

/// Runs in the library's thread.
struct Work {
  const Functions* hd = nullptr;
  Handle device = kNoDevice;
  Mailbox mail;
  std::int64_t began = 0;  // [ns]

  unsigned turn() noexcept {
    hd->begin_frame(device);
    std::array<double, 3> place{};
    std::array<double, 3> speed{};
    std::array<double, 16> frame{};
    int buttons = 0;
    hd->get_doubles(kPosition, place.data());
    hd->get_doubles(kVelocity, speed.data());
    hd->get_doubles(kTransform, frame.data());
    hd->get_integers(kButtons, &buttons);
    const Vec3 force = mail.force(kPatience);
    const std::array<double, 3> out = {force.x, force.y, force.z};
    hd->set_doubles(kForce, out.data());
    hd->end_frame(device);
    DeviceState state;
    state.time = 1e-9 * static_cast<double>(monotonicNs() - began);
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      state.position[i] = kMillimeter * place[k];
      state.velocity[i] = kMillimeter * speed[k];
      for (int c = 0; c < 3; ++c)
        state.orientation[c][i] = frame[static_cast<std::size_t>(4 * c) + k];
    }
    state.buttons = static_cast<std::uint32_t>(buttons);
    const bool has_failed = hd->error().code != 0;
    mail.say(has_failed ? DeviceStatus::kFault : DeviceStatus::kOk, state);
    return kGoOn;
  }
};

constexpr const char* kHint =
    "install OpenHaptics and the device's driver from 3D Systems, or give the path of its library";

std::vector<std::string> namesOf(const PluginSettings& settings) {
  if (!settings.library.empty()) return {settings.library};
  return {"libHD.so", "libHD.so.3.4"};
}

class OpenHapticsDevice final : public Device {
 public:
  explicit OpenHapticsDevice(PluginSettings settings) : settings_(std::move(settings)) {
    info_.name = "OpenHaptics device";
    info_.limits = handLimits();
    info_.buttons = 2;
    info_.max_force = 0.0;  // until the library reports it
  }
  ~OpenHapticsDevice() override { close(); }
  OpenHapticsDevice(const OpenHapticsDevice&) = delete;
  OpenHapticsDevice& operator=(const OpenHapticsDevice&) = delete;

  void open() override {
    close();
    library_.emplace(namesOf(settings_), kHint);
    hd_.emplace(*library_);
    work_ = std::make_unique<Work>();
    work_->hd = &*hd_;
    work_->began = monotonicNs();
    const Handle device = hd_->init(nullptr);
    if (device == kNoDevice || hd_->error().code != 0) {
      hd_.reset();
      work_.reset();
      library_.reset();
      throw Error(ErrorKind::kDevice,
                  {"device.none", "OpenHaptics finds no device",
                   "plug it in, and try it with its maker's own diagnostic program"});
    }
    work_->device = device;
    hd_->get_doubles(kMaxForce, &info_.max_force);
    double forever = 0.0;
    hd_->get_doubles(kContinuousForce, &forever);
    if (forever > 0.0) info_.limits.continuous_force = forever;
    hd_->enable(kForceOutput);
    task_ = hd_->schedule([](void* work) { return static_cast<Work*>(work)->turn(); }, work_.get(),
                          kPriority);
    hd_->start();
  }

  void close() noexcept override {
    if (!hd_) return;
    work_->mail.write(Vec3(0.0));
    hd_->stop();
    hd_->unschedule(task_);
    // The library's thread has ended: this thread may write the last force.
    const std::array<double, 3> zero{};
    hd_->begin_frame(work_->device);
    hd_->set_doubles(kForce, zero.data());
    hd_->end_frame(work_->device);
    hd_->disable(work_->device);
    hd_.reset();
    work_.reset();
    library_.reset();
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override {
    return work_ ? work_->mail.read(out) : DeviceStatus::kDisconnected;
  }
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override {
    if (!work_) return DeviceStatus::kDisconnected;
    work_->mail.write(force);
    return DeviceStatus::kOk;
  }
  // cut() is not needed: the library's thread sets the force to zero by itself.

 private:
  PluginSettings settings_;
  DeviceInfo info_;
  std::optional<SharedLibrary> library_;
  std::optional<Functions> hd_;
  std::unique_ptr<Work> work_;
  unsigned long task_ = 0;
};

}  // namespace

std::unique_ptr<Device> makeOpenHaptics(const PluginSettings& settings) {
  return std::make_unique<OpenHapticsDevice>(settings);
}

bool hasOpenHaptics(const PluginSettings& settings) {
  return SharedLibrary::isThere(namesOf(settings));
}

}  // namespace palpate::devices
