// The steps of voxels that a hand feels when it strokes over a label: our surface compared with
// those of OpenVDB's topologyToLevelSet, with the same sampler, renderer and path.
//   palpate_scan_stroke LABELS.nii.gz LABEL X FROM TO [SVG]
// strokes in mm (RAS) along z on the front of LABEL, 100 mm/s, a tick a millisecond.

#include <openvdb/tools/TopologyToLevelSet.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "bench/svg.h"
#include "palpate/core/error.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::bench {
namespace {

constexpr double kMm = 1e-3;
constexpr double kStep = 0.1 * kMm;  // the hand's step in a tick
constexpr double kDegree = std::numbers::pi / 180.0;

struct Stroke {
  int label = 0;
  double x = 0.0, from = 0.0, to = 0.0;  // [m]
};

FieldPtr ours(const vdb::Image& image, int label, double voxel) {
  vdb::BakeOptions bake;
  bake.voxel_size = voxel;
  return vdb::gridField(vdb::surfaceFromLabels(image, {.values = {label}}, bake));
}

/// OpenVDB's tool needs cubic voxels, so the label is resampled to cubes of the smallest spacing,
/// by the nearest voxel.
FieldPtr theirs(const vdb::Image& image, int label, double voxel, int smoothing) {
  vdb::initializeOpenVdb();
  openvdb::MaskGrid mask;
  mask.setTransform(openvdb::math::Transform::createLinearTransform(voxel / kMm));
  auto to = mask.getAccessor();
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    box.include(image.toWorld(Vec3((corner & 1) != 0 ? image.size[0] - 1 : 0,
                                   (corner & 2) != 0 ? image.size[1] - 1 : 0,
                                   (corner & 4) != 0 ? image.size[2] - 1 : 0)));
  }
  const Vec3 lo = glm::floor(box.lo / voxel);
  const Vec3 hi = glm::ceil(box.hi / voxel);
  const Mat3 to_index = glm::inverse(image.axes) * voxel;
  const Vec3 first = image.toIndex(Vec3(0.0));
  for (int k = static_cast<int>(lo.z); k <= static_cast<int>(hi.z); ++k) {
    for (int j = static_cast<int>(lo.y); j <= static_cast<int>(hi.y); ++j) {
      for (int i = static_cast<int>(lo.x); i <= static_cast<int>(hi.x); ++i) {
        const Vec3 index = glm::round(first + to_index * Vec3(i, j, k));
        bool is_in = true;
        for (int axis = 0; axis < 3; ++axis) {
          is_in = is_in && index[axis] >= 0.0 &&
                  index[axis] < image.size[static_cast<std::size_t>(axis)];
        }
        if (is_in && image.at(static_cast<int>(index.x), static_cast<int>(index.y),
                              static_cast<int>(index.z)) == static_cast<float>(label)) {
          to.setValueOn({i, j, k});
        }
      }
    }
  }
  constexpr int kHalfWidth = 6;
  constexpr int kClosing = 1;  // the tool's default
  const auto grid = openvdb::tools::topologyToLevelSet(mask, kHalfWidth, kClosing, 0, smoothing);
  return vdb::gridField(vdb::makeLevelSet(grid, "mm"));
}

