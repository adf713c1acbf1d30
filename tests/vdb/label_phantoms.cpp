#include "vdb/label_phantoms.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb::test {
namespace {

constexpr double kMm = 1e-3;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kPoints = 4000;

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return unitOr(Vec3(normal(random), normal(random), normal(random)), Vec3(1, 0, 0));
}

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A field of random waves of about one length: folds without end.
class Waves {
 public:
  Waves(double period, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
    for (Wave& wave : waves_) {
      wave = {direction(random) * (2.0 * std::numbers::pi / period), phase(random)};
    }
  }
  /// From about -1 to 1, and about the distance to its zero set where that is near.
  [[nodiscard]] double operator()(const Vec3& p) const {
    double value = 0.0;
    Vec3 slope(0.0);
    for (const Wave& wave : waves_) {
      value += std::sin(glm::dot(wave.k, p) + wave.phase);
      slope += std::cos(glm::dot(wave.k, p) + wave.phase) * wave.k;
    }
    return value / std::max(glm::length(slope), 0.5 * glm::length(waves_[0].k));
  }

 private:
  struct Wave {
    Vec3 k{0.0};
    double phase = 0.0;
  };
  std::array<Wave, 8> waves_;
};

}  // namespace

Image labelImage(const Vec3& spacing, const Vec3& half,
                 const std::function<int(const Vec3&)>& label_at, const Vec3& shift) {
  Image image;
  image.source = "made.nii";
  for (int a = 0; a < 3; ++a) {
    const int side = static_cast<int>(std::ceil(half[a] / spacing[a]));
    image.axes[a][a] = spacing[a] * kMm;
    image.origin[a] = (shift[a] - side) * spacing[a] * kMm;
    image.size[static_cast<std::size_t>(a)] = 2 * side + 1;
  }
  const auto [nx, ny, nz] = image.size;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        image.values.push_back(static_cast<float>(label_at(image.toWorld(Vec3(i, j, k)) / kMm)));
      }
    }
  }
  return image;
}

LabelScene::LabelScene(const Image& image) : image_(image) {
  std::set<int> values;
  for (const float value : image.values) values.insert(static_cast<int>(value));
  values.erase(0);
  labels_.assign(values.begin(), values.end());
  std::vector<std::vector<int>> layers;
  for (const int label : labels_) layers.push_back({label});
  SceneDescription description;
  const double start = processorSeconds();
  LabelSurfaces surfaces(image, layers);
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const FieldPtr field = gridField(surfaces.surface(n, 0.0, {}, {}, LabelEdge::kLapped));
    fields_[labels_[n]] = field;
    LayerDescription layer;
    layer.name = std::to_string(labels_[n]);
    layer.inside = std::make_shared<FieldSource>(field);
    layer.label_group = "image";
    layer.labels = layers[n];
    description.layers.push_back(std::move(layer));
  }
  seconds_ = processorSeconds() - start;
  scene_ = compile(description);
}

int LabelScene::labelAt(const Vec3& mm) const {
  const RegionId region = scene_->regionAt(mm * kMm);
  return region == kOutside ? 0 : labels_[static_cast<std::size_t>(region) - 1];
}

LabelCenters LabelScene::centers() const {
  std::map<int, int> part_of;
  for (const int label : labels_) part_of[label] = label;
  return countCenters(image_, part_of, [this](const Vec3& p) {
    const RegionId region = scene_->regionAt(p);
    return region == kOutside ? kNoPart : labels_[static_cast<std::size_t>(region) - 1];
  });
}

SurfaceError surfaceError(const Field& field, const std::vector<SurfacePoint>& points,
                          const Field* other) {
  SurfaceError error;
  for (const auto& [at, normal] : points) {
    FieldSample sample = field.sample(at * kMm);
    if (other != nullptr) {
      const FieldSample beyond = other->sample(at * kMm);
      sample.value = 0.5 * (sample.value - beyond.value);
      sample.gradient = 0.5 * (sample.gradient - beyond.gradient);
    }
    const double off = sample.value / kMm;
    const double cosine = glm::dot(unitOr(sample.gradient, -normal), normal);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree;
    error.bias += off;
    error.most = std::max(error.most, std::abs(off));
    error.normal += angle * angle;
    error.worst = std::max(error.worst, angle);
  }
  const auto count = static_cast<double>(points.size());
  error.bias /= count;
  error.normal = std::sqrt(error.normal / count);
  return error;
}

Image BallPhantom::image(const Vec3& spacing) const {
  return labelImage(spacing, Vec3(radius) + glm::abs(center) + 5.0 * spacing,
                    [&](const Vec3& p) { return glm::length(p - center) < radius ? 1 : 0; });
}

std::vector<SurfacePoint> BallPhantom::points() const {
  std::mt19937 random(5);
  std::vector<SurfacePoint> points;
  for (int n = 0; n < kPoints; ++n) {
    const Vec3 way = direction(random);
    points.push_back({center + radius * way, way});
  }
  return points;
}

Vec3 PlanePhantom::half(const Vec3& spacing) {
  const double least = 16.0 * std::min({spacing.x, spacing.y, spacing.z});
  return glm::max(Vec3(least), 8.0 * spacing);
}

Image PlanePhantom::image(const Vec3& spacing) const {
  return labelImage(spacing, half(spacing),
                    [&](const Vec3& p) { return glm::dot(p - center, normal) < 0.0 ? 1 : 2; });
}

