#include "usb/transport.h"

#ifdef PALPATE_LIBUSB

#include <libusb.h>

#include <array>
#include <atomic>
#include <chrono>
#include <string>

#include "usb/libusb_list.h"

namespace palpate::devices::usb {
namespace {

constexpr unsigned char kIn = 0x81;
constexpr unsigned char kOut = 0x02;
constexpr int kInterface = 0;
constexpr unsigned kControlWait = 500;  // [ms]
constexpr unsigned kCutWait = 5;        // [ms]
constexpr int kSendWait = 3;            // [ms] for the previous transfer
constexpr int kCloseWait = 500;         // [ms] for transfers to end

Status statusOf(int error) noexcept {
  switch (error) {
    case LIBUSB_SUCCESS:
      return Status::kOk;
    case LIBUSB_ERROR_TIMEOUT:
      return Status::kTimeout;
    case LIBUSB_ERROR_NO_DEVICE:
      return Status::kGone;
    case LIBUSB_ERROR_PIPE:
      return Status::kStall;
    case LIBUSB_ERROR_OVERFLOW:
      return Status::kOverflow;
    default:
      return Status::kError;
  }
}

Status statusOf(libusb_transfer_status status) noexcept {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return Status::kOk;
    case LIBUSB_TRANSFER_TIMED_OUT:
      return Status::kTimeout;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return Status::kGone;
    case LIBUSB_TRANSFER_STALL:
      return Status::kStall;
    case LIBUSB_TRANSFER_OVERFLOW:
      return Status::kOverflow;
    case LIBUSB_TRANSFER_CANCELLED:
    case LIBUSB_TRANSFER_ERROR:
      break;
  }
  return Status::kError;
}

/// One direction: a transfer with its buffer, made once. The callback may run in one thread while
/// another thread is in cut().
struct Line {
  libusb_transfer* transfer = nullptr;
  std::array<unsigned char, Transport::kPacket> buffer{};
  std::atomic<bool> is_pending{false};

  Line() : transfer(libusb_alloc_transfer(0)) {}
  ~Line() {
    // A transfer that did not end still belongs to the library.
    if (!is_pending.load(std::memory_order_acquire)) libusb_free_transfer(transfer);
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  static void LIBUSB_CALL onDone(libusb_transfer* transfer) {
    static_cast<Line*>(transfer->user_data)->is_pending.store(false, std::memory_order_release);
  }

  [[nodiscard]] Status submit(libusb_device_handle* handle, unsigned char endpoint,
                              int size) noexcept {
    libusb_fill_bulk_transfer(transfer, handle, endpoint, buffer.data(), size, onDone, this, 0);
    is_pending.store(true, std::memory_order_release);
    const int error = libusb_submit_transfer(transfer);
    if (error != LIBUSB_SUCCESS) is_pending.store(false, std::memory_order_release);
    return statusOf(error);
  }
};

class LibusbTransport final : public Transport {
 public:
  explicit LibusbTransport(const Choice& choice) : context_(choice.descriptor >= 0) {
    handle_ = openHandle(context_.get(), choice);
    if (in_.transfer == nullptr || out_.transfer == nullptr) {
      libusb_close(handle_);
      throw Error(ErrorKind::kOperation, {"out_of_memory", "there is not enough memory", ""});
    }
    (void)libusb_set_auto_detach_kernel_driver(handle_, 1);
    if (const int error = libusb_claim_interface(handle_, kInterface); error != 0) {
      libusb_close(handle_);
      throw openError(error, "claim its interface");
    }
  }
  ~LibusbTransport() override {
    (void)waitFor(out_, kSendWait);
    for (Line* line : {&in_, &out_}) {
      if (line->is_pending.load(std::memory_order_acquire)) libusb_cancel_transfer(line->transfer);
    }
    for (Line* line : {&in_, &out_}) (void)waitFor(*line, kCloseWait);
    (void)libusb_release_interface(handle_, kInterface);
    libusb_close(handle_);
  }
  LibusbTransport(const LibusbTransport&) = delete;
  LibusbTransport& operator=(const LibusbTransport&) = delete;

