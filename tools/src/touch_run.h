#pragma once
/// Runs a touch: the session, and everything that uses its ticks, in constant memory however long
/// it takes.

#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "output_files.h"
#include "palpate/devices/record.h"
#include "palpate/devices/session.h"
#include "palpate/render/trace.h"
#include "record_about.h"
#include "touch_summary.h"

namespace palpate::tools {

struct TouchRun {
  TouchSummary summary;
  devices::ServoReport servo;
  std::optional<Trace> thin;  ///< for pictures
};

/// Announces --trace and --record. @throws Error as OutputFiles::announce(); kUsage for a record's
/// name.
void announceRecords(OutputFiles& files, const TouchOptions& options,
                     const std::vector<std::string>& inputs);

/// Runs `session` until the device or a stop ends it. The record has its final name even before the
/// first tick; the trace goes to the file that `files` says. `wants_thin`: keep rows for pictures.
/// `more` gets the ticks as well.
/// @throws Error: kOperation if a file could not be written, once the session is over; kCancelled
/// after a stop; kDevice if the device failed. The ticks until then are kept in each case: the
/// trace then gets its final name too.
[[nodiscard]] TouchRun runTouch(devices::Session& session, devices::Device& device,
                                const TouchOptions& options, const RecordAbout& about,
                                OutputFiles& files, Console& console, bool wants_thin,
                                const std::vector<devices::RecordSink*>& more = {});

}  // namespace palpate::tools
