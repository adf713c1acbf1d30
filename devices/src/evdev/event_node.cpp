#include "evdev/event_node.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>

namespace palpate::devices::evdev {
namespace {

/// The first bits of a kernel's answer, which is an array of machine words; they are little-endian
/// on all machines that this is built for.
template <std::size_t kSize>
bool bitsOf(int descriptor, unsigned long request, std::bitset<kSize>& out,
            std::array<unsigned char, (kSize + 7) / 8>& bytes) noexcept {
  if (ioctl(descriptor, request, bytes.data()) < 0) return false;
  for (std::size_t i = 0; i < kSize; ++i) out[i] = ((bytes[i / 8] >> (i % 8)) & 1) != 0;
  return true;
}

template <std::size_t kSize>
bool codesOf(int descriptor, int type, std::bitset<kSize>& out) noexcept {
  std::array<unsigned char, (kSize + 7) / 8> bytes{};
  return bitsOf(descriptor, EVIOCGBIT(type, bytes.size()), out, bytes);
}

}  // namespace

int EventNode::open(const std::string& path) noexcept {
  close();
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  return descriptor_ >= 0 ? 0 : errno;
}

void EventNode::close() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

std::string EventNode::name() const {
  std::array<char, 256> text{};
  if (ioctl(descriptor_, EVIOCGNAME(text.size() - 1), text.data()) < 0) return {};
  return text.data();
}

std::optional<Capabilities> EventNode::capabilities() const {
  Capabilities out;
  std::bitset<EV_CNT> types;
  if (!codesOf(descriptor_, 0, types)) return std::nullopt;
  if (types[EV_KEY] && !codesOf(descriptor_, EV_KEY, out.keys)) return std::nullopt;
  if (types[EV_REL] && !codesOf(descriptor_, EV_REL, out.relative)) return std::nullopt;
  if (types[EV_ABS] && !codesOf(descriptor_, EV_ABS, out.absolute)) return std::nullopt;
  for (std::size_t code = 0; code < out.ranges.size(); ++code) {
    if (out.absolute[code] && ioctl(descriptor_, EVIOCGABS(code), &out.ranges[code]) < 0) {
      return std::nullopt;
    }
  }
  return out;
}

bool EventNode::setMonotonic() const noexcept {
  int clock = CLOCK_MONOTONIC;
  return ioctl(descriptor_, EVIOCSCLOCKID, &clock) == 0;
}

bool EventNode::value(std::uint16_t absolute_code, std::int32_t& out) const noexcept {
  input_absinfo info{};
  if (ioctl(descriptor_, EVIOCGABS(absolute_code), &info) < 0) return false;
  out = info.value;
  return true;
}

bool EventNode::keys(std::bitset<KEY_CNT>& out) const noexcept {
  std::array<unsigned char, (KEY_CNT + 7) / 8> bytes{};
  return bitsOf(descriptor_, EVIOCGKEY(bytes.size()), out, bytes);
}

ssize_t EventNode::read(input_event* out, std::size_t count) const noexcept {
  return ::read(descriptor_, out, count * sizeof(input_event));
}

}  // namespace palpate::devices::evdev
