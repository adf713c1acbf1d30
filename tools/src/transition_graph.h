#pragma once
/// The table of transitions as a graph: states are nodes, ports and absent walls arrows.

#include <span>
#include <string>
#include <vector>

namespace palpate::tools {

struct GraphState {
  std::string name;
  std::string note = {};  ///< a second line: content, or why it cannot be reached
  bool is_start = false;
  bool is_reachable = true;
};

struct GraphArrow {
  std::size_t from = 0;
  std::size_t to = 0;
  std::vector<std::string> label;  ///< lines: the port, then its conditions
  bool is_wall_absent = false;
};

/// An SVG page. States stand in columns by how many arrows lie between the start and them; those
/// that no way leads to stand last.
[[nodiscard]] std::string transitionSvg(const std::string& title,
                                        std::span<const GraphState> states,
                                        std::span<const GraphArrow> arrows);

}  // namespace palpate::tools
