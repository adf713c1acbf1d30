#include "devices/usbfs_emulation.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace palpate::devices {
namespace {

// Descriptors of the device, the configuration, and interface 0 with bulk IN 0x81 and bulk OUT 0x02
// of 64 bytes.
constexpr std::array<std::uint8_t, 18> kDevice = {18,   1,    0x00, 0x02, 0,    0, 0, 64, 0x03,
                                                  0x04, 0x48, 0xcb, 0x00, 0x06, 0, 0, 0,  1};
constexpr std::array<std::uint8_t, 32> kConfiguration = {
    9,    2, 32, 0, 1,    1, 0,  0x80, 50, 9, 4, 0,    0, 2,  0xff, 0xff,
    0xff, 0, 7,  5, 0x81, 2, 64, 0,    0,  7, 5, 0x02, 2, 64, 0,    0};

}  // namespace

class UsbfsEmulation::Kernel {
 public:
  Kernel(FalconEmulator& falcon, UsbfsEmulation& owner) : falcon_(falcon), owner_(owner) {}

  int handle(unsigned long request, void* argument) {
    const std::lock_guard lock(mutex_);
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES:
        *static_cast<std::uint32_t*>(argument) = 0;
        return 0;
      case USBDEVFS_CONNECTINFO:
        *static_cast<usbdevfs_connectinfo*>(argument) = {4, 0};
        return 0;
      case USBDEVFS_CONTROL: {
        // libusb requests the configuration when it wraps a descriptor.
        auto* ask = static_cast<usbdevfs_ctrltransfer*>(argument);
        if (ask->bRequestType != 0x80 || ask->bRequest != 8 || ask->wLength < 1) return fail(EPIPE);
        *static_cast<std::uint8_t*>(ask->data) = 1;
        return 1;
      }
      case USBDEVFS_CLAIMINTERFACE:
      case USBDEVFS_DISCONNECT_CLAIM:
        if (const int error = next(Step::kClaim)) return fail(error);
        claimed_ = true;
        return 0;
      case USBDEVFS_RELEASEINTERFACE:
        (void)next(Step::kRelease);
        return 0;
      case USBDEVFS_GETDRIVER:
        return fail(ENODATA);
      case USBDEVFS_CLEAR_HALT:
        return 0;
      case USBDEVFS_SUBMITURB:
        return submit(static_cast<usbdevfs_urb*>(argument));
      case USBDEVFS_DISCARDURB:
        return discard(static_cast<usbdevfs_urb*>(argument));
      case USBDEVFS_REAPURB:
      case USBDEVFS_REAPURBNDELAY:
        return reap(static_cast<usbdevfs_urb**>(argument));
      default:
        return fail(ENOTTY);
    }
  }

  void unplug() {
    const std::lock_guard lock(mutex_);
    is_gone_ = true;
  }
  void plugIn() {
    const std::lock_guard lock(mutex_);
    is_gone_ = false;
  }
  std::atomic<int> steps{0};
  std::atomic<std::uint64_t> outs{0};
  [[nodiscard]] int pending() {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(waiting_.size() + done_.size());
  }
  [[nodiscard]] bool wasClaimed() {
    const std::lock_guard lock(mutex_);
    return claimed_;
  }

 private:
  static int fail(int error) {
    errno = error;
    return -1;
  }

  int next(Step step) {
    ++steps;
    const int error = owner_.fault ? owner_.fault(step) : 0;
    if (error == ENODEV) is_gone_ = true;
    return is_gone_ ? ENODEV : error;
  }

  void finish(usbdevfs_urb* urb, int status, int length) {
    urb->status = status;
    urb->actual_length = length;
    done_.push_back(urb);
  }

  int submit(usbdevfs_urb* urb) {
    if (urb->type == USBDEVFS_URB_TYPE_CONTROL) {
      if (const int error = next(Step::kControl)) return fail(error);
      const auto* setup = static_cast<const std::uint8_t*>(urb->buffer);
      if (setup[0] == 0x40) {
        falcon_.control(setup[1], static_cast<std::uint16_t>(setup[2] | (setup[3] << 8)));
      }
      finish(urb, 0, setup[0] == 0x80 && setup[1] == 6 ? describe(urb) : 0);
      return 0;
    }
    const bool is_in = (urb->endpoint & 0x80) != 0;
    if (const int error = next(is_in ? Step::kSubmitIn : Step::kSubmitOut)) return fail(error);
    if (is_in) {
      waiting_.push_back(urb);
      return 0;
    }
    const int error = next(Step::kReapOut);
    if (error == 0) {
      falcon_.out({static_cast<const std::uint8_t*>(urb->buffer),
                   static_cast<std::size_t>(urb->buffer_length)});
      ++outs;
    }
    finish(urb, -error, error == 0 ? urb->buffer_length : 0);
    return 0;
  }

  /// Answers a request for a string: for index 0 the languages, for others the serial number.
  /// Returns its length including the setup packet.
  int describe(usbdevfs_urb* urb) const {
    auto* bytes = static_cast<std::uint8_t*>(urb->buffer);
    constexpr std::size_t kSetup = 8;
    std::vector<std::uint8_t> text = {0, 3};
    if (bytes[2] == 0) {
      text.insert(text.end(), {0x09, 0x04});
    } else {
      for (const char c : owner_.serial) text.insert(text.end(), {static_cast<std::uint8_t>(c), 0});
    }
    text[0] = static_cast<std::uint8_t>(text.size());
    const std::size_t room = static_cast<std::size_t>(urb->buffer_length) - kSetup;
    const std::size_t size = std::min(text.size(), room);
    std::memcpy(bytes + kSetup, text.data(), size);
    return static_cast<int>(size);
  }

  int discard(usbdevfs_urb* urb) {
    for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
      if (*at != urb) continue;
      waiting_.erase(at);
      finish(urb, -ENOENT, 0);
      return 0;
    }
    return fail(EINVAL);
  }

  int reap(usbdevfs_urb** out) {
    if (done_.empty() && is_gone_ && !waiting_.empty()) {
      finish(waiting_.front(), -ENODEV, 0);
      waiting_.pop_front();
    } else if (done_.empty() && !waiting_.empty()) {
      usbdevfs_urb* urb = waiting_.front();
      waiting_.pop_front();
      if (const int error = next(Step::kReapIn)) {
        finish(urb, -error, 0);
      } else {
        const auto packet = falcon_.in();
        const auto size = std::min(packet.size(), static_cast<std::size_t>(urb->buffer_length));
        std::memcpy(urb->buffer, packet.data(), size);
        finish(urb, 0, static_cast<int>(size));
      }
    }
    if (done_.empty()) return fail(is_gone_ ? ENODEV : EAGAIN);
    *out = done_.front();
    done_.pop_front();
    return 0;
  }

  FalconEmulator& falcon_;
  UsbfsEmulation& owner_;
  std::mutex mutex_;
  std::deque<usbdevfs_urb*> waiting_;
  std::deque<usbdevfs_urb*> done_;
  bool claimed_ = false;
  bool is_gone_ = false;
};

