#pragma once
// Reads the pixels of a PNG file written by the command.

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace palpate::testing {

struct Pixels {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< row by row from the top

  [[nodiscard]] const std::array<std::uint8_t, 3>& at(std::size_t x, std::size_t y) const {
    return colors[y * width + x];
  }
};

/// Supports 8 bits a channel, RGB or RGBA, not interlaced; for others the result is empty.
inline Pixels pixelsOf(const std::string& png) {
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(png[at]); };
  const auto number = [&](std::size_t at) {
    return std::size_t{byte(at)} << 24U | std::size_t{byte(at + 1)} << 16U |
           std::size_t{byte(at + 2)} << 8U | byte(at + 3);
  };
  Pixels out;
  std::size_t channels = 0;
  std::string packed;
  for (std::size_t at = 8; at + 12 <= png.size(); at += 12 + number(at)) {
    const std::string kind = png.substr(at + 4, 4);
    if (kind == "IDAT") packed += png.substr(at + 8, number(at));
    if (kind != "IHDR") continue;
    if (byte(at + 16) != 8 || byte(at + 20) != 0) return {};
    channels = byte(at + 17) == 2 ? 3 : byte(at + 17) == 6 ? 4 : 0;
    out.width = number(at + 8);
    out.height = number(at + 12);
  }
  if (channels == 0) return {};
  const std::size_t row = out.width * channels;
  std::vector<std::uint8_t> raw((row + 1) * out.height);
  uLongf size = raw.size();
  if (uncompress(raw.data(), &size, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) !=
      Z_OK) {
    return {};
  }
  std::vector<std::uint8_t> above(row, 0), line(row);
  for (std::size_t y = 0; y < out.height; ++y) {
    const std::uint8_t* const from = raw.data() + y * (row + 1);
    for (std::size_t i = 0; i < row; ++i) {
      const int left = i >= channels ? line[i - channels] : 0;
      const int up = above[i];
      const int corner = i >= channels ? above[i - channels] : 0;
      int guess = 0;
      switch (from[0]) {
        case 1:
          guess = left;
          break;
        case 2:
          guess = up;
          break;
        case 3:
          guess = (left + up) / 2;
          break;
        case 4: {
          const int a = std::abs(up - corner), b = std::abs(left - corner),
                    c = std::abs(left + up - 2 * corner);
          guess = a <= b && a <= c ? left : b <= c ? up : corner;
          break;
        }
        default:
          break;
      }
      line[i] = static_cast<std::uint8_t>(from[i + 1] + guess);
    }
    for (std::size_t x = 0; x < out.width; ++x) {
      const std::uint8_t* const p = line.data() + x * channels;
      out.colors.push_back({p[0], p[1], p[2]});
    }
    std::swap(line, above);
  }
  return out;
}

}  // namespace palpate::testing
