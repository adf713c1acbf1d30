#include <algorithm>
#include <array>

#include "palpate/core/text.h"
#include "palpate/vdb/text.h"
#include "report_page/chapters.h"
#include "report_page/strip_chart.h"
#include "thin_trace.h"

namespace palpate::tools {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr double kNoDepth = 1e-9;  // [m] rounding error by which a proxy stands off its wall
constexpr std::size_t kMostRows = 500;

std::string millimeters(double meters) {
  return formatNumber(1e3 * (meters < kNoDepth ? 0.0 : meters), 4);
}

/// Adds how the record was made.
void addMade(HtmlPage& page, const RecordAbout& about) {
  const TouchOptions& o = about.options;
  Rows rows = {
      {"scene", about.scene + " (" + about.scene_hash + ")"},
      {"renderer", about.renderer},
      {"device", about.device + (o.device.hand.empty() ? "" : ", hand " + o.device.hand)},
      {"rate", formatNumber(about.rate, 6) + " Hz" + (about.realtime ? ", real time" : "")},
      {"palpate", about.version}};
  const std::array<std::pair<const char*, const std::string*>, 6> given = {{
      {"largest force", &o.max_force},
      {"slew", &o.slew},
      {"ramp", &o.ramp},
      {"passivity", &o.passivity},
      {"largest force of the hand", &o.hand_force},
      {"coupling", &o.coupling},
  }};
  for (const auto& [name, value] : given) {
    if (!value->empty()) rows.push_back({name, *value});
  }
  if (!o.set.empty()) rows.push_back({"set", joined(o.set)});
  page.subheading("What it was made with");
  page.facts(rows);
}

void addFacts(HtmlPage& page, const TouchSummary& s) {
  Rows rows = {
      {"ticks", formatCount(s.ticks) + " in " + formatNumber(s.seconds, 4) + " s of hand time"},
      {"in contact", formatCount(s.contact_ticks) + " ticks (" +
                         formatNumber(100.0 * static_cast<double>(s.contact_ticks) /
                                          static_cast<double>(std::max<std::uint64_t>(s.ticks, 1)),
                                      3) +
                         " %)"},
      {"peak force",
       formatNumber(s.peak_force, 4) + " N" +
           (s.peak_force > 0.0 ? " with the proxy at " + formatVector(1e3 * s.peak_force_at) + " mm"
                               : "")},
      {"work on the hand", formatNumber(1e3 * s.work, 4) + " mJ"},
      {"a tick took", formatNanoseconds(s.tick_median) + " (median), " +
                          formatNanoseconds(s.tick_p99) + " (99 %), " +
                          formatNanoseconds(s.tick_p999) + " (99.9 %), " +
                          formatNanoseconds(s.tick_max) + " (longest)"}};
  if (s.unsettled) {
    rows.push_back({"unsettled", formatCount(s.unsettled->count()) + " ticks, at most " +
                                     formatCount(s.unsettled->longest()) + " in a row"});
  }
  page.facts(rows);
}

/// Lists each region once, in the order of first entry.
void addTouched(HtmlPage& page, const Touch& touch) {
  struct Sum {
    RegionId region = kOutside;
    std::uint64_t visits = 0;
    double seconds = 0.0, depth = 0.0, peak = 0.0;
  };
  std::vector<Sum> sums;
  std::vector<std::size_t> place(touch.source.regions.size(), sums.max_size());
  for (const Visit& v : touch.summary.visits) {
    std::size_t& at = place[v.region];
    if (at == sums.max_size()) {
      at = sums.size();
      sums.push_back({v.region});
    }
    Sum& sum = sums[at];
    ++sum.visits;
    sum.seconds += v.seconds;
    sum.depth = std::max(sum.depth, v.depth);
    sum.peak = std::max(sum.peak, v.peak_force);
  }
  Rows rows = {{"region", "visits", "time, s", "deepest, mm", "peak force, N"}};
  for (const Sum& sum : sums) {
    rows.push_back({touch.source.regions[sum.region], std::to_string(sum.visits),
                    formatNumber(sum.seconds, 4), millimeters(sum.depth),
                    formatNumber(sum.peak, 3)});
  }
  page.table("What was touched", rows);
}

void addVisits(HtmlPage& page, const Touch& touch) {
  const TouchSummary& s = touch.summary;
  Rows rows = {
      {"#", "region", "entered at, s", "depth at entry, mm", "deepest, mm", "peak force, N"}};
  for (std::size_t i = 0; i < std::min(s.visits.size(), kMostRows); ++i) {
    const Visit& v = s.visits[i];
    rows.push_back({std::to_string(i + 1), touch.source.regions[v.region], formatNumber(v.t, 4),
                    millimeters(v.entry_depth), millimeters(v.depth),
                    formatNumber(v.peak_force, 3)});
  }
  page.table("Regions in order", rows);
  page.paragraph(
      "Depths are of walls and of the tip, straight from the first wall met. A region that the tip "
      "went all through within one tick is not in a trace or a record.");
  const std::uint64_t all = s.visits.size() + s.more_visits;
  if (all > kMostRows) page.paragraph("... and " + formatCount(all - kMostRows) + " more");
}

void addPassed(HtmlPage& page, const Touch& touch) {
  struct Sum {
    std::uint64_t times = 0;
    double first = 0.0, last = 0.0;
  };
  std::vector<Sum> sums(touch.source.ports.size());
  for (const PassedPort& passed : touch.summary.ports) {
    Sum& sum = sums[passed.port];
    if (sum.times++ == 0) sum.first = passed.t;
    sum.last = passed.t;
  }
  Rows rows = {{"port", "times", "first at, s", "last at, s"}};
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].times == 0) continue;
    rows.push_back({touch.source.ports[i], std::to_string(sums[i].times),
                    formatNumber(sums[i].first, 4), formatNumber(sums[i].last, 4)});
  }
  page.table("Ports passed", rows);
  if (touch.summary.more_ports > 0) {
    page.note("Of the ports passed later, " + formatCount(touch.summary.more_ports) +
              " are not counted here.");
  }
}

}  // namespace

