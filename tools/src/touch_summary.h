#pragma once
/// Summary of a touch: regions in order, ports passed, forces, and durations of ticks.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/devices/record.h"
#include "report.h"
#include "text.h"
#include "tick_times.h"
#include "unsettled.h"

namespace palpate::tools {

/// A stay of the proxy in one region. Depths are those of walls and of the proxy, never of the
/// hand.
struct Visit {
  RegionId region = kOutside;
  double t = 0.0;        ///< [s] of entering
  double seconds = 0.0;  ///< [s] to the end of the stay
  int port = -1;         ///< port by which it was entered; -1: none
  double rupture =
      0.0;  ///< [N] elastic normal force at which the wall into it opened; 0: it was open
  double entry_depth = 0.0;  ///< [m] depth of the wall by which it was entered, straight from where
                             ///< the first wall was met
  double depth = 0.0;  ///< [m] largest depth of the proxy, or of the wall by which it was left
  /// [N] on the hand. If the tip crossed the whole region within one tick: the force at which its
  /// far wall opened, plus the cutting force of its content.
  double peak_force = 0.0;
  std::uint64_t ticks = 0;  ///< that ended in it
};

/// One passage through a port.
struct PassedPort {
  double t = 0.0;  ///< [s]
  PortId port = 0;
};

struct TouchSummary {
  static constexpr std::size_t kMostListed = 100000;

  std::uint64_t ticks = 0;
  double seconds = 0.0;  ///< [s] of hand time
  std::uint64_t contact_ticks = 0;
  /// Ticks that ended before the proxy was at rest; unset for the paper's renderer, which does not
  /// report it.
  std::optional<UnsettledMeter> unsettled;
  bool met_something = false;    ///< a wall, a port, another region or a force
  double peak_force = 0.0;       ///< [N]
  Vec3 peak_force_at{0.0};       ///< [m] proxy
  bool is_peak_at_wall = false;  ///< otherwise it is that of contents, with no wall pressed
  double work = 0.0;             ///< [J] on the hand, each force held until the next tick
  double source_work =
      0.0;  ///< [J] HapticRenderer::sourceWork(), filled in by the caller, which has the renderer
  /// The first kMostListed of each, and how many came later.
  std::vector<Visit> visits;
  std::vector<PassedPort> ports;
  std::uint64_t more_visits = 0;
  std::uint64_t more_ports = 0;
  double tick_median = 0.0, tick_p99 = 0.0, tick_p999 = 0.0, tick_max = 0.0;  ///< [ns]
};

/// Sums up ticks as they arrive, in constant memory. With the first tick in another scene
/// (SessionTick::scene) it starts over.
class TouchMeter final : public devices::RecordSink {
 public:
  explicit TouchMeter(RendererKind kind);
  void add(const devices::RecordedTick& recorded, std::span<const RegionEntry> entries) override;
  /// The summary of all ticks so far.
  [[nodiscard]] TouchSummary summary() const;

 private:
  /// Follows the proxy from region to region.
  void visit(double t, const TickResult& result, std::span<const RegionEntry> entries);
  void begin(double t, RegionId region, double depth = 0.0);
  void pass(double t, const RegionEntry& entry);
  [[nodiscard]] double depthOf(const Vec3& p) const;

  RendererKind kind_;
  std::uint64_t scene_ = 0;  ///< SessionTick::scene
  TouchSummary summary_;
  Visit visit_;  ///< the present one
  bool has_visit_ = false;
  std::optional<Vec3> first_wall_;
  TickTimes times_;
  double begin_ = 0.0;  ///< [s]
  Vec3 last_hip_{0.0};
  Vec3 last_force_{0.0};
};

[[nodiscard]] Json summaryJson(const TouchSummary& summary, const Scene& scene);
[[nodiscard]] std::string summaryText(const TouchSummary& summary, const Scene& scene);

}  // namespace palpate::tools
