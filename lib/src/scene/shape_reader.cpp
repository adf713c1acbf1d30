#include "scene/shape_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "scene/messages.h"
#include "scene/values.h"

namespace palpate {
namespace {

using Make = std::function<FieldPtr()>;

Vec3 positiveLengths(MapReader& reader, std::string_view key) {
  const Vec3 lengths = reader.requirePoint(key);
  if (!(lengths.x > 0.0 && lengths.y > 0.0 && lengths.z > 0.0)) {
    throw reader.errorAt(key, "scene.range",
                         "each length of " + inQuotes(key) + " must be more than 0");
  }
  return lengths;
}

/// `key` may be at most `most`, which is `why`.
void refuseAbove(const MapReader& reader, std::string_view key, double value, double most,
                 const std::string& why, const std::string& hint) {
  // Halves and fifths of decimal numbers are not exact.
  if (value <= most * (1.0 + 1e-12)) return;
  throw reader.errorAt(
      key, "scene.range",
      inQuotes(key) + " must not be more than " + why + ", " + inUnitOf(reader.loader(), most),
      hint);
}

Make halfSpaceOf(MapReader& reader) {
  const Vec3 point = reader.requirePoint("point");
  const Vec3 normal = reader.requireDirection("normal");
  return [=] { return halfSpace(point, normal); };
}

Make sphereOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const double radius = positiveLength(reader, "radius");
  return [=] { return sphere(center, radius); };
}

Make boxOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const Vec3 size = positiveLengths(reader, "size");
  return [=] { return box(center, size); };
}

Make roundedBoxOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const Vec3 size = positiveLengths(reader, "size");
  const double rounding = positiveLength(reader, "rounding");
  const double most = 0.5 * std::min({size.x, size.y, size.z});
  refuseAbove(reader, "rounding", rounding, most, "half of the smallest 'size'",
              "a box rounded that far is a capsule or a ball");
  return [=] { return roundedBox(center, size, std::min(rounding, most)); };
}

Make cylinderOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const Vec3 axis = reader.requireDirection("axis");
  const double radius = positiveLength(reader, "radius");
  const double height = positiveLength(reader, "height");
  return [=] { return cylinder(center, axis, radius, height); };
}

Make coneOf(MapReader& reader) {
  const Vec3 base = reader.requirePoint("base");
  const Vec3 axis = reader.requireDirection("axis");
  const double radius = positiveLength(reader, "radius");
  const double height = positiveLength(reader, "height");
  return [=] { return cone(base, axis, radius, height); };
}

Make torusOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const Vec3 axis = reader.requireDirection("axis");
  const double radius = positiveLength(reader, "radius");
  const double tube = positiveLength(reader, "tube");
  if (!(tube < radius)) {
    throw reader.errorAt("tube", "scene.range",
                         "'tube' must be less than 'radius', " + inUnitOf(reader.loader(), radius),
                         "the radius is from the center to the middle of the tube");
  }
  return [=] { return torus(center, axis, radius, tube); };
}

Make capsuleOf(MapReader& reader) {
  const Vec3 from = reader.requirePoint("from");
  const Vec3 to = reader.requirePoint("to");
  const double radius = positiveLength(reader, "radius");
  if (from == to) {
    throw reader.errorAt("to", "scene.range", "'from' and 'to' are the same point",
                         "a capsule without length is a sphere: {sphere: {center, radius}}");
  }
  return [=] { return capsule(from, to, radius); };
}

Make ellipsoidOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const Vec3 radii = positiveLengths(reader, "radii");
  return [=] { return ellipsoid(center, radii); };
}

Make heartOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const double width = positiveLength(reader, "width");
  return [=] { return heart(center, width); };
}

// The file's polynomial takes its x, y, z as numbers in the file's length unit, the library's in metres.
Make quadricOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  QuadricCoefficients q;
  const double per_metre = 1.0 / reader.loader().metresPerUnit();
  bool is_flat = true;
  const auto read = [&](std::string_view key, double& coefficient, double scale) {
    const double number = reader.numberOr(key, 0.0);
    is_flat = is_flat && number == 0.0;
    coefficient = number * scale;
    if (!std::isfinite(coefficient)) {
      throw reader.errorAt(key, "scene.range", inQuotes(key) + " is too large",
                           "only the ratios of the coefficients count; make all of them smaller");
    }
  };
  for (const auto& [key, member] :
       {std::pair{"xx", &QuadricCoefficients::xx}, std::pair{"yy", &QuadricCoefficients::yy},
        std::pair{"zz", &QuadricCoefficients::zz}, std::pair{"xy", &QuadricCoefficients::xy},
        std::pair{"xz", &QuadricCoefficients::xz}, std::pair{"yz", &QuadricCoefficients::yz}}) {
    read(key, q.*member, per_metre * per_metre);
  }
  for (const auto& [key, member] :
       {std::pair{"x", &QuadricCoefficients::x}, std::pair{"y", &QuadricCoefficients::y},
        std::pair{"z", &QuadricCoefficients::z}}) {
    read(key, q.*member, per_metre);
  }
  q.constant = reader.numberOr("constant", 0.0);
  const bool reaches = reader.optional("reach") != nullptr;
  const double reach = reaches ? positiveLength(reader, "reach") : 0.0;
  if (is_flat) {
    reader.finish();  // perhaps one is there, with a slip in it
    throw reader.errorAt("", "scene.missing_key",
                         "this quadric has no coefficient of x, y or z other than 0",
                         "add one or more of xx, yy, zz, xy, xz, yz, x, y, z; inside is where the "
                         "polynomial is negative");
  }
  return [=] { return reaches ? quadric(center, q, reach) : quadric(center, q); };
}

