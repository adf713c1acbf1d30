#pragma once
/// Hand paths: the position of the HIP at each tick; and a device that follows a path.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/devices/device.h"
#include "palpate/export.h"

namespace palpate::devices {

/// One row of a path.
struct PathPoint {
  double t = 0.0;                ///< [s]
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world]; for a recording, in the frame that it names
};
using Path = std::vector<PathPoint>;  ///< in the order of time

/// A path whose rows are computed when they are asked for, so that its size does not depend on its
/// length.
class PathFormula {
 public:
  /// Row i < `last` is `position(i / rate)`, row `last` is `end`; `position` must not allocate,
  /// lock or throw.
  PathFormula(std::size_t last, double rate, const Vec3& end, std::function<Vec3(double)> position)
      : last_(last), rate_(rate), end_(end), position_(std::move(position)) {}

  /// Number of rows, at least 1.
  [[nodiscard]] std::size_t size() const noexcept { return last_ + 1; }
  /// Row `row`, from 0; must be below size(). The last row is the exact end point.
  [[nodiscard]] PathPoint at(std::size_t row) const {
    const double t = static_cast<double>(row) / rate_;
    return {t, row < last_ ? position_(t) : end_};
  }

 private:
  std::size_t last_;
  double rate_;  ///< [Hz]
  Vec3 end_;     ///< [m]
  std::function<Vec3(double)> position_;
};

/// A path out of a file.
struct RecordedPath {
  Path points;                              ///< positions in `frame`
  DeviceFrame frame = DeviceFrame::kWorld;  ///< the frame that the header of the file names
};

/// The rows that a path may contain.
enum class PathRules : std::uint8_t {
  kSound,  ///< finite positions, at increasing times
  /// whatever a device may have reported: positions and times that are not numbers, times that do
  /// not increase
  kAsRecorded,
};

/// CSV with the header `t,x,y,z` (s, m), or `t,device_x,device_y,device_z` for a device's own
/// coordinates (DeviceFrame::kDevice), one row a tick; t must increase. Lines end in LF or CRLF,
/// the last may have no end. Comments, blank lines, spaces, quotes, NaN and infinity are not
/// allowed. The file is read in pieces, so only the path itself takes memory.
/// PathRules::kAsRecorded also allows `nan`, `inf` and `-inf`, and any time.
/// @throws Error (kInput) with file:line:column and the offending line for anything else; codes
/// path.unreadable, .empty, .header, .comment, .blank, .columns, .number, .not_finite, .time.
[[nodiscard]] PALPATE_EXPORT RecordedPath readPath(const std::string& file,
                                                   PathRules rules = PathRules::kSound);

// Generators. Row i is at t = i / rate, exactly; the first row is the start and the last row the
// end point, exactly, at the first sample that is not before the end of the motion. In between,
// each position is given by the formula stated. Set-up only: they allocate. All throw Error
// (kInput, path.parameter) for a value that is not finite or out of its range, and for paths of
// more than 10^8 rows. `rate` is in [Hz], above 0.

/// Straight in to `depth` beyond `surface` against `normal`, hold, and out again. The height above
/// the surface along `normal` is clearance - speed t down to -depth, -depth for `hold`, and then
/// back up to clearance. If hold >= 1 / rate, one row is exactly at the deepest point.
struct PressPath {
  Vec3 surface{0.0, 0.0, 0.0};  ///< [m] where to press
  Vec3 normal{0.0, 0.0, 1.0};   ///< [-] outward, any length but zero
  double depth = 0.002;         ///< [m] 0 or more
  double clearance = 0.005;  ///< [m] of both ends above the surface, 0 or more; not 0 if depth is
  double speed = 0.05;       ///< [m/s] above 0
  double hold = 0.2;         ///< [s] 0 or more
};
[[nodiscard]] PALPATE_EXPORT PathFormula formula(const PressPath& shape,
                                                 double rate);  ///< rate [Hz]
[[nodiscard]] PALPATE_EXPORT Path generate(const PressPath& shape,
                                           double rate);  ///< all of its rows

