#pragma once
/// A linear axis of a plot with round numbers at even steps, and the plot's grid, as SVG.

#include <string>

#include "bench/svg.h"

namespace palpate::tools {

/// Maps values from `least` to `most`, widened to whole steps, to an interval of the page.
struct EvenScale {
  double least = 0.0;
  double most = 1.0;
  double from = 0.0;
  double to = 1.0;
  double step = 1.0;

  /// With about `steps` steps.
  EvenScale(double lowest, double highest, double begin, double end, double steps = 8.0);
  [[nodiscard]] double at(double value) const {
    return from + (to - from) * (value - least) / (most - least);
  }
  [[nodiscard]] int count() const;           ///< number of steps
  [[nodiscard]] double number(int i) const;  ///< value at the end of the i-th step
};

/// Grid lines with their numbers and titles.
[[nodiscard]] std::string evenAxes(const Frame& frame, const EvenScale& x, const EvenScale& y,
                                   const std::string& x_label, const std::string& y_label);

}  // namespace palpate::tools
