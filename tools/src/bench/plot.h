#pragma once
/// A scatter plot on two logarithmic axes, as SVG.

#include <string>
#include <vector>

namespace palpate::tools {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
  int number = 0;          ///< written into the mark, and explained in the key
  std::size_t series = 0;  ///< index into Plot::series
};

struct Plot {
  std::string title;
  std::string subtitle;
  std::string x_label;
  std::string y_label;
  double least_y = 1e-16;           ///< smaller values are drawn at this height
  std::vector<std::string> series;  ///< at most two
  std::vector<std::string> key;     ///< meaning of number i + 1
  std::vector<PlotPoint> points;
};

/// 1200 x 800 points. Marks that would cover each other are moved apart, with a line to their true
/// place.
[[nodiscard]] std::string plotSvg(const Plot& plot);

}  // namespace palpate::tools
