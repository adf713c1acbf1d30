#pragma once
/// One renderer on one case: how long a tick takes, and how far off its force is.

#include <optional>
#include <string>

#include "bench/contact_case.h"
#include "bench/spread.h"

namespace palpate::tools {

struct Measurement {
  std::size_t ticks = 0;   ///< timed
  std::size_t judged = 0;  ///< of these, compared with the truth
  /// [ns] over the ticks; of each the shortest time of all repetitions, so that what else the
  /// machine did is left out. With the clock's own time.
  double median = 0.0, p99 = 0.0, p999 = 0.0, most = 0.0;
  Spread direction;        ///< [degrees] between force and true force, where both are there
  Spread magnitude;        ///< [-] of the force, as a share of the true one
  Spread error;            ///< [-] |force - true force| / |true force|
  std::size_t missed = 0;  ///< judged ticks where one of the two has a force and the other none
  double step = 0.0;       ///< [N] largest change of the force from tick to tick
  double turn = 0.0;       ///< [degrees] largest turn of the force from tick to tick
  /// Of the true force, where every tick has one.
  std::optional<double> true_step = {}, true_turn = {};
};

/// Runs the whole path `repeats` times. Nothing if the renderer cannot do the case, and then `why`.
[[nodiscard]] std::optional<Measurement> measure(const ContactCase& what, RendererKind kind,
                                                 int repeats, const Progress& progress,
                                                 std::string& why);

}  // namespace palpate::tools
