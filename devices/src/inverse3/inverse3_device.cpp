#include "palpate/core/error.h"
#include "palpate/devices/inverse3.h"

#ifdef PALPATE_INVERSE3

#include "inverse3/inverse3_link.h"

namespace palpate::devices {
namespace {

class Inverse3Device final : public Device {
 public:
  explicit Inverse3Device(Inverse3Settings settings) : settings_(std::move(settings)) {
    // From a reseller's specification.
    info_.name = "Haply Inverse3";
    info_.max_force = 10.0;
    info_.workspace = {Vec3(-0.255, -0.23, -0.115), Vec3(0.255, 0.23, 0.115)};
    info_.limits = handLimits();
    info_.limits.continuous_force = 4.0;
  }
  ~Inverse3Device() override { close(); }
  Inverse3Device(const Inverse3Device&) = delete;
  Inverse3Device& operator=(const Inverse3Device&) = delete;

  void open() override {
    close();
    mail_ = std::make_unique<plugin::Mailbox>();
    try {
      link_ = std::make_unique<inverse3::Link>(settings_, *mail_);
    } catch (...) {
      mail_.reset();
      throw;
    }
  }
  void close() noexcept override {
    if (!mail_) return;
    mail_->write(Vec3(0.0));
    link_.reset();
    mail_.reset();
  }
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override {
    return mail_ ? mail_->read(out) : DeviceStatus::kDisconnected;
  }
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override {
    if (!mail_) return DeviceStatus::kDisconnected;
    mail_->write(force);
    link_->wake();
    return DeviceStatus::kOk;
  }
  // cut() is not needed: the service forgets a force that is not sent again.

 private:
  Inverse3Settings settings_;
  DeviceInfo info_;
  std::unique_ptr<plugin::Mailbox> mail_;
  std::unique_ptr<inverse3::Link> link_;
};

}  // namespace

std::unique_ptr<Device> makeInverse3(const Inverse3Settings& settings) {
  return std::make_unique<Inverse3Device>(settings);
}

}  // namespace palpate::devices

#else

namespace palpate::devices {

std::unique_ptr<Device> makeInverse3(const Inverse3Settings& /*settings*/) {
  throw Error(ErrorKind::kDevice,
              {"device.no_websocket", "this palpate was built without the Inverse3's driver",
               "install libboost-dev and nlohmann-json3-dev and build it again"});
}

}  // namespace palpate::devices

#endif
