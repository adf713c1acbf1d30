// Meshes as voxels: which voxels are inside is known for balls and boxes, and by brute force for
// random solids; a row of voxels through an edge or a corner makes no streak.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "palpate/vdb/mesh.h"
#include "support/error_of.h"

namespace palpate::vdb {
namespace {

/// Corners at whole numbers times `unit`, so that rows of voxels meet edges and corners exactly.
Mesh boxMesh(const Vec3& lo, const Vec3& hi, bool is_turned = false) {
  Mesh mesh;
  mesh.source = "box.stl";
  for (int n = 0; n < 8; ++n) {
    mesh.vertices.emplace_back((n & 1) != 0 ? hi.x : lo.x, (n & 2) != 0 ? hi.y : lo.y,
                               (n & 4) != 0 ? hi.z : lo.z);
  }
  constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : kFaces) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  if (is_turned) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

/// A ball of `rings` parallels, its poles along x: rows of voxels run through both poles.
Mesh ballMesh(const Vec3& center, double radius, int rings) {
  Mesh mesh;
  mesh.source = "ball.stl";
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    const double polar = std::numbers::pi * i / rings;
    for (int j = 0; j < (i == 0 || i == rings ? 1 : around); ++j) {
      const double turn = 2.0 * std::numbers::pi * j / around;
      mesh.vertices.push_back(center + radius * Vec3(std::cos(polar),
                                                     std::sin(polar) * std::cos(turn),
                                                     std::sin(polar) * std::sin(turn)));
    }
  }
  const auto at = [&](int i, int j) -> std::uint32_t {
    if (i == 0) return 0;
    if (i == rings) return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    return static_cast<std::uint32_t>(1 + (i - 1) * around + j % around);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

std::size_t count(const Image& image, float label) {
  return static_cast<std::size_t>(std::count(image.values.begin(), image.values.end(), label));
}

TEST(LabelsOfMeshes, ABoxOnTheVoxelsHasThemByHalfOpenFaces) {
  for (const bool is_turned : {false, true}) {
    const Mesh box = boxMesh(Vec3(-3e-3, 1e-3, 2e-3), Vec3(5e-3, 7e-3, 4e-3), is_turned);
    const Image image = labelsOfMeshes({{"box", box}}, 1e-3, {});
    // 8 x 6 x 2 mm in voxels of 1 mm. Voxel centers lie on all faces; of two opposite faces only
    // one has its voxels inside.
    EXPECT_EQ(count(image, 1.0F), 8U * 6U * 2U);
    EXPECT_EQ(image.labels.names.at(1), "box");
    // Two free voxels on every side.
    EXPECT_LT(glm::length(image.origin - Vec3(-5e-3, -1e-3, 0.0)), 1e-15);
    EXPECT_EQ(image.size, (std::array{13, 11, 7}));
  }
}

TEST(LabelsOfMeshes, ABallsVoxelsAreThoseNearerToItsMiddleThanItsRadius) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-2e-3, 2e-3);
  for (int round = 0; round < 6; ++round) {
    // The first ball is centered on a voxel, so that poles and a meridian lie on rows of voxels.
    const Vec3 center = round == 0 ? Vec3(0.0) : Vec3(any(random), any(random), any(random));
    constexpr double kRadius = 10e-3;
    constexpr int kRings = 64;
    const Image image = labelsOfMeshes({{"ball", ballMesh(center, kRadius, kRings)}}, 0.5e-3, {});
    const double sag = kRadius * (1.0 - std::cos(std::numbers::pi / kRings)) * 2.0;
    std::size_t n = 0;
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i, ++n) {
          const double r = glm::length(image.toWorld(Vec3(i, j, k)) - center);
          if (r > kRadius + 1e-12) {
            ASSERT_EQ(image.values[n], 0.0F) << i << " " << j << " " << k;
          } else if (r < kRadius - sag) {
            ASSERT_EQ(image.values[n], 1.0F) << i << " " << j << " " << k;
          }
        }
      }
    }
  }
}

TEST(LabelsOfMeshes, ACavityIsNotInsideAndASolidInASolidIs) {
  Mesh shell = ballMesh(Vec3(0.0), 10e-3, 32);
  const auto add = [&](const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(shell.vertices.size());
    shell.vertices.insert(shell.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles) {
      shell.triangles.push_back({first + a, first + b, first + c});
    }
  };
  add(boxMesh(Vec3(-3.2e-3), Vec3(3.2e-3), true));
  const Image hollow = labelsOfMeshes({{"shell", shell}}, 1e-3, {});
  add(boxMesh(Vec3(-1.2e-3), Vec3(1.2e-3)));
  const Image kernel = labelsOfMeshes({{"shell", shell}}, 1e-3, {});
  const auto at = [](const Image& image, const Vec3& p) {
    const Vec3 index = glm::round(image.toIndex(p));
    return image.at(static_cast<int>(index.x), static_cast<int>(index.y),
                    static_cast<int>(index.z));
  };
  EXPECT_EQ(at(hollow, Vec3(0.0)), 0.0F);
  EXPECT_EQ(at(hollow, Vec3(6e-3, 0.0, 0.0)), 1.0F);
  EXPECT_EQ(at(kernel, Vec3(0.0)), 1.0F);
  EXPECT_EQ(at(kernel, Vec3(2e-3, 0.0, 0.0)), 0.0F);
}

TEST(LabelsOfMeshes, WhereTwoOverlapTheSmallerHasItOrTheOneThatIsNamed) {
  const std::vector<NamedMesh> both = {{"large", ballMesh(Vec3(0.0), 10e-3, 32)},
                                       {"small", ballMesh(Vec3(8e-3, 0.0, 0.0), 4e-3, 32)}};
  const Image image = labelsOfMeshes(both, 0.5e-3, {});
  const Image asked = labelsOfMeshes(both, 0.5e-3, {"large"});
  EXPECT_GT(count(image, 2.0F), count(asked, 2.0F));
  EXPECT_EQ(count(image, 1.0F) + count(image, 2.0F), count(asked, 1.0F) + count(asked, 2.0F));
  ASSERT_EQ(image.notes.size(), 1U);
  EXPECT_NE(image.notes[0].find("models"), std::string::npos) << image.notes[0];
}

TEST(LabelsOfMeshes, ASmallHoleIsClosedAndSaid) {
  const Mesh whole = boxMesh(Vec3(0.5e-3), Vec3(1.05e-2));
  Mesh torn = whole;
  torn.triangles.pop_back();
  const Image image = labelsOfMeshes({{"a", torn}}, 1e-3, {});
  EXPECT_EQ(image.values, labelsOfMeshes({{"a", whole}}, 1e-3, {}).values);
  ASSERT_EQ(image.notes.size(), 1U);
  EXPECT_NE(image.notes[0].find("'a' was not closed"), std::string::npos) << image.notes[0];
}

TEST(LabelsOfMeshes, RefusesWhatHasNoInside) {
  Mesh open = boxMesh(Vec3(0.0), Vec3(1e-2));
  open.triangles.resize(open.triangles.size() - 2);
  const auto code = [](const std::vector<NamedMesh>& meshes, double voxel) {
    return errorOf([&] { (void)labelsOfMeshes(meshes, voxel, {}); }).problem().code;
  };
  EXPECT_EQ(code({{"a", open}}, 1e-3), "mesh.open");
  const Mesh box = boxMesh(Vec3(0.0), Vec3(1.0));
  EXPECT_EQ(code({{"a", box}, {"a", box}}, 0.1), "models.name");
  EXPECT_EQ(code({{"a", box}}, 1e-4), "models.size");
}

}  // namespace
}  // namespace palpate::vdb
