#include "touch_run.h"

#include <memory>
#include <vector>

#include "input_kind.h"
#include "palpate/devices/record.h"
#include "palpate/vdb/text.h"
#include "stop_signal.h"
#include "thin_trace.h"
#include "trace_file.h"

namespace palpate::tools {
namespace {

/// Says what the files `kept` hold after `ticks` ticks.
std::string hintOf(const std::string& kept, std::uint64_t ticks) {
  if (kept.empty()) return {};
  if (ticks == 0) return "no tick was felt yet, and none is in " + kept;
  return "the ticks until then are in " + kept;
}

/// The error that ended the run; nothing if the path was followed to its end.
std::optional<Error> errorOf(const devices::ServoReport& servo, const std::string& hint) {
  const auto fault = [&](const char* code, const std::string& message) {
    return Error(ErrorKind::kDevice, {code, message, hint});
  };
  switch (servo.exit) {
    case devices::ServoExit::kEnd:
      return std::nullopt;
    case devices::ServoExit::kStopped:
      return Error(ErrorKind::kCancelled, {"cancelled", "stopped at your request", hint});
    case devices::ServoExit::kTimeout:
      return fault("device.timeout", "the device does not answer any more");
    case devices::ServoExit::kDisconnected:
      return fault("device.disconnected", "the device was disconnected");
    case devices::ServoExit::kFault:
      break;
  }
  return fault("device.fault", std::string(devices::textOf(servo.fault)));
}

/// The error for a file that could not be written further: which file, why, and what it holds.
Error failureOf(const Error& failure) {
  Problem problem = failure.problem();
  problem.message += "; the session went on without it";
  problem.hint = "everything written before is whole and can be read; " + problem.hint;
  return {ErrorKind::kOperation, std::move(problem)};
}

}  // namespace

void announceRecords(OutputFiles& files, const TouchOptions& options,
                     const std::vector<std::string>& inputs) {
  if (!options.trace.empty()) {
    files.announce(options.trace, inputs, OutputFiles::Streams::kYes);
  }
  if (options.record.empty()) return;
  if (!vdb::hasExtension(options.record, ".npy")) {
    throw Error(ErrorKind::kUsage,
                {"usage.touch", "the record " + options.record + " must end in .npy"});
  }
  files.announce(options.record, inputs);
  files.announce(aboutFile(options.record), inputs);
  if (options.states > 0) files.announce(statesFile(options.record), inputs);
}

TouchRun runTouch(devices::Session& session, devices::Device& device, const TouchOptions& options,
                  const RecordAbout& about, OutputFiles& files, Console& console, bool wants_thin,
                  const std::vector<devices::RecordSink*>& more) {
  const bool is_paper = about.renderer == "paper";
  TouchMeter meter(is_paper ? RendererKind::kPaper : RendererKind::kConstraint);
  std::vector<devices::RecordSink*> sinks = {&meter};
  sinks.insert(sinks.end(), more.begin(), more.end());
  ThinTrace thin;
  if (wants_thin) sinks.push_back(&thin);
  std::unique_ptr<TraceFile> trace;
  if (!options.trace.empty()) {
    trace =
        std::make_unique<TraceFile>(files.temporary(options.trace), options.trace, session.scene());
    sinks.push_back(trace.get());
  }
  std::unique_ptr<devices::RowFile> rows;
  std::unique_ptr<devices::StateFile> states;
  if (!options.record.empty()) {
    const std::string& record = options.record;
    const std::string text = aboutText(about);
    rows = std::make_unique<devices::RowFile>(files.temporary(record), record);
    files.write(aboutFile(record), text);
    sinks.push_back(rows.get());
    if (options.states > 0) {
      const std::string name = statesFile(record);
      states = std::make_unique<devices::StateFile>(files.temporary(name), name, text);
      sinks.push_back(states.get());
      files.place(name);
    }
    files.place(aboutFile(record));
    files.place(record);
  }

  TouchRun run;
  // Warns at once, because the session may run for another hour.
  const auto tell = [&console](const Error& failure) {
    console.warn(failure.problem().file + ": " + failure.problem().message +
                 "; the session goes on without it");
  };
  devices::Recorder recorder(sinks, {.waits = !options.realtime, .on_failure = tell});
  run.servo = session.run(device, stopRequested(), recorder);
  const devices::RecorderReport& report = recorder.finish();
  if (report.dropped + report.dropped_states > 0) {
    console.warn("writing was too slow: " + std::to_string(report.dropped) + " ticks and " +
                 std::to_string(report.dropped_states) + " states are not in the record");
  }
  std::string kept = options.record;
  if (!options.trace.empty()) kept += (kept.empty() ? "" : " and ") + options.trace;
  std::optional<Error> error = errorOf(run.servo, hintOf(kept, report.ticks));
  if (!error && !report.failures.empty()) error = failureOf(report.failures.front());
  if (error) {
    files.keep(options.trace);
    throw Error(*error);
  }
  run.summary = meter.summary();
  run.summary.source_work = session.renderer().sourceWork();
  if (wants_thin) run.thin = thin.trace();
  return run;
}

}  // namespace palpate::tools
