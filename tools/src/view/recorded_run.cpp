#include "view/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate/core/error.h"
#include "palpate/devices/record.h"
#include "palpate/vdb/text.h"
#include "record_about.h"
#include "text.h"
#include "trace_reader.h"

namespace palpate::tools {
namespace {

/// The number in `scene` for each of `names`. @throws Error (kInput).
template <typename Number>
std::vector<Number> regionNumbers(const std::vector<std::string>& names, const Scene& scene) {
  std::vector<Number> numbers;
  for (const std::string& name : names) numbers.push_back(scene.regionNamed(name));
  return numbers;
}

PortId portNamed(const std::string& name, const Scene& scene, const std::string& file) {
  for (std::size_t i = 0; i < scene.ports().size(); ++i) {
    if (scene.ports()[i].name == name) return static_cast<PortId>(i);
  }
  throw inputError("view.port", "the scene has no port '" + name + "', which was passed here",
                   "view it with the scene that it was recorded in", file);
}

Vec3 vectorOf(const devices::TickRecord::Vector& v) { return {v[0], v[1], v[2]}; }

}  // namespace

RecordedRun::RecordedRun(const std::string& file, const Scene& scene)
    : ports_(scene.ports().size()) {
  if (vdb::hasExtension(file, ".npy")) {
    readRecord(file, scene);
  } else {
    readTrace(file, scene);
  }
  if (rows_.empty()) throw inputError("view.empty", "there is no tick in it", {}, file);
  addUp(scene);
}

void RecordedRun::readRecord(const std::string& file, const Scene& scene) {
  devices::RecordReader reader(file);
  const RecordAbout about = readAbout(file).about;
  const auto regions = regionNumbers<RegionId>(about.regions, scene);
  std::vector<PortId> ports;
  for (const std::string& name : about.ports) ports.push_back(portNamed(name, scene, file));
  rows_.reserve(reader.size());
  for (devices::TickRecord from; reader.next(from);) {
    Row row;
    row.tick = from.tick;
    row.t = from.t;
    row.hip = vectorOf(from.hip);
    row.proxy = vectorOf(from.proxy);
    row.force = vectorOf(from.force);
    row.ns = from.tick_ns;
    row.contact = from.contact != 0;
    row.settled = from.settled != 0;
    row.is_late = from.late != 0;
    if (from.region < regions.size()) row.region = regions[from.region];
    const std::size_t count = std::min<std::size_t>(from.event_count, devices::TickRecord::kEvents);
    for (std::size_t i = 0; i < count; ++i) {
      if (from.events[i] < ports.size()) row.events.push_back(ports[from.events[i]]);
    }
    rows_.push_back(std::move(row));
  }
}

void RecordedRun::readTrace(const std::string& file, const Scene& scene) {
  TraceReader reader(file);
  for (TraceLine from; reader.next(from);) {
    Row row;
    row.tick = rows_.size();
    row.t = from.t;
    // A broken sensor's reading has no place.
    row.hip = from.is_finite ? from.hip : Vec3(std::numeric_limits<double>::quiet_NaN());
    row.proxy = from.proxy;
    row.force = from.force;
    row.ns = from.tick_ns;
    row.contact = from.contact;
    row.region = scene.regionNamed(from.region);
    if (!from.ports.empty()) {
      for (const std::string_view port : split(from.ports, ';')) {
        row.events.push_back(portNamed(std::string(port), scene, file));
      }
    }
    rows_.push_back(std::move(row));
  }
}

RegionEntry RecordedRun::entryOf(std::size_t row, RegionId from, int port,
                                 const Scene& scene) const {
  // In the tick before, the proxy was at the wall.
  const Row& before = rows_[row > 0 ? row - 1 : 0];
  RegionEntry entry{.from = from, .to = rows_[row].region, .port = port, .point = before.proxy};
  const FieldPtr& inner = scene.regions()[std::max(entry.from, entry.to)].field;
  if (inner) {
    const Vec3 outward = unitOr(inner->sample(entry.point).gradient, Vec3(0.0));
    entry.normal = entry.from < entry.to ? outward : -outward;
  }
  if (port >= 0 && before.contact) {
    entry.force = glm::length(before.force);
    entry.hole_radius = scene.ports()[static_cast<std::size_t>(port)].hole_radius;
  }
  return entry;
}

void RecordedRun::addUp(const Scene& scene) {
  PassedCounts passed(scene);
  SeenMarks marks(scene);
  RegionId before = scene.startRegion();
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (i > 0 && isFinite(row.hip) && isFinite(rows_[i - 1].hip)) {
      row.work = rows_[i - 1].work + glm::dot(rows_[i - 1].force, row.hip - rows_[i - 1].hip);
    }
    row.worst_ns = std::max(row.ns, i > 0 ? rows_[i - 1].worst_ns : 0);
    row.late = (i > 0 ? rows_[i - 1].late : 0) + (row.is_late ? 1 : 0);
    // If several ports are passed in one tick, the file does not contain the regions between them.
    for (std::size_t k = 0; k < row.events.size() || (k == 0 && row.region != before); ++k) {
      const int port = k < row.events.size() ? row.events[k] : -1;
      const RegionEntry entry = entryOf(i, before, port, scene);
      passed.add(entry);
      marks.add(entry);
      passings_.push_back({i,
                           {++count, row.tick, entry.from, entry.to, port, 0.0},
                           passed.counts(),
                           marks.holes(),
                           marks.fulcrum()});
    }
    before = row.region;
  }
}

FeedView RecordedRun::at(std::size_t row, std::uint64_t seen) const {
  const Row& now = rows_[row];
  FeedView view;
  view.ticks = row + 1;
  view.number = now.tick;
  view.time = now.t;
  view.hip = now.hip;
  view.result.force = now.force;
  view.result.proxy = now.proxy;
  view.result.region = now.region;
  view.result.contact = now.contact;
  view.result.settled = now.settled;
  view.ns = now.ns;
  view.worst_ns = now.worst_ns;
  view.late = now.late;
  view.strongest = glm::length(now.force);
  view.work = now.work;
  view.passed.assign(ports_, 0);
  for (const Passing& passing : passings_) {
    if (passing.row > row) break;
    view.passed = passing.passed;
    view.holes = passing.holes;
    view.fulcrum = passing.fulcrum;
    if (passing.entry.number > seen) view.entries.push_back(passing.entry);
  }
  if (view.entries.size() > LiveFeed::kKept) {
    view.entries.erase(view.entries.begin(),
                       view.entries.end() - static_cast<std::ptrdiff_t>(LiveFeed::kKept));
  }
  return view;
}

std::vector<double> RecordedRun::overview(std::size_t columns) const {
  const std::size_t stretch = (rows_.size() + columns - 1) / columns;
  std::vector<double> most((rows_.size() + stretch - 1) / stretch, 0.0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    most[i / stretch] = std::max(most[i / stretch], glm::length(rows_[i].force));
  }
  return most;
}

}  // namespace palpate::tools