Make gyroidOf(MapReader& reader) {
  const Vec3 center = reader.requirePoint("center");
  const double period = positiveLength(reader, "period");
  if (reader.optional("thickness") == nullptr) return [=] { return gyroid(center, period); };
  const double thickness = positiveLength(reader, "thickness");
  const double most = 0.2 * period;
  refuseAbove(reader, "thickness", thickness, most, "a fifth of 'period'",
              "leave it out for the solid on one side of the gyroid");
  return [=] { return gyroidWall(center, period, std::min(thickness, most)); };
}

Metaball readBall(const SceneLoader& loader, const Node& node) {
  MapReader reader(loader, node, "a ball of 'metaballs'");
  Metaball ball;
  ball.center = reader.requirePoint("center");
  ball.radius = positiveLength(reader, "radius");
  ball.strength = reader.numberOr("strength", ball.strength);
  reader.finish();
  if (ball.strength == 0.0) {
    throw reader.errorAt("strength", "scene.range", "'strength' must not be 0",
                         "more than 0 adds to the solid, less takes away; 1 if left out");
  }
  return ball;
}

Make metaballsOf(MapReader& reader) {
  const Document& document = reader.loader().document();
  constexpr FallOff kFallOffs[] = {FallOff::kWyvill, FallOff::kGaussian, FallOff::kInverseSquare};
  const FallOff fall_off = kFallOffs[readChoice(document, reader.require("fall_off"), "'fall_off'",
                                                {"wyvill", "gaussian", "inverse_square"})];
  const double iso = reader.requireNumber("iso");
  if (!(iso > 0.0)) throw reader.errorAt("iso", "scene.range", "'iso' must be more than 0");
  std::vector<Metaball> balls;
  double most = 0.0;
  for (const Node& node : readList(document, reader.require("balls"), "'balls'", 1, 0)) {
    balls.push_back(readBall(reader.loader(), node));
    most += std::max(0.0, balls.back().strength);
  }
  if (!(most > iso)) {
    throw reader.errorAt("iso", "scene.range",
                         "'iso' is never reached: the strengths above 0 do not add up to more",
                         "a ball's influence is its strength at its center; with one ball of "
                         "strength 1, iso: 0.5 is usual");
  }
  return [=] { return metaballs(balls, fall_off, iso); };
}

struct Shape {
  std::string_view kind;
  Make (*read)(MapReader&);
};

constexpr Shape kShapes[] = {
    {"half_space", halfSpaceOf},
    {"sphere", sphereOf},
    {"box", boxOf},
    {"rounded_box", roundedBoxOf},
    {"cylinder", cylinderOf},
    {"cone", coneOf},
    {"torus", torusOf},
    {"capsule", capsuleOf},
    {"ellipsoid", ellipsoidOf},
    {"heart", heartOf},
    {"quadric", quadricOf},
    {"gyroid", gyroidOf},
    {"metaballs", metaballsOf},
};

}  // namespace

std::span<const std::string_view> shapeKinds() {
  static constexpr auto kKinds = [] {
    std::array<std::string_view, std::size(kShapes)> kinds;
    for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i] = kShapes[i].kind;
    return kinds;
  }();
  return kKinds;
}

std::function<FieldPtr()> readShape(std::string_view kind, MapReader& reader) {
  const auto* const shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                         [&](const Shape& s) { return s.kind == kind; });
  Make make = shape->read(reader);
  reader.finish();
  return make;
}

double positiveLength(MapReader& reader, std::string_view key) {
  const double length = reader.requireLength(key);
  if (!(length > 0.0)) {
    throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be more than 0");
  }
  return length;
}

std::string inUnitOf(const SceneLoader& loader, double metres) {
  char digits[32];
  const auto end = std::to_chars(std::begin(digits), std::end(digits),
                                 metres / loader.metresPerUnit(), std::chars_format::general, 6);
  return std::string(std::begin(digits), end.ptr) + " " + loader.lengthUnit();
}

}  // namespace palpate
