#include "even_scale.h"

#include <cmath>

#include "text.h"

namespace palpate::tools {

EvenScale::EvenScale(double lowest, double highest, double begin, double end, double steps)
    : from(begin), to(end) {
  if (!(highest > lowest)) highest = lowest + 1.0;
  const double rough = (highest - lowest) / steps;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  step = decade;
  for (const double round : {2.0, 5.0, 10.0}) {
    if (step < rough) step = round * decade;
  }
  least = step * std::floor(lowest / step);
  most = step * std::ceil(highest / step);
}

int EvenScale::count() const { return static_cast<int>(std::lround((most - least) / step)); }

double EvenScale::number(int i) const {
  const double value = least + i * step;
  return std::fabs(value) < 1e-9 * step ? 0.0 : value;
}

std::string evenAxes(const Frame& frame, const EvenScale& x, const EvenScale& y,
                     const std::string& x_label, const std::string& y_label) {
  std::string out;
  for (int i = 0; i <= x.count(); ++i) {
    const double at = x.at(x.number(i));
    out += svgLine(at, frame.top, at, frame.bottom, "#ddd");
    out += svgText(at, frame.bottom + 22.0, "text-anchor='middle'", formatNumber(x.number(i), 4));
  }
  for (int i = 0; i <= y.count(); ++i) {
    const double at = y.at(y.number(i));
    out += svgLine(frame.left, at, frame.right, at, y.number(i) == 0.0 ? "#888" : "#ddd");
    out += svgText(frame.left - 8.0, at + 5.0, "text-anchor='end'", formatNumber(y.number(i), 4));
  }
  out += svgText(0.5 * (frame.left + frame.right), frame.bottom + 52.0, "text-anchor='middle'",
                 x_label);
  const double middle = 0.5 * (frame.top + frame.bottom);
  return out + svgText(28.0, middle,
                       "text-anchor='middle' transform='rotate(-90 28 " + svgNumber(middle) + ")'",
                       y_label);
}

}  // namespace palpate::tools
