#include "run_command.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "cache_folder.h"
#include "command_line.h"
#include "console.h"
#include "output_files.h"
#include "pack/pack_scene.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/image.h"
#include "stop_signal.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

constexpr int kInterrupted = 130;

int exitCode(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return 2;
    case ErrorKind::kInput:
      return 3;
    case ErrorKind::kOperation:
      return 1;
    case ErrorKind::kDevice:
      return 4;
    case ErrorKind::kCancelled:
      return kInterrupted;
  }
  return 1;
}

Json errorJson(const Problem& problem) {
  Json error = {{"code", problem.code}, {"message", problem.message}};
  error["hint"] = problem.hint.empty() ? Json() : Json(problem.hint);
  error["file"] = problem.file.empty() ? Json() : Json(problem.file);
  error["line"] = problem.line > 0 ? Json(problem.line) : Json();
  error["column"] = problem.column > 0 ? Json(problem.column) : Json();
  return {{"schema", "palpate.error/1"}, {"error", std::move(error)}};
}

/// False if stdout did not accept the text.
bool print(const std::string& text) {
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
         std::fflush(stdout) == 0;
}

bool print(const Json& json) {
  // Names from files may not be UTF-8; such bytes are replaced instead of throwing.
  return print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

int fail(const Error& error, bool json) {
  if (json) {
    print(errorJson(error.problem()));
  } else {
    std::fprintf(stderr, "%s\n", formatProblem(error.problem()).c_str());
  }
  return exitCode(error.kind());
}

}  // namespace

int runCommand(const std::vector<std::string>& arguments) {
  catchStopSignals();
  watchStopFlag(&stopRequested());
  vdb::setLibraryLimits({.in_child = true});
  // Looked for before parsing, because a usage error must be JSON too.
  const bool json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  try {
    const Invocation invocation = parseCommandLine(arguments);
    if (invocation.no_cache) keepNothing();
    bool printed = false;
    bool is_yes = true;
    if (!invocation.print.empty()) {
      printed = print(invocation.print);
    } else if (const auto* help = std::get_if<HelpOptions>(&invocation.options)) {
      printed = print(helpText(*help));
    } else {
      Report report;
      {
        Console console(invocation.general.quiet);
        report = std::visit(
            [&](const auto& options) -> Report {
              if constexpr (std::is_same_v<std::decay_t<decltype(options)>, HelpOptions>) {
                return {};
              } else {
                return run(options, invocation.general, console);
              }
            },
            invocation.options);
      }
      is_yes = report.is_yes;
      if (standardOutputIsTaken()) {  // if a file of the run takes stdout, the summary goes to
                                      // stderr
        printed = invocation.general.quiet || std::fputs(report.text.c_str(), stderr) >= 0;
      } else {
        printed = invocation.general.json ? print(report.json) : print(report.text);
      }
    }
    if (!printed) {
      std::fputs("error: cannot write to standard output\n", stderr);
      return 1;
    }
    return is_yes ? 0 : 1;
  } catch (const Error& error) {
    return fail(error, json);
  } catch (const std::bad_alloc&) {
    return fail(Error(ErrorKind::kOperation, {"out_of_memory", "there is not enough memory",
                                              "try larger voxels or a smaller picture"}),
                json);
  } catch (const std::exception& error) {
    return fail(Error(ErrorKind::kOperation,
                      {"internal", std::string("unexpected: ") + error.what(),
                       "this is a fault of palpate; please report it with the command line"}),
                json);
  }
}

}  // namespace palpate::tools
