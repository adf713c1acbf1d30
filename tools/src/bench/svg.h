#pragma once
/// Parts of a plot on two logarithmic axes, as SVG.

#include <string>

namespace palpate::tools {

/// The rectangle of the page in which something is drawn.
struct Frame {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
};

/// A logarithmic axis of whole decades around the values, mapped to an interval of the page.
struct Axis {
  int first = 0;
  int last = 1;
  double from = 0.0;
  double to = 1.0;

  /// Position of a positive value on the page.
  [[nodiscard]] double at(double value) const noexcept;
};

[[nodiscard]] Axis axisFor(double least, double most, double from, double to);

[[nodiscard]] std::string svgNumber(double value);  ///< with one decimal
[[nodiscard]] std::string svgText(double x, double y, const std::string& attributes,
                                  const std::string& text);
[[nodiscard]] std::string svgLine(double x1, double y1, double x2, double y2, const char* stroke);
/// Begins a white page; close it with "</svg>\n".
[[nodiscard]] std::string svgPage(double width, double height);

/// Grid lines with their numbers and titles.
[[nodiscard]] std::string svgAxes(const Frame& frame, const Axis& x, const Axis& y,
                                  const std::string& x_label, const std::string& y_label);

}  // namespace palpate::tools