/// [m] y of the front face at (x, z), searched from far outside; NaN if there is none.
double frontAt(const Field& field, double x, double z) {
  const Box3 box = field.bounds();
  double outside = box.hi.y;
  for (double y = box.hi.y; y > box.lo.y; y -= 0.5 * kMm) {
    if (field.value(Vec3(x, y, z)) >= 0.0) {
      outside = y;
      continue;
    }
    double inside = y;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (inside + outside);
      (field.value(Vec3(x, middle, z)) < 0.0 ? inside : outside) = middle;
    }
    return inside;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// A straight path of the hand, everywhere at least 1 mm below the surface; the same for all
/// surfaces.
std::vector<Vec3> handPath(const Field& field, const Stroke& stroke) {
  const auto count = static_cast<std::size_t>((stroke.to - stroke.from) / kStep);
  const double a = frontAt(field, stroke.x, stroke.from);
  const double b = frontAt(field, stroke.x, stroke.to);
  std::vector<Vec3> path;
  double lift = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const Vec3 p(stroke.x, a + share * (b - a), stroke.from + share * (stroke.to - stroke.from));
    const double front = frontAt(field, p.x, p.z);
    if (!std::isfinite(front)) {
      throw inputError("stroke.none", "the label is not everywhere along this stroke");
    }
    lift = std::min(lift, front - p.y);
    path.push_back(p);
  }
  for (Vec3& p : path) p.y += lift - 1.0 * kMm;
  return path;
}

/// Directions of the force, tick by tick.
std::vector<Vec3> strokeOver(const FieldPtr& field, const std::vector<Vec3>& path) {
  SceneDescription description;
  description.length_unit = "mm";
  description.meters_per_unit = kMm;
  Material bone;
  bone.name = "bone";
  bone.stiffness = 1000.0;
  description.materials = {bone};
  LayerDescription layer;
  layer.name = "bone";
  layer.inside = std::make_shared<FieldSource>(field);
  layer.wall.material = "bone";
  description.layers = {layer};
  const auto renderer = makeRenderer(compile(description));
  // From outside down to the first point, before the measurement begins.
  const Vec3 start = path.front() + Vec3(0.0, 20.0 * kMm, 0.0);
  for (int i = 0; i < 200; ++i) {
    (void)renderer->update({start + (i / 200.0) * (path.front() - start), Vec3(0.0), 1e-3});
  }
  std::vector<Vec3> directions;
  for (const Vec3& p : path) {
    const Vec3 force = renderer->update({p, Vec3(0.0), 1e-3}).force;
    if (glm::length(force) > 0.0) directions.push_back(glm::normalize(force));
  }
  if (directions.size() != path.size()) {
    throw inputError("stroke.lost", "the hand lost the surface on its way");
  }
  return directions;
}

struct Spectrum {
  std::string name;
  double jitter_rms = 0.0, jitter_max = 0.0;  // [degree] second difference from tick to tick
  std::vector<std::pair<double, double>> amplitudes;  // [1/m], [degree]
};

/// Amplitudes of the direction over spatial frequency: with Hann's window, all three components
/// combined.
Spectrum spectrumOf(std::string name, const std::vector<Vec3>& directions) {
  Spectrum result;
  result.name = std::move(name);
  const std::size_t n = directions.size();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double turn =
        glm::length(directions[i + 1] - 2.0 * directions[i] + directions[i - 1]) / kDegree;
    result.jitter_rms += turn * turn / static_cast<double>(n - 2);
    result.jitter_max = std::max(result.jitter_max, turn);
  }
  result.jitter_rms = std::sqrt(result.jitter_rms);
  // A linear change from end to end belongs to the shape, so it is subtracted; Hann's window
  // removes what remains at the ends.
  const Vec3 first = directions.front();
  const Vec3 slope = (directions.back() - first) / static_cast<double>(n - 1);
  std::vector<Vec3> left(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double window = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                               static_cast<double>(n));
    left[i] = (directions[i] - first - static_cast<double>(i) * slope) * window;
  }
  const double length = static_cast<double>(n) * kStep;
  for (std::size_t f = 2; static_cast<double>(f) / length < 3.0 / kMm; ++f) {
    Vec3 real(0.0);
    Vec3 imaginary(0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double phase =
          2.0 * std::numbers::pi * static_cast<double>((f * i) % n) / static_cast<double>(n);
      real += left[i] * std::cos(phase);
      imaginary += left[i] * std::sin(phase);
    }
    // Through Hann's window, a sine of amplitude 1 gives n / 4.
    const double amplitude = 4.0 / static_cast<double>(n) *
                             std::sqrt(glm::dot(real, real) + glm::dot(imaginary, imaginary));
    result.amplitudes.emplace_back(static_cast<double>(f) / length, amplitude / kDegree);
  }
  return result;
}

