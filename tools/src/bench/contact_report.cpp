#include "bench/contact_report.h"

#include "bench/machine_json.h"
#include "bench/plot.h"
#include "text.h"

namespace palpate::tools {
namespace {

const char* nameOf(RendererKind kind) {
  return kind == RendererKind::kPaper ? "paper" : "constraint";
}

Json spreadJson(const std::optional<Spread>& spread) {
  return spread ? Json{{"rms", spread->rms}, {"max", spread->most}} : Json();
}

Json timesJson(const std::optional<OnceTimes>& times) {
  return times ? Json{{"ticks", times->ticks}, {"median", times->median}, {"p99.9", times->p999}}
               : Json();
}

Json numberJson(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

/// A cell of a table: the value, or `otherwise` if there is none.
std::string cell(const std::optional<double>& value, int digits, const char* otherwise) {
  return value ? formatNumber(*value, digits) : otherwise;
}

/// The optional values of a row, in the same order for the table and the file.
struct Cells {
  explicit Cells(const Measurement& m) {
    if (m.paced) paced_median = m.paced->median, paced_p999 = m.paced->p999;
    if (m.cold) cold_median = m.cold->median, cold_p999 = m.cold->p999;
    if (m.unsettled) {
      unsettled_share = m.unsettled->share();
      unsettled_run = static_cast<double>(m.unsettled->longest());
    }
    if (!m.judgement) return;
    const Judgement& j = *m.judgement;
    judged = static_cast<double>(j.ticks);
    missed = static_cast<double>(j.missed);
    if (j.direction) direction_rms = j.direction->rms, direction_max = j.direction->most;
    if (j.magnitude) magnitude_rms = j.magnitude->rms, magnitude_max = j.magnitude->most;
    if (j.error) error_rms = j.error->rms, error_max = j.error->most;
  }
  std::optional<double> paced_median, paced_p999, cold_median, cold_p999;
  std::optional<double> unsettled_share, unsettled_run, judged, missed;
  std::optional<double> direction_rms, direction_max, magnitude_rms, magnitude_max;
  std::optional<double> error_rms, error_max;
};

}  // namespace

Json rowJson(const BenchRow& row) {
  Json json = {
      {"scene", row.entry->name}, {"about", row.entry->about}, {"renderer", nameOf(row.renderer)}};
  if (!row.figures) {
    json["why_not"] = row.why;
    return json;
  }
  const Measurement& m = *row.figures;
  const Judgement none;
  const Judgement& j = m.judgement ? *m.judgement : none;
  json["ticks"] = m.ticks;
  json["judged"] = m.judgement ? Json(j.ticks) : Json();
  json["missed"] = m.judgement ? Json(j.missed) : Json();
  json["unsettled"] = m.unsettled ? Json{{"ticks", m.unsettled->count()},
                                         {"share", m.unsettled->share()},
                                         {"longest_run", m.unsettled->longest()}}
                                  : Json();
  json["tick_ns"] = {
      {"median", m.hot.median}, {"p99", m.hot.p99}, {"p99.9", m.hot.p999}, {"max", m.hot.most}};
  json["paced_tick_ns"] = timesJson(m.paced);
  json["cold_tick_ns"] = timesJson(m.cold);
  json["direction_error_degrees"] = spreadJson(j.direction);
  json["magnitude_error"] = spreadJson(j.magnitude);
  json["force_error"] = spreadJson(j.error);
  json["largest_step_N"] = m.step;
  json["true_largest_step_N"] = numberJson(m.true_step);
  json["largest_turn_degrees"] = m.turn;
  json["true_largest_turn_degrees"] = numberJson(m.true_turn);
  return json;
}

std::string tablesText(const std::vector<BenchRow>& rows) {
  Table times({"scene", "renderer", "ticks", "hot median ns", "p99", "p99.9", "max", "paced median",
               "p99.9", "cold median", "p99.9"});
  Table errors({"scene", "renderer", "judged", "dir deg rms", "max", "mag rms", "max", "missed",
                "step N", "true", "turn deg", "true", "unsettled %", "in a row"});
  std::string refused;
  for (const BenchRow& row : rows) {
    if (!row.figures) {
      refused += "  " + row.entry->name + ", " + nameOf(row.renderer) + ": " + row.why + "\n";
      continue;
    }
    const Measurement& m = *row.figures;
    const Cells c(m);
    const auto ns = [](const std::optional<double>& value) { return cell(value, 6, "-"); };
    const auto count = [](const std::optional<double>& value) { return cell(value, 12, "-"); };
    const auto brief = [](const std::optional<double>& value) { return cell(value, 2, "-"); };
    times.add({row.entry->name, nameOf(row.renderer), std::to_string(m.ticks), ns(m.hot.median),
               ns(m.hot.p99), ns(m.hot.p999), ns(m.hot.most), ns(c.paced_median), ns(c.paced_p999),
               ns(c.cold_median), ns(c.cold_p999)});
    const std::string percent = m.unsettled ? formatNumber(100.0 * m.unsettled->share(), 3) : "-";
    errors.add({row.entry->name, nameOf(row.renderer), count(c.judged), brief(c.direction_rms),
                brief(c.direction_max), brief(c.magnitude_rms), brief(c.magnitude_max),
                count(c.missed), formatNumber(m.step, 3), cell(m.true_step, 3, "-"),
                formatNumber(m.turn, 4), cell(m.true_turn, 4, "-"), percent,
                count(c.unsettled_run)});
  }
  std::string text = times.empty() ? "" : times.text("") + "\n" + errors.text("");
  if (!refused.empty()) text += "\nNot done\n" + refused;
  return text;
}

std::string csvText(const std::vector<BenchRow>& rows) {
  std::string text =
      "scene,renderer,ticks,judged,missed,median_ns,p99_ns,p99.9_ns,max_ns,paced_median_ns,"
      "paced_p99.9_ns,cold_median_ns,cold_p99.9_ns,direction_rms_degrees,"
      "direction_max_degrees,magnitude_rms,magnitude_max,force_error_rms,force_error_max,"
      "largest_step_N,true_largest_step_N,largest_turn_degrees,true_largest_turn_degrees,"
      "unsettled_share,longest_unsettled_ticks\n";
  for (const BenchRow& row : rows) {
    if (!row.figures) continue;
    const Measurement& m = *row.figures;
    const Cells c(m);
    text += row.entry->name + "," + nameOf(row.renderer) + "," + std::to_string(m.ticks);
    for (const std::optional<double>& value : std::initializer_list<std::optional<double>>{
             c.judged,          c.missed,        m.hot.median,    m.hot.p99,       m.hot.p999,
             m.hot.most,        c.paced_median,  c.paced_p999,    c.cold_median,   c.cold_p999,
             c.direction_rms,   c.direction_max, c.magnitude_rms, c.magnitude_max, c.error_rms,
             c.error_max,       m.step,          m.true_step,     m.turn,          m.true_turn,
             c.unsettled_share, c.unsettled_run}) {
      text += "," + cell(value, 9, "");
    }
    text += "\n";
  }
  return text;
}

std::string svgText(const std::vector<BenchRow>& rows, const Machine& machine) {
  Plot plot;
  plot.title = "Contact: error against time";
  plot.subtitle = machineText(machine);
  plot.x_label = "median time of a tick [ns]";
  plot.y_label = "RMS error of the force, share of the true force (0 is drawn at the bottom)";
  plot.series = {"constraint", "paper"};
  for (const BenchRow& row : rows) {
    if (static_cast<std::size_t>(row.number) > plot.key.size()) plot.key.push_back(row.entry->name);
    if (!row.figures || !row.figures->judgement || !row.figures->judgement->error) continue;
    plot.points.push_back({row.figures->hot.median, row.figures->judgement->error->rms, row.number,
                           row.renderer == RendererKind::kPaper ? std::size_t{1} : std::size_t{0}});
  }
  return plotSvg(plot);
}

}  // namespace palpate::tools
