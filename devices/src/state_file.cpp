#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "palpate/devices/record.h"
#include "palpate/version.h"

namespace palpate::devices {
namespace {

// A header, followed by states of one size: little-endian, as they are in memory.
struct Header {
  std::array<char, 8> magic{'P', 'A', 'L', 'P', 'S', 'T', '0', '1'};
  std::array<char, 184> build{};  ///< stateBuild(), padded with zeros
  std::uint64_t state_bytes = sizeof(SessionState);
  std::uint64_t about = 0;  ///< checksum of the description of the record
  std::uint64_t sum = 0;    ///< checksum of everything above
};
static_assert(sizeof(Header) == 216);

struct StateHeader {
  std::uint64_t tick = 0;
  std::uint64_t sum = 0;  ///< checksum of the tick number followed by the state's bytes
};

constexpr std::size_t kStride = sizeof(StateHeader) + sizeof(SessionState);

std::string_view bytesOf(const void* from, std::size_t count) noexcept {
  return {static_cast<const char*>(from), count};
}

std::uint64_t sumOf(std::uint64_t tick, const char* state) noexcept {
  return checksum({state, sizeof(SessionState)}, checksum(bytesOf(&tick, sizeof tick)));
}

Header headerAbout(std::string_view about) {
  Header header;
  const std::string build = stateBuild();
  std::copy_n(build.begin(), std::min(build.size(), header.build.size() - 1), header.build.begin());
  header.about = checksum(about);
  header.sum = checksum(bytesOf(&header, offsetof(Header, sum)));
  return header;
}

Error badStates(const std::string& message, const std::string& hint, const std::string& file) {
  return inputError("record.states", message, hint, file);
}

}  // namespace

std::uint64_t checksum(std::string_view bytes, std::uint64_t begin) noexcept {
  std::uint64_t sum = begin;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return sum;
}

std::string stateBuild() {
  // Most changes of the layout that keep the total size change the offset of some part.
  const std::array<std::uint64_t, 4> layout = {RendererState::layout(), sizeof(RendererState),
                                               sizeof(VelocityTracker), sizeof(Clutch)};
  return std::string("palpate " PALPATE_VERSION_STRING ", " __VERSION__ ", ") +
         std::to_string(sizeof(SessionState)) + " bytes, layout " +
         std::to_string(checksum(bytesOf(layout.data(), sizeof layout)));
}

StateFile::StateFile(const std::string& file, std::string name, std::string_view about)
    : out_(file, std::move(name)) {
  const Header header = headerAbout(about);
  out_.append(&header, sizeof header, sizeof header);
}

void StateFile::addState(const SessionState& state) {
  std::string bytes(kStride, '\0');
  std::memcpy(bytes.data() + sizeof(StateHeader), &state, sizeof state);
  const StateHeader header{state.ticks, sumOf(state.ticks, bytes.data() + sizeof(StateHeader))};
  std::memcpy(bytes.data(), &header, sizeof header);
  out_.append(bytes.data(), bytes.size(), bytes.size());
}

StateReader::StateReader(std::string file, std::string_view about) : file_(std::move(file)) {
  std::error_code failed;
  const bool is_file = std::filesystem::is_regular_file(file_, failed);
  const std::uint64_t bytes = is_file ? std::filesystem::file_size(file_, failed) : 0;
  if (is_file) in_.open(file_, std::ios::binary);
  if (!is_file || failed || !in_) {
    throw inputError("record.unreadable", "the file of states is missing or cannot be opened",
                     "without it a replay can only begin at the first tick", file_);
  }
  const Header ours = headerAbout(about);
  Header header;
  std::array<char, sizeof(Header)> raw{};
  in_.read(raw.data(), raw.size());
  std::memcpy(&header, raw.data(), raw.size());
  if (!in_ || header.magic != ours.magic ||
      header.sum != checksum(bytesOf(&header, offsetof(Header, sum)))) {
    throw badStates("this file does not hold states, or its header is damaged",
                    "remove it to replay from the first tick", file_);
  }
  header.build.back() = '\0';
  if (header.build != ours.build || header.state_bytes != ours.state_bytes) {
    throw badStates("these states were saved by another build, '" +
                        std::string(header.build.data()) + "'; this one is '" +
                        std::string(ours.build.data()) + "'",
                    "replay from the first tick: every build can", file_);
  }
  if (header.about != ours.about) {
    throw badStates("these states belong to another record",
                    "the files FILE.npy, FILE.npy.json and FILE.npy.states go together", file_);
  }
  const std::uint64_t count = (bytes - sizeof(Header)) / kStride;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t tick = 0;
    in_.seekg(static_cast<std::streamoff>(sizeof(Header) + i * kStride));
    std::array<char, sizeof tick> number{};
    in_.read(number.data(), number.size());
    if (!in_) break;
    std::memcpy(&tick, number.data(), number.size());
    ticks_.push_back(tick);
  }
}

std::optional<SessionState> StateReader::before(std::uint64_t tick) {
  std::string bytes(kStride, '\0');
  for (std::size_t i = ticks_.size(); i-- > 0;) {
    if (ticks_[i] > tick) continue;
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(sizeof(Header) + i * kStride));
    in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!in_) continue;
    StateHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    const char* state = bytes.data() + sizeof header;
    if (header.sum != sumOf(header.tick, state) || header.tick > tick) continue;  // damaged
    SessionState out;
    std::memcpy(static_cast<void*>(&out), state, sizeof out);
    if (out.ticks == header.tick) return out;
  }
  return std::nullopt;
}

}  // namespace palpate::devices
