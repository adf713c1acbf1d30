#include "view/page_server.h"

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <exception>
#include <set>
#include <thread>
#include <utility>

#include "palpate/core/error.h"
#include "view/page_request.h"

namespace palpate::tools {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestHeader = 8192;  // [bytes]
// for a request to arrive, and for an answer to be sent
constexpr auto kPatience = std::chrono::seconds(20);
// before the next try, when file descriptors have run out
constexpr auto kNap = std::chrono::milliseconds(100);
constexpr auto kQuiet = std::chrono::seconds(30);  // longest silence of a page, pings included
constexpr const char* kSeen = R"({"seen":true})";
constexpr const char* kLine = "live";  // the path of the WebSocket

http::status statusOf(PageVerdict verdict) {
  return verdict == PageVerdict::kServe ? http::status::not_found : http::status::forbidden;
}

const char* wordsOf(PageVerdict verdict) {
  switch (verdict) {
    case PageVerdict::kServe:
      return "there is no such file\n";
    case PageVerdict::kForeignHost:
      return "this host is not served; use the address that palpate printed\n";
    case PageVerdict::kForeignOrigin:
      return "pages of other servers are not answered\n";
    case PageVerdict::kWrongToken:
      break;
  }
  return "not the address that palpate printed\n";
}

}  // namespace

class PageServer::Work : public std::enable_shared_from_this<PageServer::Work> {
 public:
  class Line;

  Work(PageHost host, const PageServerSettings& settings)
      : host_(std::move(host)),
        files_(settings.files),
        period_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / settings.rate))),
        unseen_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(settings.unseen))),
        token_(randomToken()),
        acceptor_(context_),
        timer_(context_),
        nap_(context_) {
    error_code error;
    const tcp::endpoint end(asio::ip::address_v4::loopback(), settings.port);
    acceptor_.open(end.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(end, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (!error) port_ = acceptor_.local_endpoint(error).port();
    if (error) {
      throw Error(
          ErrorKind::kOperation,
          {"view.port",
           "cannot listen at 127.0.0.1:" + std::to_string(settings.port) + ": " + error.message(),
           "leave out --port, and a free one is taken"});
    }
  }

  void start() {
    acceptNext();
    wait();
    thread_ = std::thread([this] { run(); });
  }

  void stop() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
    // Lines go before the context, because they hold its sockets.
    lines_.clear();
    steering_.reset();
  }

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  [[nodiscard]] const std::string& token() const noexcept { return token_; }
  [[nodiscard]] PageServerCounts counts() const noexcept {
    return {taken_.load(), refused_.load(), turned_away_.load(), bytes_.load()};
  }
  [[nodiscard]] int open() const noexcept { return open_.load(); }

  // Called by the connections.

  void begin() noexcept { ++open_; }
  void end() noexcept { --open_; }
  void sent(std::size_t bytes) noexcept { bytes_ += bytes; }

  [[nodiscard]] PageDecision decide(const http::request<http::empty_body>& request,
                                    bool is_upgrade) {
    const auto text = [](boost::string_view view) {
      return std::string_view(view.data(), view.size());
    };
    // A request with two Host or two Origin headers is refused, as if it had no Host.
    const bool is_doubled =
        request.count(http::field::host) > 1 || request.count(http::field::origin) > 1;
    PageDecision decision =
        tools::decide({.target = text(request.target()),
                       .host = is_doubled ? std::string_view() : text(request[http::field::host]),
                       .origin = text(request[http::field::origin]),
                       .is_upgrade = is_upgrade},
                      token_, port_);
    if (decision.verdict != PageVerdict::kServe) ++refused_;
    return decision;
  }

  /// Allows nothing from elsewhere. The WebSocket's address is named, because not every browser
  /// counts it as the same origin.
  [[nodiscard]] std::string policy() const {
    const std::string port = std::to_string(port_);
    return "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
           "connect-src 'self' ws://127.0.0.1:" +
           port + " ws://localhost:" + port + "; frame-ancestors 'none'";
  }

  [[nodiscard]] std::optional<PageAnswer> get(const std::string& path) const {
    const std::string_view wanted = path.empty() ? std::string_view("index.html") : path;
    for (const PageFile& file : files_) {
      if (file.path == wanted) {
        return PageAnswer{std::string(file.type), std::make_shared<const std::string>(file.bytes)};
      }
    }
    return host_.get ? host_.get(wanted) : std::nullopt;
  }

  [[nodiscard]] Clock::duration unseen() const { return unseen_; }

  /// False: there are too many pages already.
  [[nodiscard]] bool join(const std::shared_ptr<Line>& line) {
    if (lines_.size() >= static_cast<std::size_t>(kMostPages)) return false;
    lines_.insert(line);
    return true;
  }
  void leave(const std::shared_ptr<Line>& line) {
    lines_.erase(line);
    if (steering_ == line) steering_.reset();
  }

  void take(const std::shared_ptr<Line>& line, const std::string& message) {
    // The only message that the server itself interprets.
    if (message == R"({"steer":true})") {
      if (!steering_) steering_ = line;
    } else if (message == R"({"steer":false})") {
      if (steering_ == line) steering_.reset();
    } else if (steering_ == line && host_.command) {
      host_.command(message);
    }
  }

  [[nodiscard]] std::string snapshot(const std::shared_ptr<Line>& line, std::uint64_t& seen) {
    return host_.snapshot(seen, {.steers = steering_ == line,
                                 .is_steered = steering_ != nullptr,
                                 .pages = static_cast<int>(lines_.size())});
  }

 private:
  void run() noexcept {
    while (true) {
      try {
        context_.run();
        return;
      } catch (const std::exception&) {
        // Out of memory for one answer: this connection ends, the others go on.
      }
    }
  }
  void acceptNext();
  void wait();

  PageHost host_;
  std::span<const PageFile> files_;
  Clock::duration period_;
  Clock::duration unseen_;
  std::string token_;
  std::uint16_t port_ = 0;
  std::atomic<int> open_{0};
  std::atomic<std::uint64_t> taken_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> turned_away_{0};
  std::atomic<std::uint64_t> bytes_{0};
  std::set<std::shared_ptr<Line>> lines_;
  std::shared_ptr<Line> steering_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  asio::steady_timer nap_;
  std::thread thread_;
};

