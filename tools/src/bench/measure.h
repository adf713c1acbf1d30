#pragma once
/// Measures one renderer on one case: how long a tick takes, how far its force is off, and how
/// often it does not settle.

#include <optional>
#include <string>

#include "bench/contact_case.h"
#include "bench/spread.h"
#include "cache_flood.h"
#include "unsettled.h"

namespace palpate::tools {

struct MeasureSettings {
  int repeats = 10;  ///< hot runs of the whole path
  /// Ticks timed at the pace of the path, with the loop waiting in between; 0: none
  int paced_ticks = 2000;
  int cold_ticks = 30;  ///< ticks timed after other data went through the caches; 0: none
};

/// [ns] Statistics over the ticks, including the clock's own time.
struct HotTimes {
  double median = 0.0, p99 = 0.0, p999 = 0.0, most = 0.0;
};

/// [ns] Statistics of single ticks, each timed once.
struct OnceTimes {
  std::size_t ticks = 0;
  double median = 0.0, p999 = 0.0;
};

/// Comparison with the truth, where it is known.
struct Judgement {
  std::size_t ticks = 0;            ///< compared with the truth
  std::size_t missed = 0;           ///< of these, ticks in which only one of the two has a force
  std::optional<Spread> direction;  ///< [degrees] between force and true force, where both exist
  std::optional<Spread> magnitude;  ///< [-] of the force, as a share of the true one
  std::optional<Spread> error;      ///< [-] |force - true force| / |true force|
};

struct Measurement {
  std::size_t ticks = 0;  ///< number of ticks timed hot
  /// Runs follow one another without waiting. Each tick counts with its shortest time of all runs,
  /// which leaves out disturbances by other work.
  HotTimes hot;
  std::optional<OnceTimes> paced = {};
  std::optional<OnceTimes> cold = {};
  std::optional<Judgement> judgement = {};  ///< not given: no judge for this case
  /// Not given: the paper's renderer does not report it
  std::optional<UnsettledMeter> unsettled = {};
  double step = 0.0;  ///< [N] largest change of the force from tick to tick
  double turn = 0.0;  ///< [degrees] largest turn of the force from tick to tick
  /// `step` and `turn` of the true force, if the truth is known at every tick.
  std::optional<double> true_step = {}, true_turn = {};
};

/// Calls `flood` before cold ticks, if there are any. Returns nothing if the renderer cannot run
/// the case; `why` then gives the reason.
[[nodiscard]] std::optional<Measurement> measure(const ContactCase& what, RendererKind kind,
                                                 const MeasureSettings& settings, CacheFlood* flood,
                                                 const Progress& progress, std::string& why);

}  // namespace palpate::tools
