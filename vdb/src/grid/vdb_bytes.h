#pragma once
/// Reads bytes of a stream in order through a window; bytes that are skipped are not read.

#include <cstdint>
#include <cstring>
#include <istream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "palpate/core/stop.h"

namespace palpate::vdb {

class VdbBytes {
 public:
  explicit VdbBytes(std::istream& stream) : stream_(stream) {
    const auto here = stream_.tellg();
    stream_.seekg(0, std::ios::end);
    size_ = stream_.tellg();
    stream_.seekg(here);
  }

  void seek(std::int64_t position) {
    if (position < 0 || position > size_) throw std::runtime_error("it is cut short");
    at_ = position;
  }
  [[nodiscard]] std::int64_t position() const noexcept { return at_; }
  [[nodiscard]] std::int64_t left() const noexcept { return size_ - at_; }
  [[nodiscard]] std::istream& stream() const noexcept { return stream_; }

  void skip(std::int64_t bytes) {
    require(bytes);
    at_ += bytes;
  }
  void take(void* out, std::int64_t bytes) {
    require(bytes);
    auto* to = static_cast<char*>(out);
    while (bytes > 0) {
      if (at_ < begin_ || at_ >= begin_ + static_cast<std::int64_t>(window_.size())) refill();
      const std::int64_t from = at_ - begin_;
      const std::int64_t here = std::min(bytes, static_cast<std::int64_t>(window_.size()) - from);
      std::memcpy(to, window_.data() + from, static_cast<std::size_t>(here));
      to += here;
      at_ += here;
      bytes -= here;
    }
  }
  template <typename Number>
  Number take() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value{};
    take(&value, sizeof value);
    return value;
  }
  /// Reads a 32-bit length, then a text of that many bytes; at most `longest` of them.
  std::string takeText(std::uint32_t longest) {
    const auto length = take<std::uint32_t>();
    if (length > longest || length > left()) {
      throw std::runtime_error("a text of " + std::to_string(length) + " bytes is too long");
    }
    std::string text(length, '\0');
    take(text.data(), length);
    return text;
  }

 private:
  static constexpr std::int64_t kWindow = std::int64_t{1} << 16U;

  void require(std::int64_t bytes) const {
    if (bytes < 0 || bytes > left()) throw std::ios_base::failure("the end of the file");
  }
  void refill() {
    pollStop();
    window_.resize(static_cast<std::size_t>(std::min(kWindow, size_ - at_)));
    stream_.seekg(at_);
    stream_.read(window_.data(), static_cast<std::streamsize>(window_.size()));
    begin_ = at_;
  }

  std::istream& stream_;
  std::int64_t size_ = 0;
  std::int64_t at_ = 0;
  std::int64_t begin_ = 0;  ///< where the window begins in the file
  std::vector<char> window_;
};

}  // namespace palpate::vdb
