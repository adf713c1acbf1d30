#pragma once
/// Decides which requests of a browser are answered.

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::tools {

/// The statements of a request, as received.
struct PageRequest {
  std::string_view target;  ///< "/TOKEN/index.html?x"
  std::string_view host;    ///< of the header; empty: none
  std::string_view origin;  ///< of the header; empty: none
  bool is_upgrade = false;  ///< asks for a WebSocket
};

enum class PageVerdict : std::uint8_t {
  kServe,
  kForeignHost,    ///< the host has a foreign name that resolves to this machine: DNS rebinding
  kForeignOrigin,  ///< the request comes from a page of another site
  kWrongToken,
};

struct PageDecision {
  PageVerdict verdict = PageVerdict::kWrongToken;
  std::string path = {};  ///< below the page's folder, without query; empty: the folder itself
};

/// Whether a request at `port` comes from the page whose folder is `token`. A WebSocket needs an
/// Origin, which every browser sends.
[[nodiscard]] PageDecision decide(const PageRequest& request, std::string_view token,
                                  std::uint16_t port);

/// 128 random bits that nobody can guess, as hexadecimal digits. @throws Error (kOperation) if the
/// system provides none.
[[nodiscard]] std::string randomToken();

}  // namespace palpate::tools
