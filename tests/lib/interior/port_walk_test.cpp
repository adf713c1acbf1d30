// Random walks through random mazes of chambers, rings, valves, sheets and holes, at the level of
// the port machine, against a second machine written only from the rules in the scene file's
// documentation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <optional>
#include <random>

#include "palpate/fields/primitives.h"
#include "palpate/interior/port_machine.h"

namespace palpate::test {
namespace {

constexpr int kMasks = 4;
constexpr int kSheets = 2;

/// A port in the author's terms.
struct Told {
  std::vector<int> a;  ///< the first of `between`
  std::vector<int> b;
  int sheet = -1;
  int on = -1;     ///< leaf
  int where = -1;  ///< mask
  char direction = 'b';
  std::vector<std::pair<int, int>> after;  ///< port, times
  double opens_at = 0.0;
  double back = 0.0;
  double hole = 0.0;  ///< radius
  double reopens_at = 0.0;
};

/// The kind of wall in front of the probe.
struct Verdict {
  /// w: wall, n: nothing there, a: absent, o: open port, f: wall that gives way to a force
  char what = 'w';
  int port = -1;
  bool inward = false;
  double force = 0.0;
};

/// The rules.
class Rules {
 public:
  std::vector<Told> ports;
  std::vector<std::vector<bool>> absent;
  bool keep = false;

  void start() {
    passings.assign(ports.size(), {});
    kept.assign(ports.size(), 0);
    holes.clear();
  }

  [[nodiscard]] Verdict look(int from, int to, int leaf, const std::vector<bool>& masks,
                             double x) const {
    if (absent[static_cast<std::size_t>(from)][static_cast<std::size_t>(to)]) return {'a'};
    Verdict best;
    for (std::size_t i = 0; i < ports.size(); ++i) {
      const Told& p = ports[i];
      if (p.sheet >= 0 || (p.on >= 0 && p.on != leaf)) continue;
      const bool forth = has(p.a, from) && has(p.b, to) && p.direction != 'o';
      const bool back = has(p.b, from) && has(p.a, to) && p.direction != 'i';
      if (!forth && !back) continue;
      // If both hold (globs), the direction towards the inner region is in.
      const bool inward = forth && (!has(p.a, to) || !has(p.b, from) || from < to);
      if (offer(static_cast<int>(i), forth, inward, masks, x, best)) return best;
    }
    return best;
  }

  [[nodiscard]] Verdict lookAtSheet(int sheet, bool inward, const std::vector<bool>& masks,
                                    double x) const {
    Verdict best;
    for (std::size_t i = 0; i < ports.size(); ++i) {
      if (ports[i].sheet != sheet || ports[i].direction == (inward ? 'o' : 'i')) continue;
      if (offer(static_cast<int>(i), inward, inward, masks, x, best)) return best;
    }
    return best;
  }

  void pass(const Verdict& way, int from, int to, double x) {
    const auto port = static_cast<std::size_t>(way.port);
    if (way.what == 'f' && ports[port].hole > 0.0 && holeOf(way.port, x) == nullptr) {
      holes.push_back({way.port, x, ports[port].hole, ports[port].reopens_at});
      if (holes.size() > 32) holes.pop_front();
    }
    if (keep) {
      ++kept[port];
    } else if (to == 0 && from != to) {
      for (auto& standing : passings) standing.clear();
    } else if (!passings[port].empty() && passings[port].back() != way.inward) {
      passings[port].pop_back();
    } else {
      passings[port].push_back(way.inward);
    }
  }

  void drift(int from, int to) {
    if (keep) return;
    for (std::size_t i = 0; i < ports.size(); ++i) {
      const Told& p = ports[i];
      std::vector<bool>& standing = passings[i];
      if (to == 0) {
        standing.clear();
        continue;
      }
      if (standing.empty() || p.sheet >= 0) continue;
      // Whether it was passed from `to` to `from`.
      const bool forth = has(p.a, to) && has(p.b, from) && p.direction != 'o';
      const bool back = has(p.b, to) && has(p.a, from) && p.direction != 'i';
      if (!forth && !back) continue;
      const bool inward = forth && (!has(p.a, from) || !has(p.b, to) || to < from);
      if (standing.back() == inward) standing.pop_back();
    }
  }

  [[nodiscard]] long timesOf(int port) const {
    const auto i = static_cast<std::size_t>(port);
    return keep ? kept[i] : static_cast<long>(passings[i].size());
  }

 private:
  struct Made {
    int port;
    double x, radius, reopens_at;
  };

