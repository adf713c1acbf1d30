#pragma once
// A one-dimensional needle on the straight way down into data/scenes/slab.yaml, by closed forms,
// with which the constraint renderer is compared. Depths in [m] below the skin; no part of the
// library is used.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace palpate::test {

struct SlabTissue {
  double top, bottom;  // [m]
  double stiffness;    // [N/m] stiffness against which the tip presses before it cuts
  double cutting;      // [N]
  double shaft;        // [N/m^2]
  double in_static, in_kinetic, in_damping;
  double out_static, out_kinetic, out_damping;
};

struct SlabWall {
  double at;          // [m]
  double a1, a2;      // [N/m], [N/m^2]: at depth d the force is a1 d + a2 d^2
  double opens_at;    // [N] the first time
  double reopens_at;  // [N] once it was opened, in both directions
  bool open = false;
};

/// The state: where the tip is, which walls were pierced, how far was cut, and how each tissue
/// holds the shaft.
class SlabModel {
 public:
  std::array<SlabTissue, 3> tissues{{
      {0.000, 0.002, 250.0, 0.50, 1e5, 24, 16, 120, 24, 16, 120},
      {0.002, 0.014, 50.0, 0.15, 4e4, 5, 3, 60, 5, 3, 60},
      {0.014, 0.032, 150.0, 0.60, 1e5, 18, 10, 290, 18, 11, 210},
  }};
  std::array<SlabWall, 3> walls{{
      {0.000, 250.0, 4e4, 2.8, 0.10, false},
      {0.014, 150.0, 0.0, 0.9, 0.05, false},
      {0.032, 150.0, 0.0, 0.7, 0.05, false},
  }};

  double tip = -1.0;      // [m] equal to the hand's depth in air
  double wall_force = 0;  // [N] upward is positive, as for all forces here
  double cut_force = 0;
  double shaft_force = 0;
  int pierced = 0;  // walls that ruptured in the last step

  /// [N] upward, for the hand at `hand` and its downward velocity `speed`.
  double step(double hand, double speed) {
    const double before = tip;
    moveTip(hand);
    if (tip <= 0.0 && hand <= 0.0) {
      std::fill(stretch_.begin(), stretch_.end(), 0.0);
      std::fill(slides_.begin(), slides_.end(), false);
    }
    shaft_force = 0.0;
    for (std::size_t i = 0; i < tissues.size(); ++i) {
      shaft_force += shaft(i, std::max(before, 0.0), speed);
    }
    cut_force = cut();
    return wall_force + cut_force + shaft_force;
  }

 private:
  void moveTip(double hand) {
    pierced = 0;
    wall_force = 0.0;
    double from = tip;
    for (;;) {
      // The first wall between the tip and the hand; a tip on a wall is on the side that it came
      // from.
      int hit = -1;
      const bool down = hand > from;
      for (int i = 0; i < static_cast<int>(walls.size()); ++i) {
        const double at = walls[static_cast<std::size_t>(i)].at;
        const bool between =
            down ? (at >= from && at < hand && side_ <= i) : (at <= from && at > hand && side_ > i);
        if (between && (hit < 0 || (down ? i < hit : i > hit))) hit = i;
      }
      if (hit < 0) {
        tip = hand;
        return;
      }
      SlabWall& wall = walls[static_cast<std::size_t>(hit)];
      const double depth = std::fabs(hand - wall.at);
      const double push = wall.a1 * depth + wall.a2 * depth * depth;
      if (push < (wall.open ? wall.reopens_at : wall.opens_at)) {
        tip = wall.at;
        wall_force = down ? push : -push;
        return;
      }
      wall.open = true;
      ++pierced;
      side_ += down ? 1 : -1;
      from = wall.at;
    }
  }

  // Karnopp's friction with a spring while it sticks, per length of shaft in the tissue.
  double shaft(std::size_t i, double tip_before, double speed) {
    const SlabTissue& t = tissues[i];
    const auto length_at = [&](double depth) { return std::clamp(depth, t.top, t.bottom) - t.top; };
    const double was = length_at(tip_before);
    const double is = length_at(tip);
    double& stretch = stretch_[i];
    if (is <= 0.0) {
      stretch = 0.0;
      slides_[i] = false;
      return 0.0;
    }
    if (is > was) stretch *= was / is;
    stretch += std::max(tip, 0.0) - tip_before;
    const bool in = stretch > 0.0;
    const double held = (in ? t.in_static : t.out_static) / t.shaft;
    const double kinetic = (in ? t.in_kinetic : t.out_kinetic) / t.shaft;
    const double along = in ? speed : -speed;
    if (slides_[i] && along < 1e-3) slides_[i] = false;
    if (std::fabs(stretch) > held) slides_[i] = true;
    double damping = 0.0;
    if (slides_[i]) {
      stretch = std::clamp(stretch, -kinetic, kinetic);
      damping = (in ? t.in_damping : t.out_damping) * speed;
    }
    return is * (t.shaft * stretch + damping);
  }

  // The deepest cut of each tissue; the tip presses on the tissue below that.
  double cut() {
    double force = 0.0;
    for (std::size_t i = 0; i < tissues.size(); ++i) {
      const SlabTissue& t = tissues[i];
      double& end = end_[i];
      end = std::max(end, t.top);
      const bool within = tip > t.top && (tip < t.bottom || (tip == t.bottom && insideLast(i)));
      if (within) {
        const double press = tip - end;
        if (press <= 0.0) continue;
        force = std::min(t.stiffness * press, t.cutting);
        end = std::max(end, tip - t.cutting / t.stiffness);
      } else if (tip >= t.bottom) {
        end = t.bottom;
      }
    }
    return force;
  }
  // True if the tip is on the wall at the bottom of tissue i, and not through it.
  [[nodiscard]] bool insideLast(std::size_t i) const {
    return static_cast<std::size_t>(side_) == (i == 0 ? 1U : i);
  }

  int side_ = 0;  // number of walls above the tip
  std::array<double, 3> stretch_{};
  std::array<bool, 3> slides_{};
  std::array<double, 3> end_{};
};

/// Depths of the hand, tick by tick: down from `from` to `to`, and back, with a rest at both.
inline std::vector<double> thereAndBack(double from, double to, double step, int rest) {
  std::vector<double> out;
  const int n = static_cast<int>(std::lround((to - from) / step));
  for (int i = 0; i <= n; ++i) out.push_back(from + i * step);
  for (int i = 0; i < rest; ++i) out.push_back(out.back());
  for (int i = n; i >= 0; --i) out.push_back(from + i * step);
  for (int i = 0; i < rest; ++i) out.push_back(out.back());
  return out;
}

}  // namespace palpate::test
