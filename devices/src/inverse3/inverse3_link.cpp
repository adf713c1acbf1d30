#ifdef PALPATE_INVERSE3

#include "inverse3/inverse3_link.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <future>
#include <limits>
#include <thread>

#include "inverse3/inverse3_messages.h"
#include "palpate/core/error.h"
#include "servo_clock.h"

namespace palpate::devices::inverse3 {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;

constexpr auto kConnectTime =
    std::chrono::seconds(2);               // for connection, handshake and the first message
constexpr std::size_t kLongest = 1 << 20;  // [bytes] in a message
constexpr int kPatience =
    std::numeric_limits<int>::max();  // unlimited, since a force is sent only when it is written

}  // namespace

/// Everything but wake() happens in its own thread.
class Link::Work {
 public:
  Work(const Inverse3Settings& settings, plugin::Mailbox& mail)
      : settings_(settings),
        mail_(mail),
        id_(settings.id),
        event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        wakes_(context_),
        deadline_(context_),
        socket_(context_) {
    if (event_ >= 0) wakes_.assign(event_);
  }

  void start() {
    auto first = first_.get_future();
    if (event_ < 0) {
      throw Error(ErrorKind::kOperation,
                  {"device.eventfd", "no file descriptor is free: too many files are open",
                   "close other programs"});
    }
    began_ = monotonicNs();
    connect();
    thread_ = std::thread([this] { run(); });
    first.get();  // throws if the thread failed
  }

  void stop() noexcept {
    asio::post(context_, [this] { finish(); });
    if (thread_.joinable()) thread_.join();
  }

  void wake() const noexcept {
    const std::uint64_t one = 1;
    // If the pipe is full, a wake-up is on its way already.
    [[maybe_unused]] const auto written = write(event_, &one, sizeof one);
  }

 private:
  using Socket = beast::websocket::stream<beast::tcp_stream>;

  void run() noexcept {
    try {
      context_.run();
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

  void fail(const std::string& why) noexcept {
    if (!is_up_) {
      is_up_ = true;
      first_.set_exception(std::make_exception_ptr(
          Error(ErrorKind::kDevice,
                {"device.service",
                 "no Inverse3 can be reached through the service at " + settings_.host + ":" +
                     std::to_string(settings_.port) + ": " + why,
                 "install and start Haply's Inverse Service, and plug the device in"})));
    }
    mail_.say(DeviceStatus::kDisconnected, {});
    hangUp();
  }

  void hangUp() noexcept {
    error_code ignored;
    deadline_.cancel(ignored);
    wakes_.cancel(ignored);
    beast::get_lowest_layer(socket_).cancel();
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }

  /// Disconnects after kConnectTime, unless the deadline is set again or canceled. It has a timer
  /// of its own, because the stream's timer must not be set while the stream reads or writes.
  void setDeadline() {
    deadline_.expires_after(kConnectTime);
    deadline_.async_wait([this](const error_code& canceled) {
      if (!canceled) fail("it does not answer");
    });
  }

  void connect() {
    error_code bad;
    const auto address = asio::ip::make_address(settings_.host, bad);
    if (bad) {
      fail("the host must be an address such as 127.0.0.1");
      return;
    }
    setDeadline();
    beast::get_lowest_layer(socket_).async_connect(
        asio::ip::tcp::endpoint(address, settings_.port), [this](const error_code& error) {
          if (error) return fail(error.message());
          error_code ignored;
          beast::get_lowest_layer(socket_).socket().set_option(asio::ip::tcp::no_delay(true),
                                                               ignored);
          socket_.read_message_max(kLongest);
          socket_.async_handshake(settings_.host, "/", [this](const error_code& refused) {
            if (refused) return fail(refused.message());
            readNext();
            waitForWake();
          });
        });
  }

  void readNext() {
    socket_.async_read(buffer_, [this](const error_code& error, std::size_t /*size*/) {
      if (error) return fail(error.message());
      take(beast::buffers_to_string(buffer_.data()));
      buffer_.consume(buffer_.size());
      readNext();
    });
  }

  void take(const std::string& text) {
    auto message = readMessage(text, id_);
    if (!message) {
      // A message that is damaged or about another device: if this goes on, no reading comes, and
      // the loop releases the force.
      if (!is_up_) fail("it names no such device");
      return;
    }
    message->state.time = 1e-9 * static_cast<double>(monotonicNs() - began_);
    mail_.say(DeviceStatus::kOk, message->state);
    if (is_up_) return;
    id_ = message->id;
    deadline_.cancel();
    send();  // The service only answers messages, so send one before write() asks for any.
    is_up_ = true;
    first_.set_value();
  }

  void waitForWake() {
    wakes_.async_wait(asio::posix::stream_descriptor::wait_read, [this](const error_code& error) {
      if (error) return;
      std::uint64_t count = 0;
      [[maybe_unused]] const auto got = ::read(event_, &count, sizeof count);
      if (is_up_) send();
      waitForWake();
    });
  }

  void send() {
    if (is_sending_) {
      has_more_ = true;
      return;
    }
    const Vec3 force = is_ending_ ? Vec3(0.0) : mail_.force(kPatience);
    out_ = forceMessage(id_, force);
    is_sending_ = true;
    socket_.text(true);
    socket_.async_write(asio::buffer(out_), [this](const error_code& error, std::size_t /*size*/) {
      is_sending_ = false;
      if (error) return fail(error.message());
      const bool is_last = is_ending_ && !has_more_;
      if (is_last) return hangUp();
      if (has_more_) {
        has_more_ = false;
        send();
      }
    });
  }

  void finish() {
    is_ending_ = true;
    if (!beast::get_lowest_layer(socket_).socket().is_open() || id_.empty()) return hangUp();
    setDeadline();
    send();
  }

  Inverse3Settings settings_;
  plugin::Mailbox& mail_;
  std::string id_;
  asio::io_context context_;
  int event_;
  asio::posix::stream_descriptor wakes_;
  asio::steady_timer deadline_;
  Socket socket_;
  beast::flat_buffer buffer_;
  std::string out_;
  std::promise<void> first_;
  std::int64_t began_ = 0;  // [ns]
  bool is_up_ = false;      // first_ was fulfilled
  bool is_sending_ = false;
  bool has_more_ = false;
  bool is_ending_ = false;
  std::thread thread_;
};

Link::Link(const Inverse3Settings& settings, plugin::Mailbox& mail)
    : work_(std::make_unique<Work>(settings, mail)) {
  try {
    work_->start();
  } catch (...) {
    work_->stop();
    throw;
  }
}

Link::~Link() { work_->stop(); }

void Link::wake() noexcept { work_->wake(); }

}  // namespace palpate::devices::inverse3

#endif