  static bool has(const std::vector<int>& side, int region) {
    return std::find(side.begin(), side.end(), region) != side.end();
  }
  [[nodiscard]] const Made* holeOf(int port, double x) const {
    for (const Made& hole : holes) {
      if (hole.port == port && std::fabs(hole.x - x) <= hole.radius) return &hole;
    }
    return nullptr;
  }
  /// Takes a port into account; true if it stands open: the first such port decides.
  bool offer(int port, bool is_way_in, bool inward, const std::vector<bool>& masks, double x,
             Verdict& best) const {
    const Told& p = ports[static_cast<std::size_t>(port)];
    if (p.where >= 0 && !masks[static_cast<std::size_t>(p.where)]) return false;
    for (const auto& [before, times] : p.after) {
      if (timesOf(before) < times) return false;
    }
    double force = is_way_in ? p.opens_at : p.back;
    if (const Made* hole = holeOf(port, x)) force = std::min(force, hole->reopens_at);
    if (force == 0.0) {
      best = {'o', port, inward, 0.0};
      return true;
    }
    if (best.what != 'f' || force < best.force) best = {'f', port, inward, force};
    return false;
  }

  std::vector<std::vector<bool>> passings;  ///< by port: passings that count
  std::vector<long> kept;
  std::deque<Made> holes;
};

class Maze {
 public:
  explicit Maze(std::uint64_t seed) : random_(seed) {
    regions_ = 3 + pick(6);
    rules_.keep = pick(5) == 0;
    rules_.absent.assign(static_cast<std::size_t>(regions_),
                         std::vector<bool>(static_cast<std::size_t>(regions_), false));
    for (int a = 0; a < regions_; ++a) {
      for (int b = 0; b < regions_; ++b) {
        if (a != b && pick(12) == 0) rules_.absent[at(a)][at(b)] = true;
      }
    }
    const int count = 1 + pick(14);
    for (int i = 0; i < count; ++i) rules_.ports.push_back(told(i));
    rules_.start();
    build();
  }

  /// One attempt of the probe to pass a wall. False if the two machines differ.
  bool tick() {
    const double x = 0.25 * pick(40);
    std::vector<bool> masks;
    Signs here(leaves_);
    for (int m = 0; m < kMasks; ++m) {
      masks.push_back(pick(3) != 0);
      here.set(static_cast<LeafId>(regions_ - 1 + m), masks.back());
    }
    const Vec3 point(x, 0, 0);
    const double push = pick(7);
    Verdict expected;
    Facet facet;
    int to = region_;
    if (pick(5) == 0) {
      const int sheet = pick(kSheets);
      const bool inward = pick(2) == 0;
      const auto leaf = static_cast<LeafId>(regions_ - 1 + kMasks + sheet);
      here.set(leaf, !inward);
      Signs there = here;
      there.flip(leaf);
      expected = rules_.lookAtSheet(sheet, inward, masks, x);
      const auto region = static_cast<RegionId>(region_);
      facet = passages_.facet(*partition_, region, region, here, there, std::array{leaf}, passed_,
                              point, &punctures_);
    } else {
      while (to == region_) to = pick(regions_);
      const int leaf = std::max(pick(3) == 0 ? pick(regions_) : std::max(region_, to), 1) - 1;
      expected = rules_.look(region_, to, leaf, masks, x);
      facet = passages_.facet(*partition_, static_cast<RegionId>(region_),
                              static_cast<RegionId>(to), here, here,
                              std::array{static_cast<LeafId>(leaf)}, passed_, point, &punctures_);
    }
    if (!isSame(expected, facet)) return false;
    move(expected, facet, to, push, point);
    return isSameMemory();
  }

  [[nodiscard]] long crossings() const { return crossings_; }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  int pick(int below) { return static_cast<int>(random_() % static_cast<std::uint64_t>(below)); }

