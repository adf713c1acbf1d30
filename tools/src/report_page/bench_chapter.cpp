#include <cmath>
#include <initializer_list>

#include "bench/plot.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"
#include "report_page/chapters.h"

namespace palpate::tools {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostRows = 2000;
constexpr std::size_t kMostMarks = 400;  // with more, a plot is unreadable

/// A column of a table, and the path of its values in an object.
struct Column {
  const char* heading;
  const char* pointer;
  double factor = 1.0;
};

const Json* valueAt(const Json& object, const char* pointer) {
  const Json::json_pointer at(pointer);
  return object.contains(at) ? &object.at(at) : nullptr;
}

std::string cell(const Json* value, double factor = 1.0) {
  if (value == nullptr || value->is_null()) return "-";
  if (value->is_boolean()) return value->get<bool>() ? "yes" : "no";
  if (value->is_string()) return value->get<std::string>();
  if (value->is_number()) return formatNumber(factor * value->get<double>(), 4);
  return "?";
}

std::string textAt(const Json& object, const char* pointer) {
  return cell(valueAt(object, pointer));
}

double numberAt(const Json& object, const char* pointer) {
  const Json* value = valueAt(object, pointer);
  return value != nullptr && value->is_number() ? value->get<double>() : std::nan("");
}

/// The objects of an array; empty if it is not an array.
std::vector<Json> objectsOf(const Json* list) {
  std::vector<Json> objects;
  if (list == nullptr || !list->is_array()) return objects;
  for (const Json& each : *list) {
    if (each.is_object()) objects.push_back(each);
  }
  return objects;
}

void addTable(HtmlPage& page, const std::string& title, const std::vector<Json>& objects,
              std::initializer_list<Column> columns) {
  Rows rows(1);
  for (const Column& column : columns) rows.front().emplace_back(column.heading);
  std::size_t more = 0;
  for (const Json& object : objects) {
    if (object.contains("why_not")) continue;
    if (rows.size() > kMostRows) {
      ++more;
      continue;
    }
    auto& row = rows.emplace_back();
    for (const Column& c : columns) row.push_back(cell(valueAt(object, c.pointer), c.factor));
  }
  page.table(title, rows);
  if (more > 0) page.paragraph("... and " + formatCount(more) + " more");
}

void addRefused(HtmlPage& page, const std::vector<Json>& objects) {
  for (const Json& object : objects) {
    if (!object.contains("why_not")) continue;
    page.note(textAt(object, "/scene") + ", " + textAt(object, "/renderer") + ": " +
              textAt(object, "/why_not"));
  }
}

void addContact(HtmlPage& page, const Json& bench, const std::vector<Json>& rows) {
  page.paragraph("Hot: shortest of " + textAt(bench, "/repeats") +
                 " runs for each tick. Paced: one tick a millisecond. Cold: after other data went "
                 "through the caches. Times in ns.");
  addTable(page, "Time of a tick", rows,
           {{"scene", "/scene"},
            {"renderer", "/renderer"},
            {"ticks", "/ticks"},
            {"hot median", "/tick_ns/median"},
            {"99 %", "/tick_ns/p99"},
            {"99.9 %", "/tick_ns/p99.9"},
            {"longest", "/tick_ns/max"},
            {"paced median", "/paced_tick_ns/median"},
            {"99.9 %", "/paced_tick_ns/p99.9"},
            {"cold median", "/cold_tick_ns/median"},
            {"99.9 %", "/cold_tick_ns/p99.9"}});
  addTable(page, "Error of the force", rows,
           {{"scene", "/scene"},
            {"renderer", "/renderer"},
            {"judged", "/judged"},
            {"direction, degrees RMS", "/direction_error_degrees/rms"},
            {"max", "/direction_error_degrees/max"},
            {"magnitude, share RMS", "/magnitude_error/rms"},
            {"max", "/magnitude_error/max"},
            {"missed", "/missed"},
            {"largest step, N", "/largest_step_N"},
            {"true", "/true_largest_step_N"},
            {"unsettled, %", "/unsettled/share", 100.0},
            {"in a row", "/unsettled/longest_run"}});
  addRefused(page, rows);

  Plot plot;
  plot.title = "Contact: error against time";
  plot.x_label = "median time of a tick [ns]";
  plot.y_label = "RMS error of the force, share of the true force (0 is drawn at the bottom)";
  plot.series = {"constraint", "paper"};
  for (const Json& row : rows) {
    const double time = numberAt(row, "/tick_ns/median");
    const double error = numberAt(row, "/force_error/rms");
    const bool is_sane = time > 1e-3 && time < 1e15 && error >= 0.0 && error < 1e15;
    if (!is_sane || plot.points.size() == kMostMarks) continue;
    const std::string scene = textAt(row, "/scene");
    std::size_t number = 0;
    while (number < plot.key.size() && plot.key[number] != scene) ++number;
    if (number == plot.key.size()) plot.key.push_back(scene);
    plot.points.push_back({time, error, static_cast<int>(number) + 1,
                           textAt(row, "/renderer") == "paper" ? std::size_t{1} : std::size_t{0}});
  }
  if (!plot.points.empty()) page.svg(plotSvg(plot), plot.title);
}

void addStability(HtmlPage& page, const std::vector<Json>& rows) {
  addTable(page, "Stiffest wall on which the hand comes to rest", rows,
           {{"scene", "/scene"},
            {"renderer", "/renderer"},
            {"device", "/device"},
            {"hand", "/hand"},
            {"rate, Hz", "/rate_Hz"},
            {"delay", "/delay"},
            {"budget, N/m", "/budget_N_per_m"},
            {"found, N/m", "/found_N_per_m"},
            {"above it: N", "/cycle_N"},
            {"Hz", "/cycle_Hz"},
            {"at it: to hand, J", "/to_hand_J"},
            {"largest step, N", "/largest_step_N"},
            {"felt", "/holds"},
            {"tick, ns", "/tick_ns"}});
}

void addServo(HtmlPage& page, const std::vector<Json>& rows) {
  addTable(page, "How late the turns of an empty loop began", rows,
           {{"rate, Hz", "/rate_Hz"},
            {"busy threads", "/load_threads"},
            {"turns", "/turns"},
            {"missed", "/overruns"},
            {"late: median, us", "/late_ns/p50", 1e-3},
            {"99 %", "/late_ns/p99", 1e-3},
            {"99.9 %", "/late_ns/p999", 1e-3},
            {"longest", "/late_ns/max", 1e-3},
            {"good enough", "/good"}});
}

void addAccuracy(HtmlPage& page, const Json& bench, const std::vector<Json>& fields) {
  page.paragraph("Grids against the truth at " + textAt(bench, "/points") +
                 " random points near the surface of " + textAt(bench, "/scene") + ".");
  for (const Json& field : fields) {
    std::vector<Json> rows;
    for (const Json& grid : objectsOf(valueAt(field, "/grids"))) {
      for (Json& sampler : objectsOf(valueAt(grid, "/samplers"))) {
        sampler["grid"] = grid;
        sampler["grid"].erase("samplers");
        rows.push_back(std::move(sampler));
      }
      if (grid.contains("why_not")) {
        page.note(textAt(field, "/field") + ": " + textAt(grid, "/why_not"));
      }
    }
    addTable(page, textAt(field, "/field"), rows,
             {{"voxel, mm", "/grid/voxel_size_m", 1e3},
              {"active voxels", "/grid/active_voxels"},
              {"sampler", "/sampler"},
              {"distance, mm RMS", "/smooth/value_error_m/rms", 1e3},
              {"max", "/smooth/value_error_m/max", 1e3},
              {"normal, degrees RMS", "/smooth/normal_error_degrees/rms"},
              {"max", "/smooth/normal_error_degrees/max"},
              {"near edges: normal RMS", "/near_edges/normal_error_degrees/rms"},
              {"ns", "/query_ns/independent"},
              {"dependent", "/query_ns/dependent"},
              {"cold, us", "/query_ns/cold", 1e-3},
              {"MB", "/memory_bytes", 1e-6},
              {"bake, s", "/grid/bake_seconds"}});
  }
}

}  // namespace

