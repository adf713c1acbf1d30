#include "bench/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "markup.h"

namespace palpate::tools {
namespace {

std::string decade(int exponent) {
  return "10<tspan dy='-6' font-size='10'>" + std::to_string(exponent) + "</tspan>";
}

}  // namespace

double Axis::at(double value) const noexcept {
  return from + (to - from) * (std::log10(value) - first) / (last - first);
}

Axis axisFor(double least, double most, double from, double to) {
  Axis axis{static_cast<int>(std::floor(std::log10(least))),
            static_cast<int>(std::ceil(std::log10(most))), from, to};
  axis.last = std::max(axis.last, axis.first + 1);
  return axis;
}

std::string svgNumber(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string svgText(double x, double y, const std::string& attributes, const std::string& text) {
  return "<text x='" + svgNumber(x) + "' y='" + svgNumber(y) + "' " + attributes + ">" +
         markupText(text) + "</text>\n";
}

std::string svgLine(double x1, double y1, double x2, double y2, const char* stroke) {
  return "<line x1='" + svgNumber(x1) + "' y1='" + svgNumber(y1) + "' x2='" + svgNumber(x2) +
         "' y2='" + svgNumber(y2) + "' stroke='" + stroke + "'/>\n";
}

std::string svgPage(double width, double height) {
  return "<svg xmlns='http://www.w3.org/2000/svg' width='" + svgNumber(width) + "' height='" +
         svgNumber(height) + "' viewBox='0 0 " + svgNumber(width) + " " + svgNumber(height) +
         "' font-family='sans-serif' font-size='14'>\n"
         "<rect width='100%' height='100%' fill='#fff'/>\n";
}

std::string svgAxes(const Frame& frame, const Axis& x, const Axis& y, const std::string& x_label,
                    const std::string& y_label) {
  std::string out;
  for (int e = x.first; e <= x.last; ++e) {
    const double at = x.at(std::pow(10.0, e));
    out += svgLine(at, frame.top, at, frame.bottom, "#bbb");
    out += "<text x='" + svgNumber(at) + "' y='" + svgNumber(frame.bottom + 22.0) +
           "' text-anchor='middle'>" + decade(e) + "</text>\n";
    for (int k = 2; k < 10 && e < x.last; ++k) {
      const double between = x.at(k * std::pow(10.0, e));
      out += svgLine(between, frame.top, between, frame.bottom, "#eee");
    }
  }
  const int stride = y.last - y.first > 10 ? 2 : 1;
  for (int e = y.first; e <= y.last; ++e) {
    const double at = y.at(std::pow(10.0, e));
    out += svgLine(frame.left, at, frame.right, at, "#ddd");
    if ((e - y.first) % stride == 0) {
      out += "<text x='" + svgNumber(frame.left - 8.0) + "' y='" + svgNumber(at + 5.0) +
             "' text-anchor='end'>" + decade(e) + "</text>\n";
    }
  }
  out += svgText(0.5 * (frame.left + frame.right), frame.bottom + 52.0, "text-anchor='middle'",
                 x_label);
  const double label = frame.left - 62.0;
  const double middle = 0.5 * (frame.top + frame.bottom);
  return out + svgText(label, middle,
                       "text-anchor='middle' transform='rotate(-90 " + svgNumber(label) + " " +
                           svgNumber(middle) + ")'",
                       y_label);
}

}  // namespace palpate::tools
