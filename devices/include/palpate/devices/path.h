#pragma once
/// Hand paths: where the HIP is, tick by tick.

#include <string>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::devices {

struct PathPoint {
  double t = 0.0;                ///< [s]
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world]
};
using Path = std::vector<PathPoint>;

/// CSV with the header `t,x,y,z` (s, m), one row a tick; t must rise. @throws Error (kInput) with
/// file:line for anything else.
[[nodiscard]] Path readPath(const std::string& file);

/// Straight in to `depth` beyond `surface` against `normal`, hold, and out again.
struct PressPath {
  Vec3 surface;                  ///< [m] where to press
  Vec3 normal{0.0, 0.0, 1.0};    ///< [-] outward
  double depth = 0.002;          ///< [m]
  double clearance = 0.005;      ///< [m] start and end above the surface
  double speed = 0.05;           ///< [m/s]
  double hold = 0.2;             ///< [s]
};
[[nodiscard]] Path generate(const PressPath& shape, double rate);  ///< rate [Hz]

/// Straight stroke between two points at constant speed, there and back `repeats` times.
struct StrokePath {
  Vec3 from;               ///< [m]
  Vec3 to;                 ///< [m]
  double speed = 0.1;      ///< [m/s]
  int repeats = 1;
};
[[nodiscard]] Path generate(const StrokePath& shape, double rate);

/// Sinusoidal taps along `normal`: from `clearance` above to `depth` below, `taps` times.
struct TapPath {
  Vec3 surface;                  ///< [m]
  Vec3 normal{0.0, 0.0, 1.0};    ///< [-] outward
  double depth = 0.002;          ///< [m]
  double clearance = 0.005;      ///< [m]
  double frequency = 4.0;        ///< [Hz]
  int taps = 4;
};
[[nodiscard]] Path generate(const TapPath& shape, double rate);

/// Straight through way points at constant speed, there and (if asked) back.
struct InsertPath {
  std::vector<Vec3> points;  ///< [m] two or more
  double speed = 0.05;       ///< [m/s]
  double hold = 0.1;         ///< [s] at the far end
  bool back = true;
};
[[nodiscard]] Path generate(const InsertPath& shape, double rate);

}  // namespace palpate::devices
