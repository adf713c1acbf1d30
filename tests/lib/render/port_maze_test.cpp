// Random walks through mazes of nine chambers, felt by both renderers, against a machine written
// only from the rules in the scene file's documentation: where a wall lets the probe through, to
// which region, and by which port.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>
#include <random>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

constexpr double kCell = 40.0;  // [mm] width of a chamber, 3 x 3 of them
constexpr int kOut = -1;

struct Door {
  std::string name;
  int a = kOut, b = kOut;  ///< chamber numbers, or outside
  int half = 0;            ///< 1: where z > 0 only; -1: where z < 0; 0: everywhere
  char direction = 'b';
  std::vector<std::pair<std::string, int>> after;
  double force = 0.0;  ///< [N]
  bool has_hole = false;
};

/// Chamber of column x and row y, 0 to 8; outside beyond.
int chamberAt(int x, int y) { return x < 0 || x > 2 || y < 0 || y > 2 ? kOut : 3 * y + x; }
std::string nameOf(int chamber) {
  return chamber == kOut ? "outside" : "c" + std::to_string(chamber);
}

class Maze {
 public:
  Maze(std::uint64_t seed, RendererKind kind) : random_(seed) {
    keep_ = pick(5) == 0;
    int number = 0;
    const auto wall = [&](int a, int b) {
      for (int more = 0; more < 2; ++more) {
        if (pick(3) == 0) continue;
        Door door;
        door.name = "p" + std::to_string(number++);
        door.a = a;
        door.b = b;
        door.half = pick(3) - 1;
        door.direction = "bbio"[pick(4)];
        for (const Door& before : doors_) {
          if (pick(24) == 0) door.after.emplace_back(before.name, 1 + pick(2));
        }
        if (kind == RendererKind::kConstraint && pick(4) == 0) {
          door.force = 1.0 + pick(8);
          door.has_hole = pick(2) == 0;
        }
        doors_.push_back(std::move(door));
      }
    };
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        if (x < 2) wall(chamberAt(x, y), chamberAt(x + 1, y));
        if (y < 2) wall(chamberAt(x, y), chamberAt(x, y + 1));
        if (x == 0 || x == 2 || y == 0 || y == 2) wall(kOut, chamberAt(x, y));
      }
    }
    scene_ = sceneOf(text());
    drive_ = std::make_unique<Drive>(scene_, kind);
    (void)drive_->to(place());
  }

  /// Tries the wall on one side of the probe's chamber. Counts the ticks.
  void leg() {
    const int direction = pick(4);
    const int nx = x_ + (direction == 0) - (direction == 1);
    const int ny = y_ + (direction == 2) - (direction == 3);
    if (nx < -1 || nx > 3 || ny < -1 || ny > 3) return;
    z_ = pick(2) == 0 ? 8.0 : -8.0;
    off_ = 5.0 * (pick(3) - 1);
    across_ = direction < 2 ? 1 : 0;
    go(place());
    const int from = chamberAt(x_, y_);
    const int to = chamberAt(nx, ny);
    const std::string door = from == to ? std::string() : through(from, to);
    const bool is_refused = from != to && door.empty();
    const int old_x = x_;
    const int old_y = y_;
    x_ = nx;
    y_ = ny;
    go(place());
    ASSERT_EQ(drive_->events(), door) << "from " << nameOf(from) << " to " << nameOf(to);
    ASSERT_EQ(drive_->region(), nameOf(is_refused ? from : to));
    ASSERT_EQ(drive_->last().contact, is_refused);
    if (!is_refused) return;
    x_ = old_x;
    y_ = old_y;
    go(place());
    ASSERT_EQ(drive_->events(), "");
    ASSERT_EQ(drive_->region(), nameOf(from));
    ASSERT_FALSE(drive_->last().contact);
  }
  [[nodiscard]] long ticks() const { return ticks_; }
  [[nodiscard]] long passings() const { return passings_; }

 private:
  int pick(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }

  [[nodiscard]] Vec3 place() const {
    return mm(kCell * (x_ - 1) + (across_ == 0 ? off_ : 0.0),
              kCell * (y_ - 1) + (across_ == 1 ? off_ : 0.0), z_);
  }
  void go(const Vec3& to) {
    const Vec3 from = drive_->hip();
    constexpr int kSteps = 5;
    for (int i = 1; i <= kSteps; ++i) (void)drive_->to(glm::mix(from, to, double(i) / kSteps));
    ticks_ += kSteps;
  }

  /// The rules: returns the name of the port that lets the probe through here and now, and applies
  /// its effect.
  std::string through(int from, int to) {
    const Door* best = nullptr;
    double least = 0.0;
    for (const Door& door : doors_) {
      const bool forth = door.a == from && door.b == to;
      const bool back = door.b == from && door.a == to;
      if (!(forth && door.direction != 'o') && !(back && door.direction != 'i')) continue;
      if (door.half * z_ < 0.0) continue;
      bool is_due = true;
      for (const auto& [before, times] : door.after) {
        is_due = is_due && std::abs(net_[before]) >= times;
      }
      if (!is_due) continue;
      double force = door.force;
      if (std::find(holes_.begin(), holes_.end(), spotOf(door)) != holes_.end()) force = 0.0;
      // The first port that is open; if none is, the one that opens first.
      if (best == nullptr || (least > 0.0 && force < least)) {
        best = &door;
        least = force;
      }
      if (force == 0.0) break;
    }
    if (best == nullptr) return {};
    ++passings_;
    if (least > 0.0 && best->has_hole) holes_.push_back(spotOf(*best));
    if (holes_.size() > 32) holes_.pop_front();  // the oldest one is forgotten
    if (keep_) {
      ++net_[best->name];
    } else if (to == kOut) {
      net_.clear();
    } else {
      net_[best->name] += best->a == from ? 1 : -1;
    }
    return best->name;
  }
  /// Places on a wall are at least 5 mm apart, and holes are 1 mm wide.
  [[nodiscard]] std::string spotOf(const Door& door) const {
    return door.name + " " + std::to_string(off_) + " " + std::to_string(z_);
  }

  [[nodiscard]] std::string text() const {
    std::string out = "palpate: 1\nlength: mm\n";
    if (keep_) out += "memory: keep\n";
    out +=
        "fields:\n  hull: {box: {center: [0, 0, 0], size: [120, 120, 40]}}\n"
        "  upper: {half_space: {point: [0, 0, 0], normal: [0, 0, -1]}}\n";
    for (const auto& [axis, normal] : {std::pair("x", "[1, 0, 0]"), std::pair("y", "[0, 1, 0]")}) {
      for (const int side : {0, 1}) {
        const std::string at = side == 0 ? "-20" : "20";
        out += "  " + std::string(axis) + std::to_string(side) + ": {half_space: {point: [" + at +
               ", " + at + ", 0], normal: " + normal + "}}\n";
      }
    }
    out += "layers:\n";
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        out += "  - {name: " + nameOf(chamberAt(x, y)) + ", inside: {intersection: [hull";
        if (x < 2) out += ", x" + std::to_string(x);
        if (x > 0) out += ", {complement: x" + std::to_string(x - 1) + "}";
        if (y < 2) out += ", y" + std::to_string(y);
        if (y > 0) out += ", {complement: y" + std::to_string(y - 1) + "}";
        out += "]}}\n";
      }
    }
    out += "ports:\n";
    for (const Door& door : doors_) {
      out +=
          "  - {name: " + door.name + ", between: [" + nameOf(door.a) + ", " + nameOf(door.b) + "]";
      if (door.half > 0) out += ", where: upper";
      if (door.half < 0) out += ", where: {complement: upper}";
      if (door.direction != 'b')
        out += std::string(", direction: ") + (door.direction == 'i' ? "in" : "out");
      if (!door.after.empty()) {
        out += ", after: [";
        for (const auto& [before, times] : door.after) {
          if (out.back() != '[') out += ", ";
          out +=
              times == 1 ? before : "{port: " + before + ", times: " + std::to_string(times) + "}";
        }
        out += "]";
      }
      if (door.force > 0.0) out += ", opens_at: " + std::to_string(door.force) + " N";
      if (door.has_hole) out += ", hole: {radius: 1}";
      out += "}\n";
    }
    return out;
  }

  std::mt19937_64 random_;
  std::vector<Door> doors_;
  bool keep_ = false;
  ScenePtr scene_;
  std::unique_ptr<Drive> drive_;
  std::map<std::string, int> net_;
  std::deque<std::string> holes_;
  int x_ = -1;
  int y_ = -1;
  int across_ = 0;
  double off_ = 0.0;
  double z_ = 8.0;
  long ticks_ = 0;
  long passings_ = 0;
};

class PortMaze : public testing::TestWithParam<RendererKind> {};
INSTANTIATE_TEST_SUITE_P(Renderers, PortMaze,
                         testing::Values(RendererKind::kPaper, RendererKind::kConstraint),
                         kindName);

TEST_P(PortMaze, EveryLegEndsWhereTheRulesSay) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int mazes = slow ? 40 : 6;
  const int legs = slow ? 5'000 : 250;  // some 12 ticks each: 10^6 in all, and more
  long ticks = 0;
  long passings = 0;
  for (int seed = 0; seed < mazes; ++seed) {
    Maze maze(static_cast<std::uint64_t>(seed), GetParam());
    for (int i = 0; i < legs && !HasFatalFailure(); ++i) maze.leg();
    ASSERT_FALSE(HasFatalFailure()) << "maze " << seed;
    ticks += maze.ticks();
    passings += maze.passings();
  }
  std::printf("  %d mazes, %ld ticks, %ld ports passed: no difference\n", mazes, ticks, passings);
  EXPECT_GT(passings, 20L * mazes);
}

}  // namespace
}  // namespace palpate::test