/// A page that receives messages.
class PageServer::Work::Line : public std::enable_shared_from_this<Line> {
 public:
  Line(Work& work, beast::tcp_stream&& stream) : work_(work), stream_(std::move(stream)) {
    work_.begin();
  }
  ~Line() { work_.end(); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  void begin(const http::request<http::empty_body>& request) {
    // From here on the stream has timers of its own.
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{kPatience, kQuiet, true});
    stream_.read_message_max(kLongestCommand);
    stream_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error || !self->work_.join(self)) return;
      self->is_joined_ = true;
      self->readNext();
    });
  }

  /// Sends the present data, unless the last message is still being sent, or waits in a busy page:
  /// data queued behind it would be outdated when shown.
  void tick() {
    const auto now = Clock::now();
    if (is_writing_ || (!is_seen_ && now - sent_ < work_.unseen())) return;
    is_writing_ = true;
    is_seen_ = false;
    sent_ = now;
    out_ = work_.snapshot(shared_from_this(), seen_);
    stream_.text(true);
    stream_.async_write(asio::buffer(out_),
                        [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                          self->is_writing_ = false;
                          self->work_.sent(bytes);
                          if (error) self->leave();
                        });
  }

 private:
  void readNext() {
    stream_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->leave();
      if (self->isFlood()) return self->cutOff();
      const std::string message = beast::buffers_to_string(self->buffer_.data());
      if (message == kSeen) {
        self->is_seen_ = true;
      } else {
        self->work_.take(self, message);
      }
      self->buffer_.consume(self->buffer_.size());
      self->readNext();
    });
  }

  [[nodiscard]] bool isFlood() {
    const auto now = Clock::now();
    if (now - second_ >= std::chrono::seconds(1)) {
      second_ = now;
      commands_ = 0;
    }
    return ++commands_ > kMostCommands;
  }

  void cutOff() {
    leave();
    error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
  }

  void leave() {
    if (!is_joined_) return;
    is_joined_ = false;
    work_.leave(shared_from_this());
  }

  Work& work_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_{kLongestCommand};
  std::string out_;
  std::uint64_t seen_ = 0;
  bool is_joined_ = false;
  bool is_writing_ = false;
  bool is_seen_ = true;
  Clock::time_point sent_;
  Clock::time_point second_ = Clock::now();
  int commands_ = 0;
};