/// [degree] The largest amplitude from `lo` to `hi` [1/m].
double largest(const Spectrum& spectrum, double lo, double hi) {
  double most = 0.0;
  for (const auto& [frequency, amplitude] : spectrum.amplitudes) {
    if (frequency >= lo && frequency <= hi) most = std::max(most, amplitude);
  }
  return most;
}

std::string plot(const std::vector<Spectrum>& all) {
  const tools::Frame frame{90.0, 860.0, 60.0, 520.0};
  const tools::Axis x = tools::axisFor(0.02, 3.0, frame.left, frame.right);
  const tools::Axis y = tools::axisFor(1.1e-5, 9.0, frame.bottom, frame.top);
  std::string svg = tools::svgPage(900.0, 580.0) +
                    tools::svgText(frame.left, 30.0, "font-size='16'",
                                   "Direction of the force on a stroke over a label") +
                    tools::svgAxes(frame, x, y, "waves per mm", "amplitude, degrees");
  const char* const colors[] = {"#0a6", "#c50", "#37c"};
  for (std::size_t s = 0; s < all.size(); ++s) {
    std::string points;
    for (const auto& [frequency, amplitude] : all[s].amplitudes) {
      points += tools::svgNumber(x.at(std::max(frequency * kMm, 0.0101))) + "," +
                tools::svgNumber(y.at(std::max(amplitude, 1.1e-5))) + " ";
    }
    const std::string color = colors[s % 3];
    svg += "<polyline points='" + points + "' fill='none' stroke='" + color +
           "' stroke-width='1.2'/>\n" +
           tools::svgText(frame.left + 20.0, frame.bottom - 60.0 + 20.0 * static_cast<double>(s),
                          "font-size='13' fill='" + color + "'", all[s].name);
  }
  return svg + "</svg>\n";
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 5) {
    std::fputs("usage: palpate_scan_stroke LABELS.nii.gz LABEL X FROM TO [SVG]\n", stderr);
    return 2;
  }
  const Stroke stroke{std::stoi(arguments[1]), std::stod(arguments[2]) * kMm,
                      std::stod(arguments[3]) * kMm, std::stod(arguments[4]) * kMm};
  const vdb::Image image = vdb::readNifti(arguments[0]);
  double voxel = glm::length(image.axes[0]);
  for (int axis = 1; axis < 3; ++axis) voxel = std::min(voxel, glm::length(image.axes[axis]));
  const double slice = glm::length(image.axes[2]);

  const FieldPtr own = ours(image, stroke.label, voxel);
  const std::vector<Vec3> path = handPath(*own, stroke);
  std::vector<Spectrum> all = {spectrumOf("palpate", strokeOver(own, path))};
  for (const int smoothing : {0, 1}) {
    const FieldPtr other = theirs(image, stroke.label, voxel, smoothing);
    all.push_back(spectrumOf("topologyToLevelSet, smoothed " + std::to_string(smoothing) + " times",
                             strokeOver(other, path)));
  }
  std::printf("%zu ticks of 0.1 mm; voxels %g mm, slices %g mm\n", path.size(), voxel / kMm,
              slice / kMm);
  std::printf("%-38s %12s %12s %14s %14s\n", "surface", "jitter RMS", "max, degree", "at slices",
              "at voxels");
  for (const Spectrum& one : all) {
    std::printf("%-38s %12.2e %12.2e %14.4f %14.4f\n", one.name.c_str(), one.jitter_rms,
                one.jitter_max, largest(one, 0.9 / slice, 1.1 / slice),
                largest(one, 0.9 / voxel, 1.1 / voxel));
  }
  if (arguments.size() > 5) std::ofstream(arguments[5]) << plot(all);
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  try {
    return palpate::bench::run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
