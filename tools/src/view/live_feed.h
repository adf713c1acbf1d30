#pragma once
/// LiveFeed: the data of a running session that a page may see.

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "palpate/devices/record.h"
#include "view/seen_marks.h"

namespace palpate::tools {

/// A region that the proxy entered.
struct SeenEntry {
  std::uint64_t number = 0;  ///< from 1, among all entries of the session
  std::uint64_t tick = 0;
  RegionId from = kOutside;
  RegionId to = kOutside;
  int port = -1;       ///< -1: an absent wall
  double force = 0.0;  ///< [N] at which the wall opened
};

/// For each port, how many more times it was passed in one direction than in the other.
class PassedCounts {
 public:
  explicit PassedCounts(const Scene& scene)
      : counts_(scene.ports().size(), 0), keeps_(scene.keepsMemory()) {}
  /// Takes the counts of `before`, made in `from`, for the ports of `to` with the same names.
  PassedCounts(const PassedCounts& before, const Scene& from, const Scene& to) : PassedCounts(to) {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      for (std::size_t k = 0; k < before.counts_.size(); ++k) {
        if (from.ports()[k].name == to.ports()[i].name) counts_[i] = before.counts_[k];
      }
    }
  }

  void add(const RegionEntry& entry) {
    const auto port = static_cast<std::size_t>(entry.port);
    if (entry.port >= 0 && port < counts_.size()) counts_[port] += entry.from < entry.to ? 1 : -1;
    if (entry.to == kOutside && !keeps_) counts_.assign(counts_.size(), 0);
  }
  [[nodiscard]] const std::vector<int>& counts() const noexcept { return counts_; }

 private:
  std::vector<int> counts_;
  bool keeps_;
};

/// The last tick, and the events since the session began.
struct FeedView {
  std::uint64_t ticks = 0;  ///< so far; if 0, the other members mean nothing
  std::uint64_t scene =
      0;  ///< SessionTick::scene, to which the numbers of regions and ports belong
  std::uint64_t number = 0;
  double time = 0.0;  ///< [s]
  Vec3 hip{0.0, 0.0, 0.0};
  TickResult result;
  std::int64_t ns = 0;             ///< [ns] longest tick of the renderer among the last ones
  std::int64_t worst_ns = 0;       ///< [ns] longest so far
  std::uint64_t late = 0;          ///< ticks that ended after the next one was due
  double strongest = 0.0;          ///< [N] largest force among the last ticks
  double work = 0.0;               ///< [J] work of the force on the hand so far
  std::vector<int> passed;         ///< by PortId, see PassedCounts
  std::vector<SeenHole> holes;     ///< SeenMarks::holes()
  std::optional<Vec3> fulcrum;     ///< [m] SeenMarks::fulcrum()
  std::vector<SeenEntry> entries;  ///< entries after the requested number, as far as they are kept
};

/// Written by the recorder's thread and read by the server's: the servo thread never waits for its
/// lock.
class LiveFeed final : public devices::RecordSink {
 public:
  static constexpr std::size_t kKept = 512;  ///< entries
  static constexpr std::size_t kLast = 128;  ///< ticks over which look() takes the largest values

  explicit LiveFeed(ScenePtr scene) : scene_(std::move(scene)), passed_(*scene_), marks_(*scene_) {}

  /// Announces the scene with this number; to be called before its first tick.
  void expect(std::uint64_t number, ScenePtr scene) {
    const std::lock_guard lock(mutex_);
    coming_[number] = std::move(scene);
  }
  /// The scene of the last tick.
  [[nodiscard]] ScenePtr scene() const {
    const std::lock_guard lock(mutex_);
    return scene_;
  }

  void add(const devices::RecordedTick& tick, std::span<const RegionEntry> entries) override {
    const std::lock_guard lock(mutex_);
    const devices::SessionTick& now = tick.tick;
    if (now.scene != view_.scene) goTo(now);
    const Vec3& hip = now.hip.position;
    if (isFinite(hip)) {
      // The force of a tick is held until the next one.
      if (view_.ticks > 0) view_.work += glm::dot(view_.result.force, hip - view_.hip);
      view_.hip = hip;
    }
    ++view_.ticks;
    view_.number = now.number;
    view_.time = now.reading.time;
    view_.result = now.result;
    last_[view_.ticks % kLast] = {now.renderer_ns, glm::length(now.result.force)};
    view_.worst_ns = std::max(view_.worst_ns, now.renderer_ns);
    if (tick.turn.is_late) ++view_.late;
    for (const RegionEntry& entry : entries) {
      passed_.add(entry);
      marks_.add(entry);
      entries_.push_back(
          {++entry_count_, now.number, entry.from, entry.to, entry.port, entry.force});
      if (entries_.size() > kKept) entries_.pop_front();
    }
  }

  /// The present view, with the entries after number `seen`.
  [[nodiscard]] FeedView look(std::uint64_t seen) const {
    const std::lock_guard lock(mutex_);
    FeedView out = view_;
    for (const LastTick& tick : last_) {
      out.ns = std::max(out.ns, tick.ns);
      out.strongest = std::max(out.strongest, tick.force);
    }
    out.passed = passed_.counts();
    out.holes = marks_.holes();
    out.fulcrum = marks_.fulcrum();
    for (const SeenEntry& entry : entries_) {
      if (entry.number > seen) out.entries.push_back(entry);
    }
    return out;
  }

 private:
  struct LastTick {
    std::int64_t ns = 0;
    double force = 0.0;  ///< [N]
  };

  void goTo(const devices::SessionTick& tick) {
    view_.scene = tick.scene;
    const auto at = coming_.find(tick.scene);
    if (at == coming_.end()) return;
    const ScenePtr to = at->second;
    passed_ = tick.begins_anew ? PassedCounts(*to) : PassedCounts(passed_, *scene_, *to);
    marks_ = tick.begins_anew ? SeenMarks(*to) : SeenMarks(marks_, *scene_, *to);
    scene_ = to;
    // The entries have the numbers that regions and ports had in the scene before.
    entries_.clear();
    coming_.erase(coming_.begin(), std::next(at));
  }

  mutable std::mutex mutex_;
  FeedView view_;
  ScenePtr scene_;
  std::map<std::uint64_t, ScenePtr> coming_;  ///< announced scenes, by number
  std::array<LastTick, kLast> last_{};        ///< a ring: the newest tick replaces the oldest
  PassedCounts passed_;
  SeenMarks marks_;
  std::deque<SeenEntry> entries_;
  std::uint64_t entry_count_ = 0;
};

}  // namespace palpate::tools
