#pragma once
/// The table of transitions as a graph: states are nodes, ports and absent walls arrows.

#include <span>
#include <string>
#include <vector>

namespace palpate::tools {

struct GraphState {
  std::string name;
  std::string note = {};  ///< a second line: the content, or why the state cannot be reached
  bool is_start = false;
  bool is_reachable = true;
};

struct GraphArrow {
  std::size_t from = 0;
  std::size_t to = 0;
  std::vector<std::string> label;  ///< lines: the port, then its conditions
  bool is_wall_absent = false;
};

/// An SVG page. The column of a state is the least number of arrows from the start to it; states
/// that cannot be reached come last.
[[nodiscard]] std::string transitionSvg(const std::string& title,
                                        std::span<const GraphState> states,
                                        std::span<const GraphArrow> arrows);

}  // namespace palpate::tools
