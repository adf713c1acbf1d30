#include "reach.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <unordered_set>

namespace palpate {
namespace {

constexpr std::size_t kMaxStates = 60'000;

/// A region, and by slot how often its port was passed inward minus outward.
struct State {
  RegionId region = kOutside;
  std::vector<std::int16_t> net = {};
};

std::string keyOf(const State& state) {
  std::string key(reinterpret_cast<const char*>(&state.region), sizeof state.region);
  key.append(reinterpret_cast<const char*>(state.net.data()),
             state.net.size() * sizeof(std::int16_t));
  return key;
}

/// The result of a search.
struct Found {
  std::vector<bool> regions;
  std::vector<bool> ports;
  bool is_complete = true;  ///< no state was left out of the search
};

class Search {
 public:
  explicit Search(const ReachTable& table)
      : table_(table), slot_of_(table.after.size(), -1), leaving_(table.regions) {
    for (const std::vector<PassedBefore>& befores : table.after) {
      for (const PassedBefore& before : befores) {
        int& slot = slot_of_[before.port];
        if (slot < 0) {
          slot = static_cast<int>(most_.size());
          most_.push_back(0);
          turns_.push_back({});
        }
        int& most = most_[static_cast<std::size_t>(slot)];
        most = std::max(most, before.times);
      }
    }
    for (const ReachWay& way : table.ways) {
      leaving_[way.from].push_back(&way);
      if (way.port < 0) continue;
      const int slot = slot_of_[static_cast<std::size_t>(way.port)];
      if (slot >= 0) turns_[static_cast<std::size_t>(slot)].push_back(way);
    }
  }

  /// Ignores the memory: a port that was passable once counts as passed as often as needed.
  [[nodiscard]] Found fixpoint(bool with_doubtful) const {
    Found found = nothing();
    found.regions[table_.start] = true;
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (const ReachWay& way : table_.ways) {
        if (!found.regions[way.from] || (way.is_doubtful && !with_doubtful)) continue;
        if (way.port >= 0) {
          const auto port = static_cast<std::size_t>(way.port);
          const auto& after = table_.after[port];
          if (!std::all_of(after.begin(), after.end(),
                           [&](const PassedBefore& before) { return found.ports[before.port]; })) {
            continue;
          }
          is_changed |= !found.ports[port];
          found.ports[port] = true;
        }
        is_changed |= !found.regions[way.to];
        found.regions[way.to] = true;
      }
    }
    return found;
  }

  /// Searches state by state. With `saturated` a count stops at the largest number that is asked
  /// for, and if one passing is taken back from there, the count may or may not go below: the
  /// result is an upper bound. Otherwise counts are exact, and states with too large counts are
  /// dropped: the result is a lower bound.
  [[nodiscard]] Found states(bool with_doubtful, bool saturated) const {
    Found found = nothing();
    std::unordered_set<std::string> seen;
    std::vector<State> next;
    const auto add = [&](State state) {
      if (table_.keeps_memory) settle(state, with_doubtful, found);
      if (!seen.insert(keyOf(state)).second) return;
      found.regions[state.region] = true;
      next.push_back(std::move(state));
    };
    add({table_.start, std::vector<std::int16_t>(most_.size(), 0)});
    for (std::size_t i = 0; i < next.size(); ++i) {  // fewest transitions first
      if (seen.size() > kMaxStates) {
        found.is_complete = false;
        return found;
      }
      const State state = next[i];
      for (const ReachWay* way : leaving_[state.region]) {
        if (!isOpen(*way, state, with_doubtful)) continue;
        if (way->port >= 0) found.ports[static_cast<std::size_t>(way->port)] = true;
        for (State& after : taken(*way, state, saturated, found)) add(std::move(after));
      }
    }
    return found;
  }

  [[nodiscard]] bool hasMemory() const { return !most_.empty(); }

 private:
  [[nodiscard]] Found nothing() const {
    return {std::vector<bool>(table_.regions, false), std::vector<bool>(table_.after.size(), false),
            true};
  }

  [[nodiscard]] bool isOpen(const ReachWay& way, const State& state, bool with_doubtful) const {
    if (way.from != state.region || (way.is_doubtful && !with_doubtful)) return false;
    if (way.port < 0) return true;
    const auto& after = table_.after[static_cast<std::size_t>(way.port)];
    return std::all_of(after.begin(), after.end(), [&](const PassedBefore& before) {
      const auto slot = static_cast<std::size_t>(slot_of_[before.port]);
      return std::abs(static_cast<int>(state.net[slot])) >= before.times;
    });
  }

  /// [times] Larger exact counts are not followed.
  [[nodiscard]] int limitOf(std::size_t slot) const {
    return std::min(2 * most_[slot] + 2,
                    static_cast<int>(std::numeric_limits<std::int16_t>::max()));
  }

