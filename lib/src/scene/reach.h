#pragma once
/// Finds which regions a probe can ever enter, and which ports it can ever pass, by a search over
/// the table of states and transitions. A state is a region and how often each port was passed.

#include <utility>
#include <vector>

#include "palpate/interior/port.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// A way from one region to another, or through a port of a sheet back to the same region.
struct ReachWay {
  RegionId from = kOutside;
  RegionId to = kOutside;
  int port = -1;        ///< -1: there is no wall
  bool inward = false;  ///< as PassedPorts counts
  /// It is not certain that this way exists.
  bool is_doubtful = false;
};

struct ReachTable {
  std::size_t regions = 0;
  RegionId start = kOutside;
  bool keeps_memory = false;
  std::vector<ReachWay> ways = {};
  std::vector<std::vector<PassedBefore>> after = {};  ///< by port
};

struct Reached {
  std::vector<Reach> regions;
  std::vector<Reach> ports;
};

/// kYes only if there is a sequence of transitions that leads there; kNo only if there is none of
/// any length; kUndecided if neither could be shown, because there are more states than are
/// searched, or because a doubtful way is needed.
[[nodiscard]] Reached reach(const ReachTable& table);

}  // namespace palpate
