#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "palpate/devices/inverse3.h"

namespace palpate::devices {

bool hasInverseService(const Inverse3Settings& settings) noexcept {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(settings.port);
  if (inet_pton(AF_INET, settings.host.c_str(), &address.sin_addr) != 1) return false;
  const int number = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (number < 0) return false;
  const bool is_there =
      connect(number, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(number);
  return is_there;
}

}  // namespace palpate::devices
