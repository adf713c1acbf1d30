#pragma once
/// The chapters of a page that `palpate report` writes.

#include <optional>
#include <string>
#include <vector>

#include "loaded_scene.h"
#include "options.h"
#include "picture/track.h"
#include "report_page/html_page.h"
#include "report_page/tick_columns.h"
#include "report_page/tick_source.h"
#include "touch_summary.h"

namespace palpate::tools {

/// Summary of a trace or a record.
struct Touch {
  std::string file;
  TickSource source;
  TouchSummary summary;
  std::vector<TickColumn> columns;
  Track track;  ///< reduced to fewer points
};

/// @throws Error (kInput, kCancelled).
[[nodiscard]] Touch readTouch(const std::string& file);

void addTouchChapter(HtmlPage& page, const Touch& touch);

struct SceneChapter {
  std::string name;      ///< for the heading
  DeviceOptions device;  ///< of the stability budget
  double rate = 1000.0;  ///< [Hz]
  Track track;           ///< to draw into the picture; may be empty
};
void addSceneChapter(HtmlPage& page, const LoadedScene& loaded, const SceneChapter& what,
                     Console& console);

/// Adds a chapter on the output of `palpate bench ... --json` or `palpate accuracy ... --json`,
/// which `file` holds.
void addBenchChapter(HtmlPage& page, const Json& bench, const std::string& file);
/// @throws Error (kInput, bench.*) if `bench` is not such an output.
void checkBench(const Json& bench, const std::string& file);

}  // namespace palpate::tools