namespace {

// Only one device can be emulated at a time.
std::atomic<int> the_descriptor{-1};
std::atomic<ino_t> the_file{0};
std::atomic<UsbfsEmulation::Kernel*> the_kernel{nullptr};

bool isNode(int fd) {
  if (fd >= 0 && fd == the_descriptor) return true;
  struct stat about {};
  return the_file != 0 && fstat(fd, &about) == 0 && about.st_ino == the_file;
}

}  // namespace

UsbfsEmulation::UsbfsEmulation(FalconEmulator& falcon)
    : kernel_(std::make_unique<Kernel>(falcon, *this)) {
  descriptor_ = memfd_create("falcon", MFD_CLOEXEC);
  const bool is_written =
      descriptor_ >= 0 &&
      write(descriptor_, kDevice.data(), kDevice.size()) == static_cast<ssize_t>(kDevice.size()) &&
      write(descriptor_, kConfiguration.data(), kConfiguration.size()) ==
          static_cast<ssize_t>(kConfiguration.size()) &&
      lseek(descriptor_, 0, SEEK_SET) == 0;
  if (!is_written) throw std::runtime_error("no memory for the descriptors");
  the_kernel = kernel_.get();
  the_descriptor = descriptor_;
}

UsbfsEmulation::~UsbfsEmulation() {
  the_descriptor = -1;
  the_file = 0;
  the_kernel = nullptr;
  close(descriptor_);
}

int UsbfsEmulation::descriptor() const noexcept {
  // Each opening of the node reads its descriptors from the beginning.
  (void)lseek(descriptor_, 0, SEEK_SET);
  return descriptor_;
}

void UsbfsEmulation::answerFor(int copy) noexcept { the_descriptor = copy; }

void UsbfsEmulation::answerForNode(const std::string& file) {
  struct stat about {};
  if (stat(file.c_str(), &about) != 0) throw std::runtime_error("there is no " + file);
  the_file = about.st_ino;
}

void UsbfsEmulation::unplug() noexcept { kernel_->unplug(); }
void UsbfsEmulation::plugIn() noexcept { kernel_->plugIn(); }
int UsbfsEmulation::steps() const noexcept { return kernel_->steps; }
std::uint64_t UsbfsEmulation::outs() const noexcept { return kernel_->outs; }
int UsbfsEmulation::pending() const noexcept { return kernel_->pending(); }
bool UsbfsEmulation::wasClaimed() const noexcept { return kernel_->wasClaimed(); }

}  // namespace palpate::devices

/// Replaces the C library's ioctl() for the whole process: requests for other descriptors go to the
/// kernel.
extern "C" int ioctl(int fd, unsigned long request, ...) {
  va_list list;
  va_start(list, request);
  void* argument = va_arg(list, void*);
  va_end(list);
  if (palpate::devices::isNode(fd)) {
    return palpate::devices::the_kernel.load()->handle(request, argument);
  }
  return static_cast<int>(syscall(SYS_ioctl, fd, request, argument));
}
