#pragma once
/// PageServer: a page for the browsers of this machine, and a line to each.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "view/page_files.h"

namespace palpate::tools {

/// Bytes that a page asked for.
struct PageAnswer {
  std::string type;
  std::shared_ptr<const std::string> bytes;
};

/// What one page is to the others.
struct PagePlace {
  bool steers = false;      ///< it moves the hand
  bool is_steered = false;  ///< some page does
  int pages = 0;            ///< that watch, this one included
};

/// Whom the server asks. All is called in the server's thread.
struct PageHost {
  /// What stands at a path that is none of the page's files; none: nothing.
  std::function<std::optional<PageAnswer>(std::string_view path)> get;
  /// The next message to a page; `seen` is its own, 0 at first.
  std::function<std::string(std::uint64_t& seen, const PagePlace& place)> snapshot;
  /// A message of the page that steers.
  std::function<void(const std::string& message)> command;
};

struct PageServerSettings {
  std::uint16_t port = 0;  ///< 0: any that is free
  double rate = 60.0;      ///< [Hz] messages to each page, if it takes them
  double unseen =
      0.25;  ///< [s] then a page that has not said {"seen":true} gets the next one all the same
  std::span<const PageFile> files = {};
};

struct PageServerCounts {
  std::uint64_t connections = 0;  ///< taken
  std::uint64_t refused = 0;      ///< for a token, a Host or an Origin that is not ours
  std::uint64_t turned_away = 0;  ///< for want of room
  std::uint64_t bytes = 0;        ///< sent
};

/// On 127.0.0.1 only, below a folder whose name nobody can guess. One thread of its own; what a
/// browser does or leaves undone holds up nobody else, and takes bounded memory: so many
/// connections, one message under way to each, messages of so many bytes and so many a second from
/// each.
///
/// A page sends {"seen":true} for each message that it has shown, and gets the next one then, or
/// after a while. The page that sends {"steer":true} steers, until it sends false or goes; commands
/// of others are dropped.
class PageServer {
 public:
  static constexpr int kMostConnections = 64;
  static constexpr int kMostPages = 16;
  static constexpr int kMostCommands = 1000;            ///< [1/s] of a page; beyond, it is cut off
  static constexpr std::size_t kLongestCommand = 4096;  ///< [bytes]

  /// Listens, and starts the thread. @throws Error (kOperation) if the port is taken.
  PageServer(PageHost host, const PageServerSettings& settings);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  [[nodiscard]] std::uint16_t port() const noexcept;
  [[nodiscard]] const std::string& token() const noexcept;
  [[nodiscard]] std::string url() const;  ///< "http://127.0.0.1:PORT/TOKEN/"
  [[nodiscard]] PageServerCounts counts() const noexcept;
  [[nodiscard]] int connections() const noexcept;  ///< that are open

 private:
  class Work;
  std::shared_ptr<Work> work_;
};

}  // namespace palpate::tools