  /// The state, or states, that `way` leads to.
  [[nodiscard]] std::vector<State> taken(const ReachWay& way, const State& state, bool saturated,
                                         Found& found) const {
    State after = state;
    after.region = way.to;
    if (!table_.keeps_memory && way.to == kOutside && way.from != kOutside) {
      std::fill(after.net.begin(), after.net.end(), std::int16_t{0});
      return {after};
    }
    if (way.port < 0) {
      if (table_.keeps_memory) return {after};
      std::vector<State> all{after};
      for (std::size_t slot = 0; slot < most_.size(); ++slot) {
        for (const ReachWay& turn : turns_[slot]) {
          if (turn.from != way.to || turn.to != way.from) continue;
          takeBack(all, slot, turn.inward, saturated);
          break;
        }
      }
      return all;
    }
    const int slot = slot_of_[static_cast<std::size_t>(way.port)];
    if (slot < 0) return {after};
    const auto s = static_cast<std::size_t>(slot);
    const int step = way.inward || table_.keeps_memory ? 1 : -1;
    if (after.net[s] * step < 0) {
      std::vector<State> all{after};
      takeBack(all, s, !way.inward, saturated);
      return all;
    }
    const int net = after.net[s] + step;
    if (saturated || table_.keeps_memory) {
      after.net[s] = static_cast<std::int16_t>(std::clamp(net, -most_[s], most_[s]));
    } else if (std::abs(net) > limitOf(s)) {
      found.is_complete = false;
      return {};
    } else {
      after.net[s] = static_cast<std::int16_t>(net);
    }
    return {after};
  }

  void takeBack(std::vector<State>& all, std::size_t slot, bool inward, bool saturated) const {
    const int step = inward ? 1 : -1;
    const std::size_t count = all.size();
    for (std::size_t i = 0; i < count; ++i) {
      const int net = all[i].net[slot];
      if (net * step <= 0) continue;
      // The saturated count means "this often or more": after taking one back it may still be that.
      if (saturated && std::abs(net) == most_[slot]) all.push_back(all[i]);
      all[i].net[slot] = static_cast<std::int16_t>(net - step);
    }
  }

  /// For `memory: keep`: passes every port that lies on a way there and back, until no new port is
  /// passed. All states that differ only by such round trips become one.
  void settle(State& state, bool with_doubtful, Found& found) const {
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      const std::vector<bool> there = spread(state, with_doubtful, true);
      const std::vector<bool> back = spread(state, with_doubtful, false);
      for (const ReachWay& way : table_.ways) {
        if (way.port < 0 || !(there[way.from] && back[way.from] && there[way.to] && back[way.to])) {
          continue;
        }
        if (!isOpen(way, {way.from, state.net}, with_doubtful)) continue;
        found.ports[static_cast<std::size_t>(way.port)] = true;
        const int slot = slot_of_[static_cast<std::size_t>(way.port)];
        if (slot < 0) continue;
        const auto s = static_cast<std::size_t>(slot);
        is_changed |= state.net[s] != most_[s];
        state.net[s] = static_cast<std::int16_t>(most_[s]);
      }
    }
  }

  /// The regions that can be reached from the state's region by ways that are open now (`forth`),
  /// or from which that region can be reached (otherwise).
  [[nodiscard]] std::vector<bool> spread(const State& state, bool with_doubtful, bool forth) const {
    std::vector<bool> met(table_.regions, false);
    met[state.region] = true;
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (const ReachWay& way : table_.ways) {
        const RegionId a = forth ? way.from : way.to;
        const RegionId b = forth ? way.to : way.from;
        if (!met[a] || met[b] || !isOpen(way, {way.from, state.net}, with_doubtful)) continue;
        met[b] = is_changed = true;
      }
    }
    return met;
  }

  const ReachTable& table_;
  std::vector<int> slot_of_;  ///< by port; -1: no `after` names it
  std::vector<int> most_;     ///< [times] by slot: the largest number that is asked for
  std::vector<std::vector<ReachWay>> turns_;           ///< by slot: the ways through its port
  std::vector<std::vector<const ReachWay*>> leaving_;  ///< by region
};

}  // namespace

Reached reach(const ReachTable& table) {
  const Search search(table);
  // If even the least strict rules do not reach a place, nothing does.
  const Found possible = search.fixpoint(true);
  Found most = possible;
  Found certain;
  if (!search.hasMemory()) {
    certain = search.fixpoint(false);
  } else {
    certain = search.states(false, false);
    const Found exact = search.states(true, false);
    if (exact.is_complete) {
      most = exact;
    } else {
      const Found saturated = search.states(true, true);
      if (saturated.is_complete) most = saturated;
    }
  }
  const auto answer = [](bool is_certain, bool is_possible) {
    return is_certain ? Reach::kYes : is_possible ? Reach::kUndecided : Reach::kNo;
  };
  Reached out;
  for (std::size_t i = 0; i < table.regions; ++i) {
    out.regions.push_back(answer(certain.regions[i], most.regions[i]));
  }
  for (std::size_t i = 0; i < table.after.size(); ++i) {
    out.ports.push_back(answer(certain.ports[i], most.ports[i]));
  }
  return out;
}

}  // namespace palpate