  Status control(std::uint8_t request, std::uint16_t value) noexcept override {
    // 0x40: vendor request, host to device.
    const int n =
        libusb_control_transfer(handle_, 0x40, request, value, 0, nullptr, 0, kControlWait);
    return n >= 0 ? Status::kOk : statusOf(n);
  }

  Status send(std::span<const std::uint8_t> bytes) noexcept override {
    if (const Status s = waitFor(out_, kSendWait); s != Status::kOk) return s;
    // The result of the previous transfer is known only now.
    if (has_sent_) {
      const Status before = statusOf(out_.transfer->status);
      if (before == Status::kStall) (void)libusb_clear_halt(handle_, kOut);
      if (before != Status::kOk) {
        has_sent_ = false;
        return before;
      }
    }
    const std::size_t size = std::min(bytes.size(), out_.buffer.size());
    std::copy_n(bytes.begin(), size, out_.buffer.begin());
    const Status s = out_.submit(handle_, kOut, static_cast<int>(size));
    has_sent_ = s == Status::kOk;
    return s;
  }

  Status receive(std::span<std::uint8_t> into, std::size_t& got, int wait) noexcept override {
    got = 0;
    if (!is_asking_) {
      if (const Status s = ask(); s != Status::kOk) return s;
    }
    if (const Status s = waitFor(in_, wait); s != Status::kOk) return s;
    is_asking_ = false;
    const Status done = statusOf(in_.transfer->status);
    if (done == Status::kGone) return done;
    if (done == Status::kStall) (void)libusb_clear_halt(handle_, kIn);
    if (done == Status::kOk) {
      const auto size = static_cast<std::size_t>(std::max(0, in_.transfer->actual_length));
      got = std::min({size, into.size(), in_.buffer.size()});
      std::copy_n(in_.buffer.begin(), got, into.begin());
    }
    const Status asked = ask();
    return done != Status::kOk ? done : asked;
  }

  void cut(std::span<const std::uint8_t> bytes) noexcept override {
    std::array<unsigned char, kPacket> copy{};
    const std::size_t size = std::min(bytes.size(), copy.size());
    std::copy_n(bytes.begin(), size, copy.begin());
    int sent = 0;
    (void)libusb_bulk_transfer(handle_, kOut, copy.data(), static_cast<int>(size), &sent, kCutWait);
  }

 private:
  using Clock = std::chrono::steady_clock;

  Status ask() noexcept {
    const Status s = in_.submit(handle_, kIn, static_cast<int>(in_.buffer.size()));
    is_asking_ = s == Status::kOk;
    return s;
  }

  /// Waits until the line's transfer has ended, at most `wait` [ms].
  Status waitFor(const Line& line, int wait) noexcept {
    const auto until = Clock::now() + std::chrono::milliseconds(wait);
    while (line.is_pending.load(std::memory_order_acquire)) {
      const auto left = std::chrono::duration_cast<std::chrono::microseconds>(until - Clock::now());
      if (left.count() <= 0) return Status::kTimeout;
      timeval slice{0, static_cast<suseconds_t>(left.count())};
      if (left.count() >= 1'000'000) slice = {1, 0};
      const int error = libusb_handle_events_timeout_completed(context_.get(), &slice, nullptr);
      if (error != LIBUSB_SUCCESS && error != LIBUSB_ERROR_INTERRUPTED) return statusOf(error);
    }
    return Status::kOk;
  }

  Context context_;  // constructed first, destroyed last
  libusb_device_handle* handle_ = nullptr;
  Line in_;
  Line out_;
  bool is_asking_ = false;
  bool has_sent_ = false;
};

}  // namespace

std::unique_ptr<Transport> openUsb(const Choice& choice) {
  return std::make_unique<LibusbTransport>(choice);
}

}  // namespace palpate::devices::usb

#else

namespace palpate::devices::usb {

std::unique_ptr<Transport> openUsb(const Choice& /*choice*/) {
  throw Error(ErrorKind::kDevice, {"device.no_libusb", "this palpate was built without libusb",
                                   "install libusb-1.0-0-dev and build it again"});
}

}  // namespace palpate::devices::usb

#endif
