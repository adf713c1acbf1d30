#include "view/page_request.h"

#include <sys/random.h>

#include <array>

#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

/// Compares in a time that does not reveal how many characters agree.
bool isSame(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  }
  return difference == 0;
}

}  // namespace

PageDecision decide(const PageRequest& request, std::string_view token, std::uint16_t port) {
  const std::string by_number = "127.0.0.1:" + std::to_string(port);
  const std::string by_name = "localhost:" + std::to_string(port);
  if (request.host != by_number && request.host != by_name) return {PageVerdict::kForeignHost};
  const bool has_origin = !request.origin.empty();
  const std::string own = "http://" + std::string(request.host);
  if ((has_origin || request.is_upgrade) && request.origin != own) {
    return {PageVerdict::kForeignOrigin};
  }
  std::string_view path = request.target.substr(0, request.target.find_first_of("?#"));
  if (path.size() < token.size() + 2 || path[0] != '/' || path[token.size() + 1] != '/' ||
      !isSame(path.substr(1, token.size()), token)) {
    return {PageVerdict::kWrongToken};
  }
  return {PageVerdict::kServe, std::string(path.substr(token.size() + 2))};
}

std::string randomToken() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw Error(ErrorKind::kOperation,
                {"view.token", "the system gives no random numbers for the page's address"});
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

}  // namespace palpate::tools
