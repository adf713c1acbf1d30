#pragma once
/// Sheet: the data that the parts of a picture share, and these parts in the order in which they
/// are drawn.

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "picture/canvas.h"
#include "picture/distance_lines.h"
#include "picture/paint.h"
#include "picture/palette.h"
#include "picture/picture.h"
#include "picture/rest_forces.h"
#include "picture/section.h"
#include "text.h"

namespace palpate::tools {

/// One picture while it is drawn. The section is at (left, top); the view in space and the legend
/// are in a column of width `side` on the right. Lengths in pixels of the sheet unless noted.
struct Sheet {
  const Scene& scene;
  const PictureOptions& options;
  LengthUnit unit;
  double scale;  ///< of all sizes that do not scale with the scene: 1 at 1600 x 1000
  Canvas canvas;
  Paint paint;
  CutPlane plane;
  View view;
  Section section;
  double side = 0.0, left = 0.0, top = 0.0;
  std::vector<double> opacity;  ///< by region, for a picture in space; empty: all 1
  double peak = 0.0;            ///< [N] largest force of the track
  std::optional<DistanceLines> lines;
  std::vector<RestForce> felt;           ///< forces on the plane
  double felt_spacing = 0.0;             ///< [m] spacing of those
  bool zoomed = false;                   ///< only the surroundings of the track are in view
  std::vector<std::vector<Pixel>> busy;  ///< lines that names must not cover

  Sheet(const Scene& the_scene, const PictureOptions& the_options)
      : scene(the_scene),
        options(the_options),
        unit{the_scene.lengthUnit(), the_scene.metersPerUnit()},
        scale(std::clamp(std::min(the_options.width / 1600.0, the_options.height / 1000.0), 0.45,
                         4.0)),
        canvas(the_options.width, the_options.height),
        paint(the_options.image, the_scene, the_options.colors) {
    if (the_options.line_spacing > 0.0) lines.emplace(the_scene, the_options.line_spacing);
  }

  [[nodiscard]] double px(double at_full_size) const { return at_full_size * scale; }
  [[nodiscard]] Pixel onSheet(const Pixel& p) const { return {p.x + left, p.y + top}; }
  [[nodiscard]] TextStyle font(double size, const Color& color = kInk) const {
    TextStyle style;
    style.size = px(size);
    style.color = color;
    return style;
  }
};

void drawBoundaries(Sheet& s);  ///< walls, ports, sheets of the section
void drawTrack(Sheet& s);       ///< hand, proxy and forces; sets `peak`
/// Computes the forces on the plane within `box`, as the options say.
void feelPlane(Sheet& s, const Box3& box, const Progress& progress);
/// Draws the results of feelPlane(); `at` maps a point [m] to the sheet, and a pixel is `step` [m]
/// wide.
void drawFelt(Sheet& s, const std::function<Pixel(const Vec3&)>& at, double step);
void drawScaleBar(Sheet& s);  ///< in the lower left corner of `view`
void drawAxes(Sheet& s);      ///< coordinates around the section
void drawNames(Sheet& s);     ///< of regions and ports, where there is room
/// From `y` down in the right column; returns where it ends
double drawLegend(Sheet& s, double y);

}  // namespace palpate::tools