namespace {

/// A browser that requests files.
template <typename Work, typename Line>
class Connection : public std::enable_shared_from_this<Connection<Work, Line>> {
 public:
  Connection(Work& work, tcp::socket&& socket) : work_(work), stream_(std::move(socket)) {
    work_.begin();
  }
  ~Connection() { work_.end(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void readNext() {
    parser_.emplace();
    parser_->header_limit(kLongestHeader);
    parser_->body_limit(std::uint64_t{0});
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](const error_code& error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

 private:
  void answer() {
    const http::request<http::empty_body> request = parser_->release();
    const bool is_upgrade = websocket::is_upgrade(request);
    const PageDecision decision = work_.decide(request, is_upgrade);
    const bool is_served = decision.verdict == PageVerdict::kServe;
    if (is_served && is_upgrade && decision.path == kLine) {
      std::make_shared<Line>(work_, std::move(stream_))->begin(request);
      return;
    }
    const bool is_head = request.method() == http::verb::head;
    response_ = {};
    bytes_.reset();
    std::optional<PageAnswer> found;
    if (is_served && (is_head || request.method() == http::verb::get)) {
      found = work_.get(decision.path);
    }
    if (found) {
      bytes_ = std::move(found->bytes);
      response_.result(http::status::ok);
      response_.set(http::field::content_type, found->type);
    } else {
      bytes_ = std::make_shared<const std::string>(wordsOf(decision.verdict));
      response_.result(statusOf(decision.verdict));
      response_.set(http::field::content_type, "text/plain; charset=utf-8");
    }
    response_.version(request.version());
    response_.keep_alive(request.keep_alive() && is_served);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Content-Security-Policy", work_.policy());
    response_.body() = {bytes_->data(), is_head ? 0 : bytes_->size()};
    response_.content_length(bytes_->size());
    stream_.expires_after(kPatience);
    http::async_write(
        stream_, response_,
        [self = this->shared_from_this()](const error_code& error, std::size_t bytes) {
          self->work_.sent(bytes);
          if (error) return;
          if (self->response_.keep_alive()) return self->readNext();
          error_code ignored;
          self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        });
  }

  Work& work_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kLongestHeader};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::span_body<const char>> response_;
  std::shared_ptr<const std::string> bytes_;  ///< content of response_
};

}  // namespace

void PageServer::Work::acceptNext() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error) {
      // File descriptors have run out, or the other side closed at once.
      nap_.expires_after(kNap);
      nap_.async_wait([this](const error_code& canceled) {
        if (!canceled) acceptNext();
      });
      return;
    }
    ++taken_;
    if (open_.load() >= kMostConnections) {
      ++turned_away_;
    } else {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<Connection<Work, Line>>(*this, std::move(socket))->readNext();
    }
    acceptNext();
  });
}

void PageServer::Work::wait() {
  timer_.expires_after(period_);
  timer_.async_wait([this](const error_code& canceled) {
    if (canceled) return;
    const std::set<std::shared_ptr<Line>> now = lines_;
    for (const auto& line : now) line->tick();
    wait();
  });
}

PageServer::PageServer(PageHost host, const PageServerSettings& settings)
    : work_(std::make_shared<Work>(std::move(host), settings)) {
  work_->start();
}
PageServer::~PageServer() { work_->stop(); }

std::uint16_t PageServer::port() const noexcept { return work_->port(); }
const std::string& PageServer::token() const noexcept { return work_->token(); }
std::string PageServer::url() const {
  return "http://127.0.0.1:" + std::to_string(port()) + "/" + token() + "/";
}
PageServerCounts PageServer::counts() const noexcept { return work_->counts(); }
int PageServer::connections() const noexcept { return work_->open(); }

}  // namespace palpate::tools
