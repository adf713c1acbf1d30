#pragma once
/// Which requests of a browser are answered.

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::tools {

/// What a request says of itself, as it came.
struct PageRequest {
  std::string_view target;  ///< "/TOKEN/index.html?x"
  std::string_view host;    ///< of the header; empty: none
  std::string_view origin;  ///< of the header; empty: none
  bool is_upgrade = false;  ///< to a WebSocket
};

enum class PageVerdict : std::uint8_t {
  kServe,
  kForeignHost,    ///< a name that leads here was asked for: DNS rebinding
  kForeignOrigin,  ///< a page of somebody else asks
  kWrongToken,
};

struct PageDecision {
  PageVerdict verdict = PageVerdict::kWrongToken;
  std::string path = {};  ///< below the page's folder, without query; empty: the folder itself
};

/// Whether a request at `port` is one of the page whose folder is `token`. A WebSocket needs an
/// Origin, as each browser sends it.
[[nodiscard]] PageDecision decide(const PageRequest& request, std::string_view token,
                                  std::uint16_t port);

/// 128 bits that nobody can guess, in hexadecimal digits. @throws Error (kOperation) if the system
/// has none.
[[nodiscard]] std::string randomToken();

}  // namespace palpate::tools
