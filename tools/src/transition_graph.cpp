#include "transition_graph.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "bench/svg.h"

namespace palpate::tools {
namespace {

constexpr double kNodeWidth = 150.0;
constexpr double kNodeHeight = 46.0;
constexpr double kColumn = 460.0;  ///< distance between the middles of two columns
constexpr double kRow = 240.0;
constexpr double kMargin = 60.0;
constexpr double kHead = 70.0;  ///< height of the title at the top of the page
constexpr double kLine = 14.0;  ///< height of a line of a label
constexpr double kBend = 44.0;  ///< distance between arrows that join the same two states
constexpr const char* kPort = "#0a8a66";
constexpr const char* kFree = "#777777";

struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// Least number of arrows from the start to each state; one more than the largest of these numbers
/// for states that cannot be reached.
std::vector<std::size_t> columnsOf(std::span<const GraphState> states,
                                   std::span<const GraphArrow> arrows) {
  const std::size_t unknown = states.size();
  std::vector<std::size_t> columns(states.size(), unknown);
  std::deque<std::size_t> next;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i].is_start) continue;
    columns[i] = 0;
    next.push_back(i);
  }
  std::size_t last = 0;
  while (!next.empty()) {
    const std::size_t state = next.front();
    next.pop_front();
    last = columns[state];
    for (const GraphArrow& arrow : arrows) {
      if (arrow.from != state || columns[arrow.to] != unknown || !states[arrow.to].is_reachable) {
        continue;
      }
      columns[arrow.to] = columns[state] + 1;
      next.push_back(arrow.to);
    }
  }
  for (std::size_t& column : columns) {
    if (column == unknown) column = last + 1;
  }
  return columns;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 24;
  return text.size() <= kMost ? text : text.substr(0, kMost - 3) + "...";
}

std::string nodeSvg(const GraphState& state, const Spot& at) {
  const char* stroke = state.is_reachable ? "#222222" : "#b03030";
  std::string svg = "<rect x='" + svgNumber(at.x - 0.5 * kNodeWidth) + "' y='" +
                    svgNumber(at.y - 0.5 * kNodeHeight) + "' width='" + svgNumber(kNodeWidth) +
                    "' height='" + svgNumber(kNodeHeight) + "' rx='10' fill='" +
                    (state.is_start ? "#e8f0fa" : "#ffffff") + "' stroke='" + stroke +
                    "' stroke-width='" + (state.is_start ? "2.5" : "1.5") + "'" +
                    (state.is_reachable ? "" : " stroke-dasharray='5 4'") + "/>\n";
  const bool has_note = !state.note.empty();
  svg += svgText(at.x, at.y + (has_note ? -2.0 : 5.0),
                 "text-anchor='middle' font-size='14' fill='#222'", shortened(state.name));
  if (has_note) {
    svg += svgText(at.x, at.y + 14.0, "text-anchor='middle' font-size='10' fill='#666'",
                   shortened(state.note));
  }
  return svg;
}

/// The point where the straight line from `from` to `to` leaves the node at `from`.
Spot borderOf(const Spot& from, const Spot& to) {
  const double x = to.x - from.x;
  const double y = to.y - from.y;
  const double share = std::max(
      {std::fabs(x) / (0.5 * kNodeWidth + 3.0), std::fabs(y) / (0.5 * kNodeHeight + 3.0), 1e-9});
  return {from.x + x / share, from.y + y / share};
}