  std::vector<int> side() {
    std::vector<int> out{pick(regions_)};
    while (pick(4) == 0) out.push_back(pick(regions_));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  Told told(int index) {
    Told port;
    if (pick(8) == 0) {
      port.sheet = pick(kSheets);
    } else {
      port.a = side();
      port.b = side();
      if (pick(4) == 0) port.on = pick(regions_ - 1);
    }
    if (pick(4) == 0) port.where = pick(kMasks);
    port.direction = "bio"[pick(3)];
    for (int before = 0; before < index; ++before) {
      if (pick(index + 3) == 0) port.after.emplace_back(before, 1 + (pick(3) == 0 ? pick(4) : 0));
    }
    if (pick(3) == 0) {
      port.opens_at = pick(6);
      port.back = pick(6);
      port.hole = pick(2) * 0.3 * pick(4);
      port.reopens_at = pick(3);
    }
    return port;
  }

  void build() {
    std::vector<FieldPtr> layers;
    std::vector<FieldPtr> masks;
    for (int i = 1; i < regions_; ++i) layers.push_back(sphere(Vec3(i, 0, 0), 0.1));
    for (int m = 0; m < kMasks + kSheets; ++m) {
      masks.push_back(halfSpace(Vec3(0, 0, m), Vec3(0, 0, 1)));
    }
    partition_.emplace(layers, masks);
    leaves_ = partition_->leaves().size();
    std::vector<Wall> walls(at(regions_) * at(regions_));
    for (int a = 0; a < regions_; ++a) {
      for (int b = 0; b < regions_; ++b) {
        walls[at(a) * at(regions_) + at(b)].absent = rules_.absent[at(a)][at(b)];
      }
    }
    std::vector<Sheet> sheets(kSheets);
    for (int s = 0; s < kSheets; ++s) {
      sheets[at(s)].solid = kMasks + s;
      sheets[at(s)].leaves = {static_cast<LeafId>(regions_ - 1 + kMasks + s)};
    }
    std::vector<Port> ports;
    for (const Told& given : rules_.ports) {
      Port port;
      for (const int region : given.a) port.from.push_back(static_cast<RegionId>(region));
      for (const int region : given.b) port.to.push_back(static_cast<RegionId>(region));
      port.sheet = given.sheet;
      if (given.on >= 0) port.on = {static_cast<LeafId>(given.on)};
      port.mask = given.where;
      port.direction = given.direction == 'b'   ? PortDirection::kBoth
                       : given.direction == 'i' ? PortDirection::kIn
                                                : PortDirection::kOut;
      for (const auto& [before, times] : given.after) {
        port.after.emplace_back(static_cast<PortId>(before), times);
      }
      port.opens_at = given.opens_at;
      port.back = given.back;
      port.hole_radius = given.hole;
      port.reopens_at = given.reopens_at;
      ports.push_back(std::move(port));
    }
    passages_ = Passages(at(regions_), std::move(walls), std::move(ports), std::move(sheets));
  }

  [[nodiscard]] static bool isSame(const Verdict& expected, const Facet& facet) {
    switch (expected.what) {
      case 'a':
        return facet.kind == Facet::Kind::kAbsent;
      case 'o':
        return facet.kind == Facet::Kind::kOpen && facet.port == expected.port;
      case 'f':
        return facet.isClosed() && facet.opens && facet.port == expected.port &&
               facet.opens_at == expected.force;
      default:
        return facet.isClosed() && !facet.opens;
    }
  }

  void move(const Verdict& way, const Facet& facet, int to, double push, const Vec3& point) {
    if (way.what == 'w' || (way.what == 'f' && push < way.force)) return;
    ++crossings_;
    const auto a = static_cast<RegionId>(region_);
    const auto b = static_cast<RegionId>(to);
    if (way.what == 'a') {
      rules_.drift(region_, to);
      passages_.arrive(passed_, a, b, rules_.keep);
    } else {
      rules_.pass(way, region_, to, point.x);
      passages_.pass(passed_, facet.port, facet.inward, a, b, rules_.keep);
      if (facet.opens) punctures_.puncture(facet.port, passages_.ports()[facet.port], point);
    }
    region_ = to;
  }

  [[nodiscard]] bool isSameMemory() const {
    for (std::size_t i = 0; i < rules_.ports.size(); ++i) {
      const int slot = passages_.ports()[i].slot;
      if (slot >= 0 && passed_.times(at(slot)) != rules_.timesOf(static_cast<int>(i))) return false;
    }
    return true;
  }

  std::mt19937_64 random_;
  int regions_ = 0;
  Rules rules_;
  std::optional<Partition> partition_;
  std::size_t leaves_ = 0;
  Passages passages_;
  PassedPorts passed_;
  Punctures punctures_;
  int region_ = 0;
  long crossings_ = 0;
};

TEST(PortWalk, RandomMazesAgreeWithTheRulesAsWritten) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const std::uint64_t mazes = slow ? 2000 : 100;
  const int ticks = slow ? 50'000 : 3'000;  // 10^8 in all
  long crossings = 0;
  for (std::uint64_t seed = 0; seed < mazes; ++seed) {
    Maze maze(seed);
    for (int i = 0; i < ticks; ++i) ASSERT_TRUE(maze.tick()) << "maze " << seed << ", tick " << i;
    crossings += maze.crossings();
  }
  std::printf("  %llu mazes, %d ticks each, %ld crossings: no difference\n",
              static_cast<unsigned long long>(mazes), ticks, crossings);
  EXPECT_GT(crossings, static_cast<long>(mazes) * ticks / 20);
}

}  // namespace
}  // namespace palpate::test
