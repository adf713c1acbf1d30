#include "palpate/contact/contact_patch.h"

#include <algorithm>
#include <array>
#include <span>

namespace palpate {
namespace {

using Place = std::array<double, 3>;

/// Points on a sphere, one of each pair of opposite ones, as far from each other as possible.
constexpr std::array kFew{
    std::array{-0.655094139, -0.674724839, 0.339997148},
    std::array{-0.916885915, -0.329714473, -0.224963521},
    std::array{0.404235338, 0.645974021, 0.647542551},
    std::array{-0.320858869, 0.830087922, -0.456074148},
    std::array{-0.305312669, -0.001060628, -0.952251568},
    std::array{-0.344378725, 0.827473950, 0.443497640},
    std::array{0.188121768, 0.981757247, 0.027620782},
    std::array{-0.780017524, 0.268043514, -0.565442603},
    std::array{-0.205755798, -0.490851930, 0.846598449},
    std::array{-0.341753223, 0.289716333, 0.894018558},
    std::array{0.858023757, 0.016417038, -0.513347557},
    std::array{0.846161091, -0.528011083, -0.072219836},
};
constexpr std::array kMany{
    std::array{0.071281838, 0.052716611, 0.996062176},
    std::array{0.044390567, -0.864080580, 0.501392291},
    std::array{0.608234317, 0.624581237, -0.489846194},
    std::array{-0.856091119, -0.500351272, -0.129447292},
    std::array{-0.934694004, 0.191544018, -0.299429472},
    std::array{-0.740287761, -0.478314619, -0.472428996},
    std::array{0.055985109, 0.983734611, -0.170680648},
    std::array{0.866500360, -0.490757144, 0.091293765},
    std::array{0.612709588, 0.014086030, -0.790182602},
    std::array{-0.848630713, -0.473788597, 0.235266399},
    std::array{-0.983735262, -0.153030745, -0.094055965},
    std::array{0.643025433, 0.229759343, 0.730567545},
    std::array{-0.261357281, -0.108671689, 0.959105227},
    std::array{0.423926951, -0.732647285, 0.532460230},
    std::array{0.884211834, 0.144744142, 0.444092970},
    std::array{-0.303232642, 0.593039471, 0.745891514},
    std::array{0.647090522, 0.755979384, -0.098838384},
    std::array{-0.848033179, 0.119033925, 0.516401639},
    std::array{-0.826701355, 0.448246105, 0.340059258},
    std::array{0.168173695, -0.850500223, -0.498364303},
    std::array{-0.145364808, -0.443813945, 0.884250109},
    std::array{-0.618987628, 0.754040864, -0.219719575},
    std::array{0.584785182, 0.757677124, 0.289744139},
    std::array{-0.955056606, -0.128684254, 0.267034158},
    std::array{0.450288290, -0.042605247, 0.891866161},
    std::array{-0.493699950, -0.389226207, 0.777665300},
    std::array{-0.376400131, 0.912399463, 0.160779857},
    std::array{-0.325906347, -0.339733149, -0.882250781},
    std::array{-0.531596868, 0.702439940, 0.473268318},
    std::array{0.494699195, -0.421277648, 0.760130153},
    std::array{-0.301810836, 0.931589281, -0.202612020},
    std::array{-0.362000515, 0.238088696, 0.901259896},
    std::array{0.034169415, -0.391565912, -0.919515409},
    std::array{-0.630645045, 0.384400334, 0.674183366},
    std::array{-0.262365356, -0.707382443, 0.656334137},
    std::array{-0.777087952, -0.275509240, 0.565887774},
    std::array{-0.975312473, 0.196400792, 0.100956964},
    std::array{0.180117246, -0.289880372, 0.939961248},
    std::array{0.153025697, -0.628583405, 0.762539205},
    std::array{0.089641358, 0.679883445, 0.727820670},
    std::array{0.350365714, 0.934569332, 0.061838741},
    std::array{-0.743347711, 0.147853006, -0.652360076},
    std::array{-0.737666617, 0.485605969, -0.469078676},
    std::array{-0.364424824, -0.868819182, 0.335183199},
    std::array{-0.018487895, 0.982765980, 0.183927232},
    std::array{0.241859596, 0.866689036, 0.436295830},
    std::array{-0.681724038, 0.718635647, 0.137168302},
    std::array{0.448836110, 0.611958838, 0.651193156},
};
/// Patch radius in units of the contrast: up to here few places resolve a step of the map evenly;
/// from twice this radius on, many places are needed.
constexpr double kEvenInFew = 8.0;

struct Radius {
  double value = 0.0;  // [m]
  double slope = 0.0;  // [-] derivative by the depth
};

Radius radiusAt(double depth, double contrast) noexcept {
  const double point = 0.5 * contrast;
  const double more = depth - point;
  if (!(more > 0.0)) return {};
  // Quadratic at first, so that the force has no step.
  return {more * more / depth, more * (more + 2.0 * point) / (depth * depth)};
}

/// Mean of the map over some places, with derivatives by the middle, by the direction of the press
/// and by the radius.
struct Mean {
  double value = 0.0;
  Vec3 by_place{0.0, 0.0, 0.0};
  Vec3 by_direction{0.0, 0.0, 0.0};
  double by_radius = 0.0;
};

Mean meanOver(std::span<const Place> places, const Parameter& map, const Vec3& middle,
              const Vec3& u, double radius) noexcept {
  Mean out;
  for (const Place& each : places) {
    const Vec3 place(each[0], each[1], each[2]);
    const double along = glm::dot(u, place);
    const Vec3 off = place - along * u;
    for (const double side : {1.0, -1.0}) {
      const MaterialMap::Sample s = map.sample(middle + (side * radius) * off);
      out.value += s.value;
      out.by_place += s.gradient;
      out.by_radius += side * glm::dot(s.gradient, off);
      out.by_direction -= side * (along * s.gradient + glm::dot(s.gradient, u) * place);
    }
  }
  const double share = 0.5 / static_cast<double>(places.size());
  return {share * out.value, share * out.by_place, (share * radius) * out.by_direction,
          share * out.by_radius};
}

/// The mix of `a` and `b` with the share `of_b` of `b`.
Mean blend(const Mean& a, const Mean& b, double of_b) noexcept {
  const double of_a = 1.0 - of_b;
  return {of_a * a.value + of_b * b.value, of_a * a.by_place + of_b * b.by_place,
          of_a * a.by_direction + of_b * b.by_direction, of_a * a.by_radius + of_b * b.by_radius};
}

}  // namespace

double patchRadius(double depth, double contrast) noexcept {
  return radiusAt(depth, contrast).value;
}

PatchSample overPatch(const Parameter& map, const Vec3& middle, const Vec3& press,
                      double contrast) noexcept {
  const double depth = glm::length(press);
  const Radius radius = radiusAt(depth, contrast);
  if (!(radius.value > 0.0)) {
    const MaterialMap::Sample s = map.sample(middle);
    return {s.value, s.gradient, Vec3(0.0)};
  }
  const Vec3 u = press / depth;
  const double wide = kEvenInFew * contrast;
  const double more = std::clamp((radius.value - wide) / wide, 0.0, 1.0);
  Mean mean;
  if (more < 1.0) mean = meanOver(kFew, map, middle, u, radius.value);
  if (more > 0.0) {
    const Mean many = meanOver(kMany, map, middle, u, radius.value);
    const double change = (many.value - mean.value) * 6.0 * more * (1.0 - more) / wide;
    mean = more < 1.0 ? blend(mean, many, more * more * (3.0 - 2.0 * more)) : many;
    if (more < 1.0) mean.by_radius += change;
  }
  const Vec3 across = mean.by_direction - glm::dot(mean.by_direction, u) * u;
  return {mean.value, mean.by_place, across / depth + (mean.by_radius * radius.slope) * u};
}

}  // namespace palpate
