#pragma once
/// One renderer on one case: how long a tick takes, how far off its force is, and how often it does
/// not come to rest.

#include <optional>
#include <string>

#include "bench/contact_case.h"
#include "bench/spread.h"
#include "cache_flood.h"
#include "unsettled.h"

namespace palpate::tools {

struct MeasureSettings {
  int repeats = 10;        ///< hot runs of the whole path
  int paced_ticks = 2000;  ///< timed at the pace of the path, the loop waiting in between; 0: none
  int cold_ticks = 30;     ///< timed after other data went through the caches; 0: none
};

/// [ns] over the ticks, with the clock's own time.
struct HotTimes {
  double median = 0.0, p99 = 0.0, p999 = 0.0, most = 0.0;
};

/// [ns] of single ticks, each timed once.
struct OnceTimes {
  std::size_t ticks = 0;
  double median = 0.0, p999 = 0.0;
};

/// Against the truth, where there is one.
struct Judgement {
  std::size_t ticks = 0;   ///< compared with the truth
  std::size_t missed = 0;  ///< of these, where one of the two has a force and the other none
  std::optional<Spread>
      direction;  ///< [degrees] between force and true force, where both are there
  std::optional<Spread> magnitude;  ///< [-] of the force, as a share of the true one
  std::optional<Spread> error;      ///< [-] |force - true force| / |true force|
};

struct Measurement {
  std::size_t ticks = 0;  ///< timed hot
  /// One after another; of each tick the shortest of all runs, so that what else the machine did is
  /// left out.
  HotTimes hot;
  std::optional<OnceTimes> paced = {};
  std::optional<OnceTimes> cold = {};
  std::optional<Judgement> judgement = {};       ///< not given: nothing judges this case
  std::optional<UnsettledMeter> unsettled = {};  ///< the paper's renderer does not say
  double step = 0.0;  ///< [N] largest change of the force from tick to tick
  double turn = 0.0;  ///< [degrees] largest turn of the force from tick to tick
  /// Of the true force, where every tick has one.
  std::optional<double> true_step = {}, true_turn = {};
};

/// `flood` is asked for if there are cold ticks. Nothing if the renderer cannot do the case, and
/// then `why`.
[[nodiscard]] std::optional<Measurement> measure(const ContactCase& what, RendererKind kind,
                                                 const MeasureSettings& settings, CacheFlood* flood,
                                                 const Progress& progress, std::string& why);

}  // namespace palpate::tools
