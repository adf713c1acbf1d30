#include "support/random_scene.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <initializer_list>
#include <vector>

#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// Writes fields in the syntax of scene files, lengths in mm.
class FieldWriter {
 public:
  FieldWriter(Random& random, const RandomSceneOptions& options)
      : random_(random), options_(options) {}

  /// An expression with exactly `levels` operations on its longest branch.
  std::string expression(int levels) {
    if (levels <= 0) return primitive();
    const double which = random_.uniform(0.0, 1.0);
    if (which < 0.28) return joined({"{union: ", operands(levels, {}), "}"});
    if (which < 0.44) return joined({"{intersection: ", operands(levels, {}), "}"});
    if (which < 0.52) {
      return "{intersection: " +
             operands(levels, [](const std::string& f) { return "{complement: " + f + "}"; }) + "}";
    }
    if (which < 0.78) return joined({"{difference: ", operands(levels, {}), "}"});
    if (which < 0.86) return moved(expression(levels - 1));
    if (which < 0.90) {
      return joined({"{offset: {field: ", expression(levels - 1),
                     ", distance: ", signedLength(0.3, 1.0), "}}"});
    }
    if (which < 0.94) {
      return joined(
          {"{shell: {field: ", expression(levels - 1), ", thickness: ", length(0.5, 2.0), "}}"});
    }
    return blend();
  }

  std::string ball(double least, double most, double spread) {
    return joined({"{sphere: {center: ", point(spread), ", radius: ", length(least, most), "}}"});
  }

  /// A primitive somewhere in the middle of the scene.
  std::string primitive() {
    const auto kind = static_cast<int>(random_.uniform(0.0, 11.0));
    switch (kind) {
      case 0:
        return joined({"{half_space: {point: ", point(6.0), ", normal: ", direction(), "}}"});
      case 1:
      case 2:
        return joined({"{box: {center: ", point(9.0), ", size: [", length(6, 26), ", ",
                       length(6, 26), ", ", length(6, 26), "]}}"});
      case 3:
        return joined({"{cylinder: {center: ", point(9.0), ", axis: ", direction(),
                       ", radius: ", length(2.5, 12), ", height: ", length(8, 36), "}}"});
      case 4:
      case 5:
        return joined({"{cone: {base: ", point(9.0), ", axis: ", direction(),
                       ", radius: ", length(4, 14), ", height: ", length(6, 28), "}}"});
      case 6: {
        const std::string at = point(6.0);
        const std::string axis = direction();
        return joined({"{torus: {center: ", at, ", axis: ", axis, ", radius: ", length(8, 14),
                       ", tube: ", length(2, 6), "}}"});
      }
      default:
        return smoothPrimitive();
    }
  }

 private:
  /// A primitive without edges.
  std::string smoothPrimitive() {
    switch (static_cast<int>(random_.uniform(0.0, 5.0))) {
      case 0:
        return joined({"{capsule: {from: ", point(14.0), ", to: ", point(14.0),
                       ", radius: ", length(2.5, 9), "}}"});
      case 1:
        return joined({"{ellipsoid: {center: ", point(9.0), ", radii: [", length(5, 15), ", ",
                       length(5, 15), ", ", length(5, 15), "]}}"});
      case 2:
        return joined({"{rounded_box: {center: ", point(9.0), ", size: [", length(8, 26), ", ",
                       length(8, 26), ", ", length(8, 26), "], rounding: ", length(1, 3.9), "}}"});
      default:
        return ball(4, 14, 10.0);
    }
  }

  std::string blend() {
    const std::array<const char*, 3> names = {"smooth_union", "smooth_intersection",
                                              "smooth_difference"};
    const auto which = static_cast<std::size_t>(random_.uniform(0.0, 3.0));
    const bool creased = options_.black_box_creases && random_.uniform(0.0, 1.0) < 0.2;
    const std::string first = creased ? primitive() : smoothPrimitive();
    const std::string second = smoothPrimitive();
    return joined({"{", std::string(names[which]), ": {fields: [", first, ", ", second,
                   "], radius: ", length(1, 5), "}}"});
  }

  /// Two or three operands; one of them has `levels` - 1 levels. All but the first are modified by
  /// `change`.
  std::string operands(int levels, const std::function<std::string(const std::string&)>& change) {
    const int count = random_.uniform(0.0, 1.0) < 0.6 ? 2 : 3;
    const auto deep = static_cast<int>(random_.uniform(0.0, count));
    std::string text = "[";
    for (int i = 0; i < count; ++i) {
      const int below =
          i == deep ? levels - 1 : static_cast<int>(random_.uniform(0.0, std::min(levels, 3)));
      std::string one = expression(below);
      if (random_.uniform(0.0, 1.0) < 0.2) one = moved(one);
      if (change && i > 0) one = change(one);
      text += (i > 0 ? ", " : "") + one;
    }
    return text + "]";
  }

