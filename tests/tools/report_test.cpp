// palpate report: one self-contained page, whatever names occur in its inputs.

#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "markup.h"
#include "palpate/core/error.h"
#include "report_page/html_page.h"
#include "report_page/strip_chart.h"
#include "report_page/tick_columns.h"
#include "report_page/tick_source.h"
#include "tools/helpers.h"
#include "trace_reader.h"

namespace palpate::testing {
namespace {

constexpr const char* kTraceHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,tick_"
    "ns\n";

/// The text of a page without its tags and with references resolved; begins with "?" if the tags
/// are not well-formed.
std::string readBack(const std::string& page) {
  std::string text;
  std::vector<std::string> open;
  const std::string bad = "?";
  std::size_t at = page.find("<html");  // behind the document type
  if (at == std::string::npos) return bad + "no page";
  while (at < page.size()) {
    if (page[at] == '<') {
      const std::size_t end = page.find('>', at);
      if (end == std::string::npos) return bad + "a tag has no end";
      const std::string tag = page.substr(at + 1, end - at - 1);
      if (std::count(tag.begin(), tag.end(), '"') % 2 != 0)
        return bad + "a quote has no end: " + tag;
      if (tag.find('<') != std::string::npos) return bad + "a tag in a tag: " + tag;
      if (tag.starts_with('/')) {
        if (open.empty() || open.back() != tag.substr(1)) return bad + "ends out of order: " + tag;
        open.pop_back();
      } else if (!tag.ends_with('/')) {
        open.push_back(tag.substr(0, tag.find(' ')));
      }
      text += '\x1F';  // separates two texts
      at = end + 1;
    } else if (page[at] == '&') {
      const std::size_t end = page.find(';', at);
      if (end == std::string::npos || end - at > 6) return bad + "a bare &";
      const std::string name = page.substr(at + 1, end - at - 1);
      const std::map<std::string, char> known = {
          {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"#39", '\''}};
      if (!known.contains(name)) return bad + "unknown reference " + name;
      text += known.at(name);
      at = end + 1;
    } else {
      text += page[at++];
    }
  }
  return open.empty() ? text : bad + "left open: " + open.back();
}

bool hasText(const std::string& read_back, const std::string& text) {
  return read_back.find('\x1F' + text + '\x1F') != std::string::npos;
}

/// The page loads nothing from elsewhere, and runs nothing.
void expectSelfContained(const std::string& page) {
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("http:"), std::string::npos);
  EXPECT_EQ(page.find("https:"), std::string::npos);
  for (std::size_t at = page.find("src="); at != std::string::npos;
       at = page.find("src=", at + 1)) {
    const std::string value = page.substr(at, 16);
    EXPECT_TRUE(value.starts_with("src=\"data:image/")) << value;
  }
  const std::string read = readBack(page);
  EXPECT_FALSE(read.starts_with('?')) << read.substr(0, 200);
}

struct ReportedPage {
  CommandResult result;
  std::string page;
  std::string text;  ///< readBack()
};

ReportedPage reported(const TempFolder& folder, std::vector<std::string> inputs) {
  inputs.insert(inputs.begin(), "report");
  inputs.insert(inputs.end(), {"-o", "out.html", "--force"});
  ReportedPage out;
  out.result = runPalpate(inputs, folder.path());
  if (out.result.exit_code == 0) {
    out.page = textOf(folder.path("out.html"));
    out.text = readBack(out.page);
    expectSelfContained(out.page);
  }
  return out;
}

/// One row of a trace; lengths in m.
std::string rowOf(double t, double x, double proxy_x, double force_x, const std::string& region,
                  const std::string& ports = {}) {
  char numbers[256];
  std::snprintf(numbers, sizeof numbers, "%.17g,%.17g,0,0,%.17g,0,0,%.17g,0,0,", t, x, proxy_x,
                force_x);
  return numbers + region + (force_x != 0.0 ? ",1," : ",0,") + ports + ",250\n";
}

TEST(Markup, EachSignIsWrittenAsText) {
  EXPECT_EQ(tools::markupText("a<b>&\"c\"'"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;");
  EXPECT_EQ(tools::markupText("Käse \xF0\x9F\xA7\x80"), "Käse \xF0\x9F\xA7\x80");
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(tools::markupText("\x01\x7F"), bad + bad);  // control characters
  EXPECT_EQ(tools::markupText("\xFF"
                              "a"),
            bad + "a");                                           // bytes that never occur in UTF-8
  EXPECT_EQ(tools::markupText("\xC0\xBC"), bad + bad);            // overlong "<"
  EXPECT_EQ(tools::markupText("\xED\xA0\x80"), bad + bad + bad);  // a lone surrogate
  EXPECT_EQ(tools::markupText("\xE2\x82"), bad + bad);            // truncated
  EXPECT_EQ(tools::markupText("\xF4\x90\x80\x80"), bad + bad + bad + bad);  // beyond U+10FFFF
}

TEST(Markup, Base64AsInItsStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(tools::base64(""), "");
  EXPECT_EQ(tools::base64("f"), "Zg==");
  EXPECT_EQ(tools::base64("fo"), "Zm8=");
  EXPECT_EQ(tools::base64("foo"), "Zm9v");
  EXPECT_EQ(tools::base64("foob"), "Zm9vYg==");
  EXPECT_EQ(tools::base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(tools::base64("foobar"), "Zm9vYmFy");
}

// Random ticks: no peak is lost, and work is computed with each force held until the next tick.
TEST(TickColumns, KeepPeaksAndWorkOfAnyNumberOfTicks) {
  for (const int ticks : {1, 2, 1023, 1024, 1025, 5000}) {
    std::mt19937_64 random(static_cast<std::uint64_t>(ticks));
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    tools::TickColumns columns;
    double peak = 0.0, work = 0.0;
    Vec3 hip(0.0), force(0.0);
    for (int i = 0; i < ticks; ++i) {
      devices::RecordedTick tick;
      tick.tick.reading.time = 1e-3 * i;
      const Vec3 next(any(random), any(random), any(random));
      if (i > 0) work += glm::dot(force, next - hip);
      hip = next;
      force = {any(random), any(random), any(random)};
      tick.tick.hip.position = hip;
      tick.tick.result.force = force;
      peak = std::max(peak, glm::length(force));
      columns.add(tick, {});
    }
    const auto& all = columns.columns();
    ASSERT_LE(all.size(), tools::TickColumns::kMost);
    ASSERT_GE(all.size(), std::min<std::size_t>(static_cast<std::size_t>(ticks),
                                                tools::TickColumns::kMost / 2));
    double seen = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      seen = std::max(seen, all[i].force.most);
      EXPECT_LE(all[i].begin, all[i].end);
      if (i == 0) continue;
      EXPECT_LT(all[i - 1].end, all[i].begin);
    }
    EXPECT_EQ(seen, peak);
    EXPECT_EQ(all.back().end, 1e-3 * (ticks - 1));
    EXPECT_LE(all.back().work.least, work);
    EXPECT_GE(all.back().work.most, work);
  }
}

TEST(Report, ATraceOfKnownForcesAndWork) {
  const TempFolder folder;
  // 10 mm in steps of 1 mm against 2 N: the hand does a work of 20 mJ, and the proxy stays 10 mm
  // behind it.
  std::string trace = kTraceHeader;
  for (int i = 0; i <= 10; ++i) {
    trace += rowOf(0.001 * i, 0.001 * i, 0.0, -2.0, "outside", i == 10 ? "in;out" : "");
  }
  trace += rowOf(0.011, 0.010, 0.010, 0.0, "liquid");
  (void)folder.file("t.csv", trace);
  const ReportedPage got = reported(folder, {"t.csv"});
  ASSERT_EQ(got.result.exit_code, 0) << got.result.err;
  EXPECT_EQ(got.result.out, "Wrote out.html\n");
  EXPECT_TRUE(hasText(got.text, "-20 mJ")) << got.text;
  EXPECT_TRUE(hasText(got.text, "12 in 0.011 s of hand time"));
  EXPECT_TRUE(hasText(got.text, "11 ticks (91.7 %)"));
  EXPECT_NE(got.text.find("2 N with the proxy at (0, 0, 0) mm"), std::string::npos);
  for (const char* name : {"outside", "liquid", "in", "out"}) {
    EXPECT_TRUE(hasText(got.text, name)) << name;
  }
  EXPECT_NE(got.text.find("palpate report t.csv -o out.html --force"), std::string::npos)
      << "the command that made it";
  const CommandResult again = runPalpate({"report", "t.csv", "-o", "out.html"}, folder.path());
  EXPECT_EQ(again.exit_code, 1) << "nothing is overwritten unasked";
}

TEST(Report, ATouchWithItsSceneShowsBoth) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  ASSERT_EQ(runPalpate({"touch", "c.yaml", "--insert", "0,0,60", "0,0,0", "--back", "--trace",
                        "t.csv", "--record", "r.npy"},
                       folder.path())
                .exit_code,
            0);
  const ReportedPage got = reported(folder, {"t.csv", "c.yaml", "--device", "touch"});
  ASSERT_EQ(got.result.exit_code, 0) << got.result.err;
  for (const char* part : {"What was touched", "Ports passed", "Transitions", "The table of states",
                           "mouth", "liquid", "glass (1500 N/m)"}) {
    EXPECT_NE(got.text.find(part), std::string::npos) << part;
  }
  EXPECT_NE(got.text.find("What is felt, at the hand, beside what touch holds at 1000 Hz"),
            std::string::npos);
  EXPECT_NE(got.page.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);

  // A record refers to its scene, which is shown if it has not changed.
  const ReportedPage record = reported(folder, {"r.npy"});
  ASSERT_EQ(record.result.exit_code, 0) << record.result.err;
  EXPECT_NE(record.text.find("Scene: c.yaml"), std::string::npos);
  EXPECT_NE(record.text.find("What it was made with"), std::string::npos);
  EXPECT_TRUE(hasText(record.text, "1000 Hz"));
  (void)folder.file("c.yaml", std::string(kContainer) + "# not what it was\n");
  const ReportedPage changed = reported(folder, {"r.npy"});
  ASSERT_EQ(changed.result.exit_code, 0) << changed.result.err;
  EXPECT_EQ(changed.text.find("Scene: c.yaml"), std::string::npos);
  EXPECT_NE(changed.text.find("has changed since it was felt, so it is not shown"),
            std::string::npos);
}

TEST(Report, ABenchInTables) {
  const TempFolder folder;
  const std::string name = "<i>&\"ball\"</i>";
  const Json bench = {
      {"schema", "palpate.bench/1"},
      {"bench", "contact"},
      {"machine", {{"cpu", "A & B"}, {"threads", 2}}},
      {"results",
       {{{"scene", name},
         {"renderer", "constraint"},
         {"tick_ns", {{"median", 300.0}, {"p99.9", 341.5}}},
         {"force_error", {{"rms", 1e-9}}},
         {"unsettled", {{"share", 0.25}}}},
        {{"scene", "other"}, {"renderer", "paper"}, {"why_not", "it has <sheets>"}}}}};
  (void)folder.file("b.json", bench.dump());
  const ReportedPage got = reported(folder, {"b.json"});
  ASSERT_EQ(got.result.exit_code, 0) << got.result.err;
  for (const std::string& cell : {name, std::string("300"), std::string("341.5"), std::string("25"),
                                  std::string("other, paper: it has <sheets>")}) {
    EXPECT_TRUE(hasText(got.text, cell)) << cell;
  }
  EXPECT_NE(got.text.find("A & B, 2 threads"), std::string::npos);

  // Missing values, or values of another type, become a dash or a question mark; the command does
  // not fail.
  for (const char* results :
       {"[]", "[{}]", "[1, null, [2]]", "[{\"tick_ns\": 7, \"scene\": []}]"}) {
    for (const std::string what : {"contact", "stability", "servo"}) {
      (void)folder.file("b.json", "{\"schema\": \"palpate.bench/1\", \"bench\": \"" + what +
                                      "\", \"results\": " + results + "}");
      EXPECT_EQ(reported(folder, {"b.json"}).result.exit_code, 0) << what << results;
    }
    (void)folder.file("b.json", std::string("{\"schema\": \"palpate.accuracy/1\", \"results\": ") +
                                    results + "}");
    EXPECT_EQ(reported(folder, {"b.json"}).result.exit_code, 0) << results;
  }
}

TEST(Report, WhatItCannotReadIsOneError) {
  const TempFolder folder;
  (void)folder.file("t.csv", "t,x,y,z\n0,0,0,0\n");
  (void)folder.file("e.csv", kTraceHeader);
  (void)folder.file("q.csv", kTraceHeader + std::string("0,0,0,0,0,0,0,0,0,0,\"a,0,,1\n"));
  (void)folder.file("b.json", "{\"schema\": \"palpate.touch/1\"}");
  (void)folder.file("n.json", "{\"schema\": \"palpate.bench/1\", \"bench\": \"servo\"}");
  (void)folder.file("m.stl", "solid\n");
  const std::vector<std::pair<std::string, std::string>> all = {
      {"t.csv", "t.csv:1:1: error: this is not a trace"},
      {"e.csv", "the trace has no rows"},
      {"q.csv", "a quoted name has no end"},
      {"b.json", "there is no chapter for palpate.touch/1"},
      {"n.json", "it has no list of results"},
      {"m.stl", "there is no chapter for such a file"},
      {"none.csv", "there is no such file"}};
  for (const auto& [file, message] : all) {
    const CommandResult result = runPalpate({"report", file, "-o", "o.html"}, folder.path());
    EXPECT_EQ(result.exit_code, 3) << file;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path("o.html"))) << file;
  }
  EXPECT_EQ(runPalpate({"report", "-o", "o.html"}, folder.path()).exit_code, 2);
  EXPECT_EQ(runPalpate({"report", "t.csv", "-o", "o.txt"}, folder.path()).exit_code, 2);
}

