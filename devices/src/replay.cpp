#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "palpate/devices/record.h"
#include "row_format.h"

namespace palpate::devices {
namespace {

/// The same bits, or both are not numbers.
bool isSame(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}
bool isSame(const TickRecord::Vector& a, const TickRecord::Vector& b) noexcept {
  return isSame(a[0], b[0]) && isSame(a[1], b[1]) && isSame(a[2], b[2]);
}
template <typename Other>
bool isSame(const Other& a, const Other& b) noexcept {
  return a == b;
}

/// Compares everything that goes into a tick or results from it, but not the columns that a clock
/// or the loop's writing fills.
std::string differences(const TickRecord& a, const TickRecord& b) {
  std::string names;
  const auto look = [&](const auto& left, const auto& right, const char* name) {
    if (isSame(left, right)) return;
    names += (names.empty() ? "" : ", ") + std::string(name);
  };
  look(a.dt, b.dt, "dt");
  look(a.hip, b.hip, "hip");
  look(a.hip_velocity, b.hip_velocity, "hip_velocity");
  look(a.proxy, b.proxy, "proxy");
  look(a.unlimited_force, b.unlimited_force, "unlimited_force");
  look(a.force, b.force, "force");
  look(a.device_force, b.device_force, "device_force");
  look(a.region, b.region, "region");
  look(a.event_count, b.event_count, "event_count");
  look(a.entry_count, b.entry_count, "entry_count");
  look(a.events, b.events, "events");
  look(a.contact, b.contact, "contact");
  look(a.settled, b.settled, "settled");
  look(a.clutch, b.clutch, "clutch");
  look(a.checkpoint, b.checkpoint, "checkpoint");
  return names;
}

/// The distance; infinite if they differ and one of them is not a number.
double apart(const TickRecord::Vector& a, const TickRecord::Vector& b) {
  if (isSame(a, b)) return 0.0;
  const double length = glm::length(vectorOf(a) - vectorOf(b));
  return std::isfinite(length) ? length : std::numeric_limits<double>::infinity();
}

/// Translates numbers of a record to those of a scene.
class Numbers {
 public:
  Numbers(const std::optional<RecordNames>& names, const Scene& scene) {
    if (!names) return;
    regions_ = numbersOf(names->regions, scene.regions());
    ports_ = numbersOf(names->ports, scene.ports());
  }

  void translate(TickRecord& row) const {
    if (regions_) row.region = numberOf(*regions_, row.region);
    if (!ports_) return;
    for (std::size_t n = 0; n < std::min<std::size_t>(row.event_count, row.events.size()); ++n) {
      row.events[n] = numberOf(*ports_, row.events[n]);
    }
  }

 private:
  using List = std::vector<std::uint16_t>;
  /// Stands for a name without a match: compile() refuses scenes with that many regions or ports.
  static constexpr std::uint16_t kNone = 0xffff;

  template <typename Named>
  [[nodiscard]] static List numbersOf(const std::vector<std::string>& names,
                                      std::span<const Named> there) {
    List out;
    for (const std::string& name : names) {
      const auto at = std::find_if(there.begin(), there.end(),
                                   [&](const Named& one) { return one.name == name; });
      out.push_back(at == there.end() ? kNone : static_cast<std::uint16_t>(at - there.begin()));
    }
    return out;
  }
  [[nodiscard]] static std::uint16_t numberOf(const List& list, std::uint16_t number) {
    return number < list.size() ? list[number] : kNone;
  }

  std::optional<List> regions_;
  std::optional<List> ports_;
};

}  // namespace

ReplayReport replay(RecordReader& record, Session& session, DeviceFrame frame, std::uint64_t from,
                    const std::function<bool()>& stops, const std::optional<RecordNames>& names) {
  constexpr std::uint64_t kAskEvery = 1024;
  const Numbers numbers(names, session.scene());
  ReplayReport report;
  TickRecord then;
  while (record.next(then)) {
    if (stops && report.ticks % kAskEvery == 0 && stops()) break;
    const std::uint64_t expected = session.ticks();
    if (then.tick != expected) {
      report.gap = expected;
      break;
    }
    RecordedTick made{.tick = session.step(readingOf(then), frame), .turn = {}};
    made.entry_count = static_cast<std::uint32_t>(session.renderer().entries().size());
    const TickRecord now = rowOf(made);
    ++report.ticks;
    if (then.tick < from) continue;
    numbers.translate(then);
    ++report.compared;
    const std::string what = differences(then, now);
    if (what.empty()) continue;
    ++report.different;
    if (!report.first) report.first = ReplayReport::First{then.tick, then.t, what};
    if (const double force = apart(then.force, now.force); force > report.most_force) {
      report.most_force = force;
      report.most_force_tick = then.tick;
    }
    if (const double proxy = apart(then.proxy, now.proxy); proxy > report.most_proxy) {
      report.most_proxy = proxy;
      report.most_proxy_tick = then.tick;
    }
    if (then.region != now.region) ++report.regions;
    if (then.contact != now.contact) ++report.contacts;
  }
  return report;
}

}  // namespace palpate::devices