/// A curved arrow, with its label at `label_at` (0: its beginning, 1: its end); `bend` is how far
/// its middle lies to the left of the straight line.
struct ArrowSvg {
  std::string line;
  std::string label;
};
ArrowSvg arrowSvg(const GraphArrow& arrow, const Spot& from, const Spot& to, double bend,
                  double label_at) {
  const double length = std::max(std::hypot(to.x - from.x, to.y - from.y), 1.0);
  const Spot left{(to.y - from.y) / length, -(to.x - from.x) / length};
  const Spot control{0.5 * (from.x + to.x) + 2.0 * bend * left.x,
                     0.5 * (from.y + to.y) + 2.0 * bend * left.y};
  const Spot a = borderOf(from, control);
  const Spot b = borderOf(to, control);
  const char* color = arrow.is_wall_absent ? kFree : kPort;
  ArrowSvg svg;
  svg.line = "<path d='M " + svgNumber(a.x) + " " + svgNumber(a.y) + " Q " + svgNumber(control.x) +
             " " + svgNumber(control.y) + " " + svgNumber(b.x) + " " + svgNumber(b.y) +
             "' fill='none' stroke='" + color + "' stroke-width='1.6'" +
             (arrow.is_wall_absent ? " stroke-dasharray='6 4'" : "") + " marker-end='url(#" +
             (arrow.is_wall_absent ? "free" : "port") + ")'/>\n";
  // The label is on the outer side of the curve.
  const double t = label_at;
  const auto along = [t](double first, double pull, double last) {
    return (1.0 - t) * (1.0 - t) * first + 2.0 * t * (1.0 - t) * pull + t * t * last;
  };
  const Spot place{along(a.x, control.x, b.x), along(a.y, control.y, b.y)};
  const bool is_below = bend * left.y > 0.0;
  const auto lines = static_cast<double>(arrow.label.size());
  double y = place.y + (is_below ? kLine : 5.0 - kLine * lines);
  for (std::size_t i = 0; i < arrow.label.size(); ++i, y += kLine) {
    svg.label +=
        svgText(place.x, y,
                std::string("text-anchor='middle' paint-order='stroke' stroke='#ffffff' "
                            "stroke-width='4' fill='") +
                    (i == 0 ? color : "#444") + "' font-size='" + (i == 0 ? "12" : "10") + "'",
                arrow.label[i]);
  }
  return svg;
}

std::string markerSvg(const char* id, const char* color) {
  return std::string("<marker id='") + id +
         "' viewBox='0 0 10 10' refX='9' refY='5' markerWidth='8' markerHeight='8' "
         "orient='auto'><path d='M 0 0 L 10 5 L 0 10 z' fill='" +
         color + "'/></marker>\n";
}

}  // namespace

std::string transitionSvg(const std::string& title, std::span<const GraphState> states,
                          std::span<const GraphArrow> arrows) {
  const std::vector<std::size_t> columns = columnsOf(states, arrows);
  std::map<std::size_t, std::size_t> heights;
  for (const std::size_t column : columns) ++heights[column];
  std::size_t most = 1;
  for (const auto& [column, count] : heights) most = std::max(most, count);
  const std::size_t last = heights.empty() ? 0 : heights.rbegin()->first;
  const double width = 2.0 * kMargin + kNodeWidth + kColumn * static_cast<double>(last);
  const double height = kHead + 2.0 * kMargin + kRow * static_cast<double>(most);

  std::vector<Spot> spots;
  std::map<std::size_t, std::size_t> taken;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto row = static_cast<double>(taken[columns[i]]++);
    const auto own = static_cast<double>(heights[columns[i]]);
    spots.push_back({kMargin + 0.5 * kNodeWidth + kColumn * static_cast<double>(columns[i]),
                     kHead + kMargin + 0.5 * kRow * static_cast<double>(most) +
                         kRow * (row - 0.5 * (own - 1.0))});
  }

  std::string svg = svgPage(std::max(width, 480.0), height);
  svg += "<defs>\n" + markerSvg("port", kPort) + markerSvg("free", kFree) + "</defs>\n";
  svg += svgText(kMargin, 34.0, "font-size='18' font-weight='bold' fill='#222'", title);
  svg +=
      svgText(kMargin, 54.0, "font-size='11' fill='#666'",
              "green: ports; dashed gray: no wall; dashed red: cannot be reached; blue: the start");
  std::map<std::pair<std::size_t, std::size_t>, int> drawn;
  std::string labels;
  for (const GraphArrow& arrow : arrows) {
    // Each arrow bends to its own left, so that the two directions are drawn apart.
    const int before = drawn[{arrow.from, arrow.to}]++;
    const auto apart = columns[arrow.from] > columns[arrow.to]
                           ? columns[arrow.from] - columns[arrow.to]
                           : columns[arrow.to] - columns[arrow.from];
    // Farther out, over the states in between.
    const double over = apart > 1 ? 0.45 * kRow * static_cast<double>(apart - 1) : 0.0;
    const double bend = 0.5 * kBend + over + kBend * before;
    // The label goes nearer to the column with more states, where arrows are farther apart.
    const std::size_t begins = heights[columns[arrow.from]];
    const std::size_t ends = heights[columns[arrow.to]];
    const double label_at = begins == ends ? 0.5 : begins > ends ? 0.38 : 0.62;
    const ArrowSvg drawing = arrowSvg(arrow, spots[arrow.from], spots[arrow.to], bend, label_at);
    svg += drawing.line;
    labels += drawing.label;
  }
  svg += labels;
  for (std::size_t i = 0; i < states.size(); ++i) svg += nodeSvg(states[i], spots[i]);
  return svg + "</svg>\n";
}

}  // namespace palpate::tools
