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

/// CSV with the header `t,x,y,z` (s, m), one row a tick; t must rise. Lines end in LF or CRLF, the
/// last may have no end. Nothing else is let in: no comment, blank line, space, quote, NaN or
/// infinity. The file is read in pieces: memory is what the path itself takes.
/// @throws Error (kInput) with file:line:column and the offending line for anything else; codes
/// path.unreadable, .empty, .header, .comment, .blank, .columns, .number, .not_finite, .time.
[[nodiscard]] Path readPath(const std::string& file);

// Generators. Row i is at t = i / rate, exactly; the first row is the start and the last row the end
// point, exactly, at the first sample not before the end of the motion. In between, positions are the
// formula given. Set-up only: they allocate.
// All throw Error (kInput, path.parameter) for a value that is not finite or out of its range, and for
// paths of more than 10^8 rows. `rate` is in [Hz], above 0.

/// Straight in to `depth` beyond `surface` against `normal`, hold, and out again: height above the
/// surface, along `normal`: clearance - speed t down to -depth, -depth for `hold`, and back up to
/// clearance. With hold >= 1 / rate a row is exactly at the deepest point.
struct PressPath {
  Vec3 surface{0.0, 0.0, 0.0};  ///< [m] where to press
  Vec3 normal{0.0, 0.0, 1.0};   ///< [-] outward, any length but zero
  double depth = 0.002;         ///< [m] 0 or more
  double clearance = 0.005;     ///< [m] start and end above the surface, 0 or more; not both zero
  double speed = 0.05;          ///< [m/s] above 0
  double hold = 0.2;            ///< [s] 0 or more
};
[[nodiscard]] Path generate(const PressPath& shape, double rate);  ///< rate [Hz]

/// Straight stroke between two points at constant speed, there and back `repeats` times: at the
/// distance |((speed t + L) mod 2 L) - L| from `from`, L = |to - from|. Begins and ends at `from`.
struct StrokePath {
  Vec3 from{0.0, 0.0, 0.0};  ///< [m]
  Vec3 to{0.0, 0.0, 0.0};    ///< [m] not `from`
  double speed = 0.1;        ///< [m/s] above 0
  int repeats = 1;           ///< 1 or more
};
[[nodiscard]] Path generate(const StrokePath& shape, double rate);

/// Sinusoidal taps along `normal`: from `clearance` above to `depth` below, `taps` times: height
/// (clearance - depth) / 2 + (clearance + depth) / 2 cos(2 pi frequency t).
struct TapPath {
  Vec3 surface{0.0, 0.0, 0.0};  ///< [m]
  Vec3 normal{0.0, 0.0, 1.0};   ///< [-] outward, any length but zero
  double depth = 0.002;         ///< [m] 0 or more
  double clearance = 0.005;     ///< [m] 0 or more; not both zero
  double frequency = 4.0;       ///< [Hz] above 0
  int taps = 4;                 ///< 1 or more
};
[[nodiscard]] Path generate(const TapPath& shape, double rate);

/// Straight through way points at constant speed, there and (if asked) back: at the arc length
/// speed t of the polyline. Ends at the last point, or at the first if `back`. With hold >= 1 / rate a
/// row is exactly at the far end.
struct InsertPath {
  std::vector<Vec3> points;  ///< [m] two or more, not all the same
  double speed = 0.05;       ///< [m/s] above 0
  double hold = 0.1;         ///< [s] at the far end, 0 or more
  bool back = true;
};
[[nodiscard]] Path generate(const InsertPath& shape, double rate);

}  // namespace palpate::devices