/// The name in the form that a trace writes.
std::string inCsv(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// Names of arbitrary characters, in a trace and on a page: both return the same name when read
// back.
TEST(RandomReports, KeepEveryName) {
  const std::string signs = "<>&\"'ab ,-=/\\\n\t;!\xC3\xA9";
  std::mt19937_64 random(23);
  std::uniform_int_distribution<std::size_t> any(0, signs.size() - 3);
  const TempFolder folder;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::string> names;
    std::string trace = kTraceHeader;
    for (int i = 0; i < 5; ++i) {
      std::string name = std::to_string(i);
      while (name.size() < 12) {
        const std::size_t at = any(random);
        name += at + 3 == signs.size() ? std::string("\xC3\xA9") : std::string(1, signs[at]);
      }
      names.push_back(name);
      trace += rowOf(i, 0.0, 0.0, 0.0, inCsv(name));
    }
    const std::string file = folder.file("t.csv", trace);
    const tools::TickSource source = tools::readTrace(file, {});
    ASSERT_EQ(source.regions, names);
    tools::HtmlPage page(names[0]);
    page.heading(names[1]);
    page.table(names[2], {{"name"}, {names[3]}});
    page.png("", names[4]);
    const std::string written = page.text(names[0]);
    expectSelfContained(written);
    const std::string text = readBack(written);
    for (const std::string& name : names) ASSERT_TRUE(hasText(text, name)) << name;
  }
}