/// Straight stroke between two points at constant speed, there and back `repeats` times: at the
/// distance |((speed t + L) mod 2 L) - L| from `from`, L = |to - from|. Begins and ends at `from`.
struct StrokePath {
  Vec3 from{0.0, 0.0, 0.0};  ///< [m]
  Vec3 to{0.0, 0.0, 0.0};    ///< [m] not `from`
  double speed = 0.1;        ///< [m/s] above 0
  int repeats = 1;           ///< 1 or more
};
/// The path as rows that are computed when they are asked for, `rate` [Hz] of them in a second.
[[nodiscard]] PALPATE_EXPORT PathFormula formula(const StrokePath& shape, double rate);
[[nodiscard]] PALPATE_EXPORT Path generate(const StrokePath& shape,
                                           double rate);  ///< all of its rows

/// Sinusoidal taps along `normal`, `taps` times from `clearance` above the surface to `depth`
/// below: the height is (clearance - depth) / 2 + (clearance + depth) / 2 cos(2 pi frequency t).
struct TapPath {
  Vec3 surface{0.0, 0.0, 0.0};  ///< [m]
  Vec3 normal{0.0, 0.0, 1.0};   ///< [-] outward, any length but zero
  double depth = 0.002;         ///< [m] 0 or more
  double clearance = 0.005;     ///< [m] 0 or more; not 0 if depth is
  double frequency = 4.0;       ///< [Hz] above 0
  int taps = 4;                 ///< 1 or more
};
/// The path as rows that are computed when they are asked for, `rate` [Hz] of them in a second.
[[nodiscard]] PALPATE_EXPORT PathFormula formula(const TapPath& shape, double rate);
[[nodiscard]] PALPATE_EXPORT Path generate(const TapPath& shape, double rate);  ///< all of its rows

/// Straight through way points at constant speed, there and (if asked) back: the arc length along
/// the polyline is speed t. Ends at the last point, or at the first if `back`. If hold >= 1 / rate,
/// one row is exactly at the far end.
struct InsertPath {
  std::vector<Vec3> points;  ///< [m] two or more, not all the same
  double speed = 0.05;       ///< [m/s] above 0
  double hold = 0.1;         ///< [s] at the far end, 0 or more
  bool back = true;          ///< true: returns along the same way after `hold`
};
/// The path as rows that are computed when they are asked for, `rate` [Hz] of them in a second.
[[nodiscard]] PALPATE_EXPORT PathFormula formula(const InsertPath& shape, double rate);
[[nodiscard]] PALPATE_EXPORT Path generate(const InsertPath& shape,
                                           double rate);  ///< all of its rows

/// Each read() returns one row of the path. The velocity is the backward difference of the rows (0
/// at the first, and where the time does not increase), the time is the row's. After the last row
/// read() answers kEnd and leaves its argument unchanged. While the device is not open, read() and
/// write() answer kDisconnected. open() restarts the path. Its maximum force is kMaxForce, its
/// workspace the bounding box of the path.
class PALPATE_EXPORT VirtualDevice final : public Device {
 public:
  /// [N] A hundred times what desktop devices can hold, so that closed forms are valid in every
  /// sensible scene, and yet a finite limit, as every device has one.
  static constexpr double kMaxForce = 1000.0;

  /// @throws Error (kInput) for an empty path, or for times that do not increase unless `rules`
  /// allow them. Positions are used as they are, so that a NaN from a broken sensor can be played
  /// back.
  explicit VirtualDevice(Path path, DeviceFrame frame = DeviceFrame::kWorld,
                         PathRules rules = PathRules::kSound);

  /// The same for a path that is computed row by row: it takes no memory.
  explicit VirtualDevice(PathFormula formula, DeviceFrame frame = DeviceFrame::kWorld);

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override;
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override;

  /// The last force written [N]; zero before the first and after close().
  [[nodiscard]] const Vec3& lastForce() const noexcept { return force_; }

 private:
  void describe(DeviceFrame frame);
  [[nodiscard]] std::size_t size() const noexcept;
  [[nodiscard]] PathPoint pointAt(std::size_t row) const;

  DeviceInfo info_;
  Path path_;  ///< empty: formula_ is used
  std::optional<PathFormula> formula_;
  std::size_t next_ = 0;
  bool is_open_ = false;
  Vec3 force_{0.0, 0.0, 0.0};
};

}  // namespace palpate::devices
