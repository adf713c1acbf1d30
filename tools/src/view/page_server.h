#pragma once
/// PageServer: serves a page to browsers on this machine, with a connection to each.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "view/page_files.h"

namespace palpate::tools {

/// The bytes of a requested file.
struct PageAnswer {
  std::string type;
  std::shared_ptr<const std::string> bytes;
};

/// The role of one page among the others.
struct PagePlace {
  bool steers = false;      ///< it moves the hand
  bool is_steered = false;  ///< some page moves the hand
  int pages = 0;            ///< number of pages that watch, this one included
};

/// Callbacks of the server. All are called in the server's thread.
struct PageHost {
  /// The content at a path that is not a file of the page; nothing: there is none.
  std::function<std::optional<PageAnswer>(std::string_view path)> get;
  /// Makes the next message to a page; `seen` is the page's own counter, 0 at first.
  std::function<std::string(std::uint64_t& seen, const PagePlace& place)> snapshot;
  /// Handles a message from the page that steers.
  std::function<void(const std::string& message)> command;
};

struct PageServerSettings {
  std::uint16_t port = 0;  ///< 0: any free port
  double rate = 60.0;      ///< [Hz] messages to each page, if it can take them
  double unseen =
      0.25;  ///< [s] after this time a page gets the next message even without {"seen":true}
  std::span<const PageFile> files = {};
};

struct PageServerCounts {
  std::uint64_t connections = 0;  ///< accepted
  std::uint64_t refused = 0;      ///< because of a foreign token, Host or Origin
  std::uint64_t turned_away = 0;  ///< because there were too many
  std::uint64_t bytes = 0;        ///< sent
};

/// Listens on 127.0.0.1 only, below a folder whose name nobody can guess. It has one thread. No
/// browser can delay others, whatever it does, and memory is bounded: there are limits for the
/// number of connections, for the messages under way to each (one), and for the size and rate of
/// messages from each.
///
/// A page sends {"seen":true} for each message that it has shown, and then gets the next one;
/// without it, after a while. The page that sends {"steer":true} steers until it sends false or
/// disconnects; commands of other pages are dropped.
class PageServer {
 public:
  static constexpr int kMostConnections = 64;
  static constexpr int kMostPages = 16;
  /// [1/s] for a page; a page that sends more is disconnected
  static constexpr int kMostCommands = 1000;
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
  [[nodiscard]] int connections() const noexcept;  ///< open ones

 private:
  class Work;
  std::shared_ptr<Work> work_;
};

}  // namespace palpate::tools
