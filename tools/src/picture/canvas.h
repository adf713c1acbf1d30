#pragma once
/// A sheet to draw on, in pixels from the top left. The only file that uses the drawing library.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace palpate::tools {

struct Color {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
};

/// 0xRRGGBB
[[nodiscard]] constexpr Color rgb(std::uint32_t hex, double alpha = 1.0) {
  return {((hex >> 16U) & 255U) / 255.0, ((hex >> 8U) & 255U) / 255.0, (hex & 255U) / 255.0, alpha};
}

struct Pixel {
  double x = 0.0, y = 0.0;
};

/// A picture in memory, opaque, of 8 bits a channel.
struct Raster {
  Raster(int w, int h)
      : width(w), height(h), words(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  void set(int x, int y, const Color& color) {
    words[static_cast<std::size_t>(x) +
          static_cast<std::size_t>(width) * static_cast<std::size_t>(y)] = word(color);
  }
  /// 0xRRGGBB
  [[nodiscard]] static std::uint32_t word(const Color& c) {
    const auto byte = [](double share) {
      return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255.0));
    };
    return (byte(c.r) << 16U) | (byte(c.g) << 8U) | byte(c.b);
  }
  int width;
  int height;
  std::vector<std::uint32_t> words;  ///< 0xRRGGBB, row by row from the top
};

struct Stroke {
  Color color;
  double width = 1.0;
  std::vector<double> dash = {};
};

enum class Align { kLeft, kCenter, kRight };

struct TextStyle {
  double size = 14.0;
  Color color = {};
  bool bold = false;
  bool italic = false;
  Align align = Align::kLeft;
  double halo = 0.0;     ///< width of a light rim around the letters
  bool upright = false;  ///< rotated to be read from below
};

class Canvas {
 public:
  Canvas(int width, int height);
  ~Canvas();

  void fill(const Color& color);
  void image(const Raster& raster, double x, double y);
  void rectangle(double x, double y, double w, double h, const Color& color, double radius = 0.0);
  void frame(double x, double y, double w, double h, const Stroke& stroke);
  void line(const std::vector<Pixel>& points, const Stroke& stroke, bool closed = false);
  void polygon(const std::vector<Pixel>& points, const Color& color);
  void disk(const Pixel& center, double radius, const Color& color);
  /// A straight arrow with a filled head at `to`.
  void arrow(const Pixel& from, const Pixel& to, const Stroke& stroke, double head);
  /// `at` is on the baseline.
  void text(const Pixel& at, const std::string& text, const TextStyle& style);
  [[nodiscard]] double textWidth(const std::string& text, const TextStyle& style);
  /// Restricts drawing to the rectangle until unclip().
  void clip(double x, double y, double w, double h);
  void unclip();
  /// Four bytes for each pixel: blue, green, red and an unused one. Valid until the canvas is drawn
  /// to or destroyed.
  struct Bytes {
    const unsigned char* data = nullptr;
    int width = 0;
    int height = 0;
    int stride = 0;  ///< [bytes] from one row to the next
  };
  [[nodiscard]] Bytes bytes() const;
  /// The sheet as a PNG file. @throws Error (kOperation).
  [[nodiscard]] std::string png() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::tools
