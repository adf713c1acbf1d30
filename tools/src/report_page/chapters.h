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

/// A trace or a record, summed up.
struct Touch {
  std::string file;
  TickSource source;
  TouchSummary summary;
  std::vector<TickColumn> columns;
  Track track;  ///< thinned
};

/// @throws Error (kInput, kCancelled).
[[nodiscard]] Touch readTouch(const std::string& file);

void addTouchChapter(HtmlPage& page, const Touch& touch);

struct SceneChapter {
  std::string name;      ///< for the heading
  DeviceOptions device;  ///< of the stability budget
  double rate = 1000.0;  ///< [Hz]
  Track track;           ///< drawn into the picture; may be empty
};
void addSceneChapter(HtmlPage& page, const LoadedScene& loaded, const SceneChapter& what,
                     Console& console);

/// What `palpate bench ... --json` or `palpate accuracy ... --json` printed, which `file` holds.
void addBenchChapter(HtmlPage& page, const Json& bench, const std::string& file);
/// @throws Error (kInput, bench.*) for what is not one of these.
void checkBench(const Json& bench, const std::string& file);

}  // namespace palpate::tools