Touch readTouch(const std::string& file) {
  Touch touch{.file = file, .source = {}, .summary = {}, .columns = {}, .track = {}};
  const bool is_record = vdb::hasExtension(file, ".npy");
  RecordAbout about;
  if (is_record) about = readAbout(file).about;
  // Only the constraint renderer knows whether a tick settled, and only a record stores it.
  const bool tells_settled = is_record && about.renderer == "constraint";
  TouchMeter meter(tells_settled ? RendererKind::kConstraint : RendererKind::kPaper);
  ThinTrace thin;
  TickColumns columns;
  const std::array<devices::RecordSink*, 3> sinks = {&meter, &thin, &columns};
  touch.source = is_record ? readRecord(file, about, sinks) : readTrace(file, sinks);
  touch.summary = meter.summary();
  touch.columns = columns.columns();
  touch.track = trackOf(thin.trace().rows());
  return touch;
}

void addTouchChapter(HtmlPage& page, const Touch& touch) {
  page.heading("Touch: " + vdb::fileName(touch.file));
  if (touch.source.promised > touch.source.ticks) {
    page.note("The record was cut: " + formatCount(touch.source.ticks) + " of " +
              formatCount(touch.source.promised) + " ticks are there.");
  }
  addFacts(page, touch.summary);
  page.svg(
      stripChart(touch.summary, touch.columns, touch.source.regions, touch.source.ports),
      "Over time: the region of the proxy and the ports passed (green), the force on the hand, how "
      "far a wall keeps the proxy behind the hand, and the energy that the hand was given "
      "(falling: what it put in)");
  addTouched(page, touch);
  addPassed(page, touch);
  addVisits(page, touch);
  if (touch.source.about) addMade(page, *touch.source.about);
}

}  // namespace palpate::tools
