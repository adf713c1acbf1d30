#pragma once
/// A flat cut through a scene: the region of each pixel, and the kinds of lines between regions:
/// walls, absent walls, ports.

#include <vector>

#include "palpate/core/progress.h"
#include "palpate/interior/partition.h"
#include "palpate/scene/scene.h"
#include "picture/canvas.h"
#include "picture/cut_plane.h"

namespace palpate::tools {

/// The part of a plane that a panel of `width` x `height` pixels shows.
struct View {
  CutPlane plane;
  double left = 0.0;  ///< [m] coordinate u of the left edge
  double top = 0.0;   ///< [m] coordinate v of the upper edge
  double step = 1.0;  ///< [m] size of a pixel
  int width = 0;
  int height = 0;

  [[nodiscard]] Vec3 world(double x, double y) const {
    return plane.at(left + x * step, top - y * step);
  }
  /// Position of `p` in the panel, after projection onto the plane.
  [[nodiscard]] Pixel pixel(const Vec3& p) const {
    return {(plane.u(p) - left) / step, (top - plane.v(p)) / step};
  }
};

/// A line between two regions.
struct Boundary {
  enum class Kind {
    kWall,
    kAbsent,
    kPort,     ///< open
    kPressed,  ///< a port that opens when pressed
    kSheet,    ///< a wall within one region
    kNothing,  ///< the continuation of a sheet's surface beyond the sheet
  };
  RegionId a = kOutside;
  RegionId b = kOutside;
  Kind kind = Kind::kWall;
  PortId port = 0;      ///< kPort, kPressed
  bool from_a = false;  ///< the port leads from a to b ...
  bool from_b = false;  ///< ... and back
  std::vector<Pixel> points;

  [[nodiscard]] bool isPort() const { return kind == Kind::kPort || kind == Kind::kPressed; }
  [[nodiscard]] bool sameLine(const Boundary& o) const {
    return a == o.a && b == o.b && kind == o.kind && (!isPort() || port == o.port);
  }
};

struct Section {
  int width = 0;
  int height = 0;
  /// For each pixel's center: the region in the low bits, and above it one bit for each sheet, set
  /// on the sheet's inner side.
  std::vector<std::uint64_t> cells;
  std::vector<Boundary> boundaries;

  [[nodiscard]] std::uint64_t cell(int x, int y) const {
    return cells[static_cast<std::size_t>(x) +
                 static_cast<std::size_t>(width) * static_cast<std::size_t>(y)];
  }
  [[nodiscard]] RegionId at(int x, int y) const {
    return static_cast<RegionId>(cell(x, y) & 0xFFFFU);
  }
};

[[nodiscard]] Section cutSection(const Scene& scene, const View& view, const Progress& progress);

/// Further sheets are not drawn.
inline constexpr std::size_t kMostSheets = 48;

/// Two bits for each sheet: whether the cell `signs` is on its inner side, and whether it is within
/// the sheet's extent.
struct SheetSides {
  std::uint64_t inner = 0;
  std::uint64_t extent = 0;

  /// The sheets that lie between this cell and `other`.
  [[nodiscard]] std::uint64_t crossedTo(const SheetSides& other) const {
    return (inner ^ other.inner) & extent & other.extent;
  }
};
[[nodiscard]] SheetSides sheetSides(const Scene& scene, const Signs& signs);

/// The kind of line between two points in neighboring cells; its points are left empty.
[[nodiscard]] Boundary classify(const Scene& scene, const Signs& here, const Signs& there);

}  // namespace palpate::tools