  std::string moved(const std::string& field) {
    return joined({"{transform: {field: ", field, ", translate: ", point(4.0), ", rotate: {axis: ",
                   turningAxis(), ", degrees: ", number(random_.uniform(-180, 180)), "}}}"});
  }

  /// Takes a braced list, because braces are evaluated from left to right, while operands of + may
  /// be evaluated in any order.
  static std::string joined(std::initializer_list<std::string> parts) {
    std::string out;
    for (const std::string& part : parts) out += part;
    return out;
  }
  static std::string number(double value) {
    std::array<char, 32> buffer{};
    (void)std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
    return buffer.data();
  }
  std::string length(double least, double most) { return number(random_.uniform(least, most)); }
  std::string signedLength(double least, double most) {
    const double sign = random_.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    return number(sign * random_.uniform(least, most));
  }
  std::string triple(const Vec3& v) {
    return "[" + number(options_.mirrored ? -v.x : v.x) + ", " + number(v.y) + ", " + number(v.z) +
           "]";
  }
  std::string point(double spread) { return triple(random_.in({Vec3(-spread), Vec3(spread)})); }
  /// A third of them is along an axis of the scene: exactly parallel directions are a special case.
  std::string direction() { return triple(someDirection()); }
  /// In a mirror image, a rotation about an axis becomes the opposite rotation about the mirrored
  /// axis.
  std::string turningAxis() {
    const Vec3 axis = someDirection();
    return triple(options_.mirrored ? -axis : axis);
  }
  Vec3 someDirection() {
    if (random_.uniform(0.0, 1.0) < 0.33) {
      Vec3 v(0.0);
      v[static_cast<int>(random_.uniform(0.0, 3.0))] = random_.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
      return v;
    }
    return random_.direction();
  }

  Random& random_;
  RandomSceneOptions options_;
};

std::string layerText(int index, const std::string& field) {
  return "  - {name: part" + std::to_string(index) + ", inside: " + field + "}\n";
}

}  // namespace

SceneDescription RandomScene::description() const {
  SceneDescription out = parseScene(yaml, "random scene " + std::to_string(number));
  if (!is_label_group) return out;
  for (std::size_t i = 0; i < out.layers.size(); ++i) {
    out.layers[i].label_group = "scan";
    out.layers[i].labels = {static_cast<int>(i)};
  }
  return out;
}

FieldPtr RandomScene::solid() const {
  const SceneDescription out = parseScene(
      "palpate: 1\nlength: mm\nlayers: [{name: solid, inside: " + core + "}]\n", "solid");
  return out.layers.front().inside->get();
}

RandomScene randomScene(std::uint64_t number, const RandomSceneOptions& options) {
  // Without mixing, neighboring numbers would give engines in related states.
  Random random(number * 0x9E3779B97F4A7C15ULL + 0x632BE59BD9B4E019ULL);
  FieldWriter write(random, options);
  RandomScene out;
  out.number = number;
  out.depth = 1 + static_cast<int>(number % static_cast<std::uint64_t>(options.deepest));
  const bool is_within = random.uniform(0.0, 1.0) < 0.5;
  const double kind = options.shell > 0.0 ? 1.0 : random.uniform(0.0, 1.0);
  std::vector<std::string> layers;
  if (kind < 0.06) {  // balls as layers of one wall
    for (int i = 0; i < 3; ++i) layers.push_back(write.ball(9, 16, 8.0));
  } else if (kind < 0.12) {  // labels of one image
    out.is_label_group = true;
    for (int i = 0; i < 3; ++i) layers.push_back(write.ball(8, 14, 8.0));
  } else if (kind < 0.24) {  // several layers that overlap
    out.depth = std::min(out.depth, 3);
    layers.push_back(write.expression(out.depth));
    layers.push_back(write.expression(out.depth - 1));
    if (random.uniform(0.0, 1.0) < 0.5) layers.push_back(write.primitive());
  } else {
    layers.push_back(write.expression(out.depth));
    out.core = layers.back();
    if (options.shell > 0.0) {
      std::array<char, 32> thickness{};
      (void)std::snprintf(thickness.data(), thickness.size(), "%.6g", options.shell);
      layers.back() =
          "{shell: {field: " + layers.back() + ", thickness: " + thickness.data() + "}}";
    }
  }
  out.yaml = "palpate: 1\nlength: " + options.unit + "\nlayers:\n";
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (!options.placed.empty()) {
      layers[i] = "{transform: {field: " + layers[i] + ", " + options.placed + "}}";
    }
    out.yaml += layerText(static_cast<int>(i), layers[i]);
  }
  if (is_within) out.yaml += "start: {region: part0}\n";
  return out;
}

}  // namespace palpate::test