// A trace with damage anywhere is either read, or refused with an error of input.
TEST(RandomReports, RefuseDamageOrReadIt) {
  const TempFolder folder;
  std::string whole = kTraceHeader;
  for (int i = 0; i < 4; ++i) whole += rowOf(0.001 * i, 0.002, 0.001, 1.5, "\"a,b\"", "p;q");
  std::mt19937_64 random(24);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string damaged = whole;
    for (int i = 0; i < 3; ++i) {
      const std::size_t at = random() % damaged.size();
      switch (random() % 3) {
        case 0:
          damaged[at] = static_cast<char>(random());
          break;
        case 1:
          damaged.erase(at, random() % 8);
          break;
        default:
          damaged.insert(at, 1, ",\"\n;e-"[random() % 6]);
      }
    }
    try {
      tools::TickColumns columns;
      devices::RecordSink* const sinks[] = {&columns};
      const tools::TickSource source = tools::readTrace(folder.file("t.csv", damaged), sinks);
      EXPECT_LE(source.ticks, 8U);
      tools::HtmlPage page("t");
      page.svg(tools::stripChart({}, columns.columns(), source.regions, source.ports), "chart");
      expectSelfContained(page.text(""));
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::kInput) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000) << "most damage shows";
}

}  // namespace
}  // namespace palpate::testing