std::vector<SurfacePoint> PlanePhantom::points(const Vec3& spacing) const {
  std::mt19937 random(5);
  std::vector<SurfacePoint> points;
  const Vec3 most = half(spacing) - 3.0 * spacing;
  while (points.size() < kPoints) {
    Vec3 p(0.0);
    for (int a = 0; a < 3; ++a) {
      p[a] = std::uniform_real_distribution<double>(-most[a], most[a])(random);
    }
    p -= glm::dot(p - center, normal) * normal;
    if (glm::all(glm::lessThan(glm::abs(p), most))) points.push_back({p, normal});
  }
  return points;
}

Image SlabPhantom::image(const Vec3& spacing) const {
  const Vec3 half = 0.5 * Vec3(voxels[0], voxels[1], voxels[2]) * spacing;
  // Faces pass half-way between centers: an even number of voxels has none at its middle.
  const Vec3 shift(voxels[0] % 2 == 0 ? 0.5 : 0.0, voxels[1] % 2 == 0 ? 0.5 : 0.0,
                   voxels[2] % 2 == 0 ? 0.5 : 0.0);
  return labelImage(
      spacing, half + 8.0 * spacing,
      [&](const Vec3& p) { return glm::all(glm::lessThan(glm::abs(p), half)) ? 1 : 0; }, shift);
}

double SlabPhantom::error(const Field& field, const Vec3& spacing, double nearest,
                          double farthest) const {
  const Vec3 half = 0.5 * Vec3(voxels[0], voxels[1], voxels[2]);  // in voxels
  std::mt19937 random(5);
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int n = 0; n < kPoints; ++n) {
      Vec3 p(0.0);
      double from_edge = kInfinity;
      for (int a = 0; a < 3; ++a) {
        p[a] = std::uniform_real_distribution<double>(-half[a], half[a])(random);
        if (a != axis) from_edge = std::min(from_edge, half[a] - std::abs(p[a]));
      }
      p[axis] = std::copysign(half[axis], p[axis]);
      if (from_edge < nearest || from_edge > farthest) continue;
      const double off = field.value(p * spacing * kMm) / (spacing[axis] * kMm);
      most = std::max(most, std::abs(off));
    }
  }
  return most;
}

double SlabPhantom::cutOff(const Field& field, const Vec3& spacing) const {
  const Vec3 half = 0.5 * Vec3(voxels[0], voxels[1], voxels[2]);
  std::mt19937 random(6);
  double most = 0.0;
  for (int along = 0; along < 3; ++along) {
    const double reach = half[along] - 3.0;
    if (reach <= 0.0) continue;
    for (int n = 0; n < kPoints / 4; ++n) {
      Vec3 p(0.0);
      p[along] = std::uniform_real_distribution<double>(-reach, reach)(random);
      Vec3 way(0.0);
      for (int a = 0; a < 3; ++a) {
        if (a == along) continue;
        const double side = (n >> a & 1) != 0 ? 1.0 : -1.0;
        p[a] = side * half[a];
        way[a] = -side;
      }
      double cut = 0.0;
      while (cut < 3.0 && field.value((p + cut * way / std::sqrt(2.0)) * spacing * kMm) >= 0.0) {
        cut += 0.01;
      }
      most = std::max(most, cut);
    }
  }
  return most;
}

Image FoldedHead::image(const Vec3& spacing) const {
  const Waves waves(period, seed);
  const double thin = std::max({spacing.x, spacing.y, spacing.z});
  const double bone = radius + thin;
  const double skin = bone + 3.0;
  return labelImage(spacing, Vec3(skin + thin) + 4.0 * spacing, [&](const Vec3& p) {
    const double r = glm::length(p);
    if (r >= skin + thin) return 0;
    if (r >= skin) return 6;
    if (r >= bone) return 5;
    if (r >= radius) return 4;
    const double fold = std::max(waves(p), r - radius + 1.5);
    if (fold < -ribbon) return 1;
    return fold < 0.0 ? 2 : 3;
  });
}

int openRays(const LabelScene& scene, int label, double radius, double step, int rays) {
  std::mt19937 random(9);
  int open = 0;
  for (int n = 0; n < rays; ++n) {
    const Vec3 way = direction(random);
    double r = 0.5 * radius;
    while (r < 1.5 * radius && scene.labelAt(r * way) != label) r += step;
    open += r < 1.5 * radius ? 0 : 1;
  }
  return open;
}

Image randomLabels(std::uint32_t seed, const std::array<int, 3>& size, const Vec3& spacing,
                   int labels, double blob) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  struct Seed {
    Vec3 at;
    int label;
  };
  std::vector<Seed> seeds;
  const double volume = static_cast<double>(size[0]) * size[1] * size[2];
  const auto count = static_cast<int>(volume / (blob * blob * blob)) + labels;
  for (int n = 0; n < count; ++n) {
    seeds.push_back(
        {Vec3(share(random) * size[0], share(random) * size[1], share(random) * size[2]),
         static_cast<int>(share(random) * labels)});
  }
  Image image;
  image.source = "random.nii";
  image.size = size;
  for (int a = 0; a < 3; ++a) image.axes[a][a] = spacing[a] * kMm;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const Vec3 p(i, j, k);
        std::array<double, 2> least = {kInfinity, kInfinity};
        int label = 0;
        for (const Seed& each : seeds) {
          const double d = glm::length(p - each.at);
          if (d < least[0]) {
            least = {d, least[0]};
            label = each.label;
          } else {
            least[1] = std::min(least[1], d);
          }
        }
        // A wall about a voxel thin around some of them, and specks.
        if (least[1] - least[0] < 1.2 && label % 3 == 1) label = labels - 1;
        if (share(random) < 0.002) label = static_cast<int>(share(random) * labels);
        image.values.push_back(static_cast<float>(label));
      }
    }
  }
  return image;
}

}  // namespace palpate::vdb::test
