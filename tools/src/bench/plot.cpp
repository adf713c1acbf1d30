#include "bench/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace palpate::tools {
namespace {

constexpr double kWidth = 1200.0;
constexpr double kHeight = 800.0;
constexpr double kLeft = 90.0;
constexpr double kRight = 850.0;
constexpr double kTop = 80.0;
constexpr double kBottom = 730.0;
constexpr double kMark = 9.0;  ///< radius of a mark
constexpr std::array<const char*, 2> kColors = {"#1f5fa8", "#c4571b"};

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string words(double x, double y, const char* attributes, const std::string& text) {
  return "<text x='" + number(x) + "' y='" + number(y) + "' " + attributes + ">" + escaped(text) +
         "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* stroke) {
  return "<line x1='" + number(x1) + "' y1='" + number(y1) + "' x2='" + number(x2) + "' y2='" +
         number(y2) + "' stroke='" + stroke + "'/>\n";
}

/// Whole decades around the values, on a stretch of the page.
struct Axis {
  int first = 0;
  int last = 1;
  double from = 0.0;
  double to = 1.0;

  [[nodiscard]] double at(double value) const noexcept {
    return from + (to - from) * (std::log10(value) - first) / (last - first);
  }
};

Axis axisFor(double least, double most, double from, double to) {
  Axis axis{static_cast<int>(std::floor(std::log10(least))),
            static_cast<int>(std::ceil(std::log10(most))), from, to};
  axis.last = std::max(axis.last, axis.first + 1);
  return axis;
}

std::string decade(int exponent) {
  return "10<tspan dy='-6' font-size='10'>" + std::to_string(exponent) + "</tspan>";
}

std::string axes(const Plot& plot, const Axis& x, const Axis& y) {
  std::string out;
  for (int e = x.first; e <= x.last; ++e) {
    const double at = x.at(std::pow(10.0, e));
    out += line(at, kTop, at, kBottom, "#bbb");
    out += "<text x='" + number(at) + "' y='" + number(kBottom + 22.0) + "' text-anchor='middle'>" +
           decade(e) + "</text>\n";
    for (int k = 2; k < 10 && e < x.last; ++k) {
      const double between = x.at(k * std::pow(10.0, e));
      out += line(between, kTop, between, kBottom, "#eee");
    }
  }
  const int stride = y.last - y.first > 10 ? 2 : 1;
  for (int e = y.first; e <= y.last; ++e) {
    const double at = y.at(std::pow(10.0, e));
    out += line(kLeft, at, kRight, at, "#ddd");
    if ((e - y.first) % stride == 0) {
      out += "<text x='" + number(kLeft - 8.0) + "' y='" + number(at + 5.0) +
             "' text-anchor='end'>" + decade(e) + "</text>\n";
    }
  }
  out += words(0.5 * (kLeft + kRight), kBottom + 52.0, "text-anchor='middle'", plot.x_label);
  const std::string turned =
      "text-anchor='middle' transform='rotate(-90 28 " + number(0.5 * (kTop + kBottom)) + ")'";
  return out + words(28.0, 0.5 * (kTop + kBottom), turned.c_str(), plot.y_label);
}

struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// The free spot nearest to `wanted`, on a spiral around it.
Spot freeSpot(const Spot& wanted, const std::vector<Spot>& taken) {
  const auto is_free = [&](const Spot& spot) {
    return std::none_of(taken.begin(), taken.end(), [&](const Spot& other) {
      return std::hypot(spot.x - other.x, spot.y - other.y) < 2.0 * kMark + 1.0;
    });
  };
  for (int i = 0; i < 2000; ++i) {
    const double radius = 0.1 * i;
    const double angle = i * std::numbers::phi * 2.0 * std::numbers::pi;
    const Spot spot{wanted.x + radius * std::cos(angle), wanted.y + radius * std::sin(angle)};
    if (spot.x >= kLeft && spot.x <= kRight && spot.y >= kTop && spot.y <= kBottom &&
        is_free(spot)) {
      return spot;
    }
  }
  return wanted;
}

std::string mark(const Spot& spot, std::size_t series, const std::string& label) {
  const char* color = kColors[series % kColors.size()];
  std::string shape;
  if (series % kColors.size() == 0) {
    shape =
        "<circle cx='" + number(spot.x) + "' cy='" + number(spot.y) + "' r='" + number(kMark) + "'";
  } else {
    shape = "<rect x='" + number(spot.x - kMark) + "' y='" + number(spot.y - kMark) + "' width='" +
            number(2.0 * kMark) + "' height='" + number(2.0 * kMark) + "'";
  }
  return shape + " fill='" + color + "'/>\n" +
         words(spot.x, spot.y + 4.0, "text-anchor='middle' font-size='11' fill='#fff'", label);
}

}  // namespace

std::string plotSvg(const Plot& plot) {
  double least_x = 1e300;
  double most_x = 0.0;
  double most_y = plot.least_y;
  for (const PlotPoint& point : plot.points) {
    least_x = std::min(least_x, point.x);
    most_x = std::max(most_x, point.x);
    most_y = std::max(most_y, point.y);
  }
  if (plot.points.empty()) least_x = most_x = 1.0;
  const Axis x = axisFor(least_x, most_x, kLeft, kRight);
  const Axis y = axisFor(plot.least_y, most_y, kBottom, kTop);

  std::string out = "<svg xmlns='http://www.w3.org/2000/svg' width='" + number(kWidth) +
                    "' height='" + number(kHeight) + "' viewBox='0 0 " + number(kWidth) + " " +
                    number(kHeight) +
                    "' font-family='sans-serif' font-size='14'>\n"
                    "<rect width='100%' height='100%' fill='#fff'/>\n";
  out += words(kLeft, 34.0, "font-size='20'", plot.title);
  out += words(kLeft, 58.0, "font-size='12' fill='#555'", plot.subtitle);
  out += axes(plot, x, y);

  std::vector<Spot> taken;
  std::string marks;
  for (const PlotPoint& point : plot.points) {
    const Spot wanted{x.at(point.x), y.at(std::max(point.y, plot.least_y))};
    const Spot spot = freeSpot(wanted, taken);
    taken.push_back(spot);
    out += line(wanted.x, wanted.y, spot.x, spot.y, "#555");
    marks += mark(spot, point.series, std::to_string(point.number));
  }
  out += marks;

  double at = kTop + 10.0;
  for (std::size_t i = 0; i < plot.series.size(); ++i, at += 26.0) {
    out += mark({kRight + 40.0, at}, i, "");
    out += words(kRight + 60.0, at + 5.0, "", plot.series[i]);
  }
  at += 14.0;
  for (std::size_t i = 0; i < plot.key.size(); ++i, at += 22.0) {
    out += words(kRight + 48.0, at, "text-anchor='end' fill='#555'", std::to_string(i + 1));
    out += words(kRight + 60.0, at, "", plot.key[i]);
  }
  return out + "</svg>\n";
}

}  // namespace palpate::tools
