#include "support/stored_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include "palpate/core/error.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr int kTicks = 1200;
constexpr int kKept = 20;  // one row is kept of so many ticks

/// One tick of a stored trace; [m] and [N].
struct Row {
  int tick = 0;
  Vec3 proxy{0.0};
  Vec3 force{0.0};
  bool contact = false;
  std::string region = {};
  std::string events = "-";  ///< ports passed since the previous row
};

std::vector<Row> feel(const ScenePtr& scene, RendererKind kind) {
  RendererSettings settings;
  settings.kind = kind;
  const auto renderer = makeRenderer(scene, settings);
  std::vector<Row> rows;
  Row row;
  std::string events;
  const std::vector<Vec3> path = pathThrough(*scene);
  for (int i = 0; i < kTicks; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Vec3 velocity = i > 0 ? (path[at] - path[at - 1]) / 1e-3 : Vec3(0.0);
    const TickResult out = renderer->update({path[at], velocity});
    for (int k = 0; k < out.event_count; ++k) {
      const PortId port = out.events[static_cast<std::size_t>(k)];
      events += (events.empty() ? "" : ";") + scene->ports()[port].name;
    }
    if (i % kKept != kKept - 1) continue;
    row.tick = i;
    row.proxy = out.proxy;
    row.force = out.force;
    row.contact = out.contact;
    row.region = scene->regions()[out.region].name;
    row.events = events.empty() ? "-" : events;
    events.clear();
    rows.push_back(row);
  }
  return rows;
}

/// Replaces blanks in names, so that a row consists of words.
std::string word(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

std::string textOf(const std::vector<Row>& rows) {
  std::string out = "tick proxy_mm force_N contact region ports\n";
  for (const Row& row : rows) {
    std::array<char, 200> buffer{};
    const auto clean = [](double v) { return std::fabs(v) < 1e-12 ? 0.0 : v; };
    (void)std::snprintf(buffer.data(), buffer.size(), "%d %.7g %.7g %.7g %.6g %.6g %.6g %d ",
                        row.tick, 1e3 * clean(row.proxy.x), 1e3 * clean(row.proxy.y),
                        1e3 * clean(row.proxy.z), clean(row.force.x), clean(row.force.y),
                        clean(row.force.z), row.contact ? 1 : 0);
    out += buffer.data() + word(row.region) + " " + word(row.events) + "\n";
  }
  return out;
}

std::vector<Row> rowsOf(const std::string& text) {
  std::vector<Row> out;
  std::istringstream in(text);
  std::string header;
  std::getline(in, header);
  Row row;
  while (in >> row.tick >> row.proxy.x >> row.proxy.y >> row.proxy.z >> row.force.x >>
         row.force.y >> row.force.z >> row.contact >> row.region >> row.events) {
    row.proxy *= 1e-3;
    out.push_back(row);
  }
  return out;
}

}  // namespace

std::vector<Vec3> pathThrough(const Scene& scene) {
  Box3 box = scene.bounds();
  if (!box.isBounded()) box = {Vec3(-0.04), Vec3(0.04)};
  const Vec3 center = box.center();
  const Vec3 half = 0.5 * box.size();
  Random random(2026);
  constexpr int kTicksALeg = 150;
  std::vector<Vec3> corners = {center + 1.3 * half};
  for (int leg = 0; leg <= kTicks / kTicksALeg; ++leg) {
    // From time to time back out, so that regions are left again.
    const double reach = leg % 4 == 3 ? 1.25 : 0.9;
    corners.push_back(center + reach * half * random.in({Vec3(-1.0), Vec3(1.0)}));
  }
  std::vector<Vec3> out;
  for (int i = 0; i < kTicks; ++i) {
    const auto leg = static_cast<std::size_t>(i / kTicksALeg);
    const double t = static_cast<double>(i % kTicksALeg) / kTicksALeg;
    out.push_back(glm::mix(corners[leg], corners[leg + 1], t * t * (3.0 - 2.0 * t)));
  }
  return out;
}

::testing::AssertionResult compareWithStored(const ScenePtr& scene, RendererKind kind,
                                             const std::string& file) {
  std::string text;
  try {
    text = textOf(feel(scene, kind));
  } catch (const Error& error) {
    text = "refused: " + error.problem().code + "\n";
  }
  if (std::getenv("PALPATE_REWRITE_TRACES") != nullptr) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    return out ? ::testing::AssertionSuccess()
               : ::testing::AssertionFailure() << file << " cannot be written";
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    return ::testing::AssertionFailure()
           << file << " is not there: PALPATE_REWRITE_TRACES=1 writes it";
  }
  std::ostringstream stored;
  stored << in.rdbuf();
  if (text.rfind("refused", 0) == 0 || stored.str().rfind("refused", 0) == 0) {
    if (text == stored.str()) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "refused then or now, not both: " << text;
  }
  const std::vector<Row> then = rowsOf(stored.str());
  const std::vector<Row> now = rowsOf(text);
  if (then.size() != now.size()) {
    return ::testing::AssertionFailure()
           << file << " has " << then.size() << " rows, there are " << now.size() << " now";
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    const bool is_same =
        glm::length(now[i].proxy - then[i].proxy) <= 1e-8 &&
        glm::length(now[i].force - then[i].force) <= 1e-5 + 1e-5 * glm::length(then[i].force) &&
        now[i].contact == then[i].contact && now[i].region == then[i].region &&
        now[i].events == then[i].events && now[i].tick == then[i].tick;
    if (is_same) continue;
    return ::testing::AssertionFailure() << file << ", tick " << now[i].tick << ": stored\n  "
                                         << textOf({then[i]}) << "now\n  " << textOf({now[i]});
  }
  return ::testing::AssertionSuccess();
}

}  // namespace palpate::test