void checkBench(const Json& bench, const std::string& file) {
  const std::string schema = textAt(bench, "/schema");
  const std::string what = textAt(bench, "/bench");
  const bool is_known = schema == "palpate.accuracy/1" ||
                        (schema == "palpate.bench/1" &&
                         (what == "contact" || what == "stability" || what == "servo"));
  const Json* results = valueAt(bench, "/results");
  if (is_known && results != nullptr && results->is_array()) return;
  throw inputError(
      "bench.kind",
      is_known ? "it has no list of results"
               : "there is no chapter for " + (schema == "-" ? "it" : schema),
      "give what palpate bench contact, stability or servo, or palpate accuracy, prints "
      "with --json",
      file);
}

void addBenchChapter(HtmlPage& page, const Json& bench, const std::string& file) {
  const bool is_accuracy = textAt(bench, "/schema") == "palpate.accuracy/1";
  const std::string what = is_accuracy ? "accuracy" : textAt(bench, "/bench");
  page.heading("Bench " + what + ": " + vdb::fileName(file));
  page.facts(
      {{"measured on", textAt(bench, "/machine/cpu") + ", " + textAt(bench, "/machine/threads") +
                           " threads, " + textAt(bench, "/machine/system")},
       {"with", "palpate " + textAt(bench, "/machine/palpate") + ", " +
                    textAt(bench, "/machine/compiler") + ", " + textAt(bench, "/machine/build") +
                    " build"}});
  if (textAt(bench, "/machine/optimized") == "no") {
    page.note("This build was not optimized: its times are not valid.");
  }
  const std::vector<Json> rows = objectsOf(valueAt(bench, "/results"));
  if (is_accuracy) {
    addAccuracy(page, bench, rows);
  } else if (what == "contact") {
    addContact(page, bench, rows);
  } else if (what == "stability") {
    addStability(page, rows);
  } else {
    addServo(page, rows);
  }
}

}  // namespace palpate::tools
