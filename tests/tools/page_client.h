#pragma once
// A browser as tests need one: asks, listens, and misbehaves.

#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace palpate::testing {

struct HttpReply {
  int status = 0;
  std::string type;
  std::string body;
};

/// A connection to 127.0.0.1, blocking.
class PageSocket {
 public:
  explicit PageSocket(std::uint16_t port) : socket_(context_) {
    socket_.connect({boost::asio::ip::address_v4::loopback(), port});
  }

  void send(const std::string& bytes) {
    boost::system::error_code ignored;
    boost::asio::write(socket_, boost::asio::buffer(bytes), ignored);
  }

  /// The answer to a GET of `target`.
  [[nodiscard]] HttpReply get(const std::string& target, const std::string& host,
                              const std::string& origin = {}) {
    send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" +
         (origin.empty() ? std::string() : "Origin: " + origin + "\r\n") + "\r\n");
    boost::beast::flat_buffer buffer;
    boost::beast::http::response<boost::beast::http::string_body> reply;
    boost::system::error_code error;
    boost::beast::http::read(socket_, buffer, reply, error);
    if (error) return {};
    return {static_cast<int>(reply.result_int()),
            std::string(reply[boost::beast::http::field::content_type]), reply.body()};
  }

  /// Closes the connection by a TCP reset, without a regular shutdown.
  void kill() {
    const linger at_once{1, 0};
    setsockopt(socket_.native_handle(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

 private:
  boost::asio::io_context context_;
  boost::asio::ip::tcp::socket socket_;
};

/// A page's WebSocket connection to the server.
class PageLine {
 public:
  explicit PageLine(std::uint16_t port) : port_(port), stream_(context_) {
    stream_.next_layer().connect({boost::asio::ip::address_v4::loopback(), port});
  }

  /// False if the server refuses. An empty `origin` is not sent.
  [[nodiscard]] bool open(const std::string& token, const std::string& origin) {
    namespace websocket = boost::beast::websocket;
    stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      if (!origin.empty()) request.set(boost::beast::http::field::origin, origin);
    }));
    boost::system::error_code error;
    stream_.handshake("127.0.0.1:" + std::to_string(port_), "/" + token + "/live", error);
    return !error;
  }
  [[nodiscard]] bool open(const std::string& token) {
    return open(token, "http://127.0.0.1:" + std::to_string(port_));
  }

  /// False once the server has hung up.
  bool say(const std::string& text) {
    boost::system::error_code error;
    stream_.write(boost::asio::buffer(text), error);
    return !error;
  }
  /// The next message, which is reported as seen; nothing once the server has hung up.
  [[nodiscard]] std::optional<std::string> hear() {
    std::optional<std::string> heard = hearOnly();
    if (heard) (void)say(R"({"seen":true})");
    return heard;
  }
  /// The next message, which is not reported as seen; nothing once the server has hung up.
  [[nodiscard]] std::optional<std::string> hearOnly() {
    boost::beast::flat_buffer buffer;
    boost::system::error_code error;
    stream_.read(buffer, error);
    if (error) return std::nullopt;
    return boost::beast::buffers_to_string(buffer.data());
  }
  void kill() {
    const linger at_once{1, 0};
    setsockopt(stream_.next_layer().native_handle(), SOL_SOCKET, SO_LINGER, &at_once,
               sizeof at_once);
    boost::system::error_code ignored;
    stream_.next_layer().close(ignored);
  }

 private:
  std::uint16_t port_;
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> stream_;
};

}  // namespace palpate::testing
