#include "keep/content_key.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

#include "palpate/core/stop.h"

namespace palpate::vdb {

// Each step is invertible, so that neither half loses a difference. The halves have different
// multipliers and rotations, so that inputs that collide in one differ in the other.
void ContentKey::mix(std::uint64_t word) noexcept {
  state_[0] = (state_[0] ^ word) * 0x9E3779B97F4A7C15U;
  state_[0] ^= state_[0] >> 29;
  state_[1] = std::rotl(state_[1] ^ word, 27) * 0xD6E8FEB86659FD93U;
  state_[1] ^= state_[1] >> 32;
}

ContentKey& ContentKey::add(std::string_view text) {
  mix(text.size());
  return addBytes(text.data(), text.size());
}

ContentKey& ContentKey::add(double value) {
  mix(std::bit_cast<std::uint64_t>(value));
  return *this;
}

ContentKey& ContentKey::addBytes(const void* bytes, std::size_t count) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (; count > 0;) {
    const std::size_t piece = std::min(count, sizeof(std::uint64_t));
    std::uint64_t word = 0;
    std::memcpy(&word, at, piece);
    mix(word);
    at += piece;
    count -= piece;
  }
  return *this;
}

bool ContentKey::addFile(const std::string& path, std::uint64_t but) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) return false;
  const auto end = static_cast<std::int64_t>(in.tellg());
  if (end < 0 || static_cast<std::uint64_t>(end) < but) return false;
  std::uint64_t left = static_cast<std::uint64_t>(end) - but;
  mix(left);
  in.seekg(0);
  std::vector<char> buffer(std::size_t{1} << 20U);
  while (left > 0) {
    pollStop();
    const std::uint64_t piece = std::min<std::uint64_t>(left, buffer.size());
    if (!in.read(buffer.data(), static_cast<std::streamsize>(piece))) return false;
    addBytes(buffer.data(), piece);
    left -= piece;
  }
  return true;
}

std::string ContentKey::text() const {
  // The last words added have passed through few steps, so mix again.
  ContentKey last = *this;
  for (const std::uint64_t half : state_) last.mix(half);
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx",
                static_cast<unsigned long long>(last.state_[0]),
                static_cast<unsigned long long>(last.state_[1]));
  return text;
}

}  // namespace palpate::vdb
