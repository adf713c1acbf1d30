#pragma once
/// Which regions a probe can ever get into, and which ports it can ever pass: a search of the table
/// of states and transitions. A state is a region and what of the ports was passed.

#include <utility>
#include <vector>

#include "palpate/interior/port.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// From one region to another, or through a port of a sheet to the same.
struct ReachWay {
  RegionId from = kOutside;
  RegionId to = kOutside;
  int port = -1;        ///< -1: no wall is there
  bool inward = false;  ///< as PassedPorts counts
  /// It is not certain that there is such a way.
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

/// kYes only with a sequence of transitions that leads there; kNo only where none does, whatever
/// its length; kUndecided where neither was found: the states are more than are looked at, or a
/// doubtful way is needed.
[[nodiscard]] Reached reach(const ReachTable& table);

}  // namespace palpate
