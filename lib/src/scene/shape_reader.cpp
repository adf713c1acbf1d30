#include "scene/shape_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "palpate/core/text.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "scene/messages.h"

namespace palpate {
namespace {

using Make = std::function<FieldPtr()>;
using Reader = const MapReader&;

/// A function that calls `make` with these values when the shape is asked for.
template <typename Function, typename... Values>
Make later(Function make, Values... values) {
  return [=] { return make(values...); };
}

/// The value at `key`, which may be at most `most`; `why` names that limit in messages.
double valueUpTo(Reader reader, std::string_view key, double most, const std::string& why,
                 const std::string& hint) {
  const double value = reader.value(key);
  // Halves and fifths of decimal numbers are not exact in binary.
  if (value <= most * (1.0 + 1e-12)) return std::min(value, most);
  throw reader.errorAt(
      key, "scene.range",
      inQuotes(key) + " must not be more than " + why + ", " + inUnitOf(reader.loader(), most),
      hint);
}

Make roundedBoxOf(Reader r) {
  const Vec3 size = r.point("size");
  const double rounding =
      valueUpTo(r, "rounding", 0.5 * std::min({size.x, size.y, size.z}),
                "half of the smallest 'size'", "a box rounded that far is a capsule or a ball");
  return later(roundedBox, r.point("center"), size, rounding);
}

Make torusOf(Reader r) {
  const double radius = r.value("radius");
  const double tube = r.value("tube");
  if (!(tube < radius)) {
    throw r.errorAt("tube", "scene.range",
                    "'tube' must be less than 'radius', " + inUnitOf(r.loader(), radius),
                    "the radius is from the center to the middle of the tube");
  }
  return later(torus, r.point("center"), r.point("axis"), radius, tube);
}

Make capsuleOf(Reader r) {
  const Vec3 from = r.point("from");
  const Vec3 to = r.point("to");
  if (from == to) {
    throw r.errorAt("to", "scene.range", "'from' and 'to' are the same point",
                    "a capsule without length is a sphere: {sphere: {center, radius}}");
  }
  return later(capsule, from, to, r.value("radius"));
}

// In the file the polynomial takes x, y, z as numbers in the file's length unit, in the library in
// meters.
Make quadricOf(Reader r) {
  using Q = QuadricCoefficients;
  Q q;
  const double per_meter = 1.0 / r.loader().metersPerUnit();
  bool is_flat = true;
  const auto read = [&](std::string_view key, double& coefficient, double scale) {
    const double number = r.value(key);
    is_flat = is_flat && number == 0.0;
    coefficient = number * scale;
    if (!std::isfinite(coefficient)) {
      throw r.errorAt(key, "scene.range", inQuotes(key) + " is too large",
                      "divide all coefficients by the same number: the surface stays the same");
    }
  };
  for (const auto& [key, member] : {std::pair{"xx", &Q::xx},
                                    {"yy", &Q::yy},
                                    {"zz", &Q::zz},
                                    {"xy", &Q::xy},
                                    {"xz", &Q::xz},
                                    {"yz", &Q::yz}}) {
    read(key, q.*member, per_meter * per_meter);
  }
  for (const auto& [key, member] : {std::pair{"x", &Q::x}, {"y", &Q::y}, {"z", &Q::z}}) {
    read(key, q.*member, per_meter);
  }
  q.constant = r.value("constant");
  if (is_flat) {
    throw r.errorAt("", "scene.missing_key",
                    "this quadric has no coefficient of x, y or z other than 0",
                    "add one or more of xx, yy, zz, xy, xz, yz, x, y, z; inside is where the "
                    "polynomial is negative");
  }
  return later(quadric, r.point("center"), q, r.value("reach"));
}

Make gyroidOf(Reader r) {
  const double period = r.value("period");
  if (!r.has("thickness")) return later(gyroid, r.point("center"), period);
  return later(gyroidWall, r.point("center"), period,
               valueUpTo(r, "thickness", 0.2 * period, "a fifth of 'period'",
                         "leave it out for the solid on one side of the gyroid"));
}

Make metaballsOf(Reader r) {
  constexpr FallOff kFallOffs[] = {FallOff::kWyvill, FallOff::kGaussian, FallOff::kInverseSquare};
  const double iso = r.value("iso");
  std::vector<Metaball> balls;
  double most = 0.0;
  for (Reader ball : r.maps("balls")) {
    balls.push_back({ball.point("center"), ball.value("radius"), ball.value("strength")});
    most += std::max(0.0, balls.back().strength);
  }
  if (!(most > iso)) {
    throw r.errorAt("iso", "scene.range",
                    "'iso' is never reached: the positive strengths add up to no more than it",
                    "at its center a ball's influence is its strength; for balls of "
                    "strength 1, iso: 0.5 is usual");
  }
  return later(metaballs, balls, kFallOffs[r.choice("fall_off")], iso);
}

const std::map<std::string_view, Make (*)(Reader)>& shapes() {
  static const std::map<std::string_view, Make (*)(Reader)> all = {
      {"half_space",
       [](Reader r) { return later(halfSpace, r.point("point"), r.point("normal")); }},
      {"sphere", [](Reader r) { return later(sphere, r.point("center"), r.value("radius")); }},
      {"box", [](Reader r) { return later(box, r.point("center"), r.point("size")); }},
      {"rounded_box", roundedBoxOf},
      {"cylinder",
       [](Reader r) {
         return later(cylinder, r.point("center"), r.point("axis"), r.value("radius"),
                      r.value("height"));
       }},
      {"cone",
       [](Reader r) {
         return later(cone, r.point("base"), r.point("axis"), r.value("radius"), r.value("height"));
       }},
      {"torus", torusOf},
      {"capsule", capsuleOf},
      {"ellipsoid", [](Reader r) { return later(ellipsoid, r.point("center"), r.point("radii")); }},
      {"heart", [](Reader r) { return later(heart, r.point("center"), r.value("width")); }},
      {"quadric", quadricOf},
      {"gyroid", gyroidOf},
      {"metaballs", metaballsOf},
  };
  return all;
}

}  // namespace

std::function<FieldPtr()> readShape(std::string_view kind, const MapReader& reader) {
  const auto shape = shapes().find(kind);
  return shape == shapes().end() ? nullptr : shape->second(reader);
}

std::string inUnitOf(const SceneLoader& loader, double meters) {
  return shortNumber(meters / loader.metersPerUnit(), 6) + " " + loader.lengthUnit();
}

}  // namespace palpate
