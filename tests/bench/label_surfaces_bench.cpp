// How faithful the surfaces made of labels are: palpate_label_surfaces [NAME...] prints rows for
// each phantom that is named (ball, plane, slab, folds; all if none is), and a row for each scan
// (the path of a label image).

#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "vdb/label_phantoms.h"

namespace palpate::vdb {
namespace {

using test::BallPhantom;
using test::LabelScene;

const Vec3 kSpacings[] = {Vec3(1.0), Vec3(0.5, 0.5, 2.0)};

void printCenters(const LabelCenters& centers) {
  const CenterCount& all = centers.all;
  std::printf("centers %9llu, changed %6llu (%.3f %%), against %llu",
              static_cast<unsigned long long>(all.centers),
              static_cast<unsigned long long>(all.changed),
              100.0 * static_cast<double>(all.changed) / static_cast<double>(all.centers),
              static_cast<unsigned long long>(all.against));
}

void printName(const char* name, const Vec3& spacing) {
  std::printf("%-8s %.1f x %.1f x %.1f  ", name, spacing.x, spacing.y, spacing.z);
}

void printError(const test::SurfaceError& error, double voxel) {
  std::printf("normal %5.2f RMS %6.2f max degree, bias %+.3f, most %.3f voxel", error.normal,
              error.worst, error.bias / voxel, error.most / voxel);
}

void balls() {
  const Vec3 centers[] = {Vec3(0.13, -0.29, 0.37), Vec3(-0.21, 0.08, 1.12),
                          Vec3(0.05, 0.22, -0.71)};
  for (const Vec3& spacing : kSpacings) {
    for (const Vec3& center : centers) {
      const BallPhantom ball{center, 15.0};
      const Image image = ball.image(spacing);
      const LabelScene scene(image);
      printName("ball", spacing);
      printError(test::surfaceError(*scene.field(1), ball.points()), spacing.x);
      std::printf("; ");
      printCenters(scene.centers());
      std::printf(", %.2f s\n", scene.seconds());
    }
  }
}

void planes() {
  const Vec3 normals[] = {Vec3(0.12, 0.05, 1), Vec3(0.4, 0.3, 1), Vec3(1, 0.03, 0.07)};
  for (const Vec3& spacing : kSpacings) {
    for (const Vec3& normal : normals) {
      const test::PlanePhantom plane{Vec3(0.13, -0.29, 0.37), glm::normalize(normal)};
      const Image image = plane.image(spacing);
      const LabelScene scene(image);
      printName("plane", spacing);
      printError(test::surfaceError(*scene.field(1), plane.points(spacing), scene.field(2).get()),
                 glm::length(plane.normal * spacing));
      std::printf("; ");
      printCenters(scene.centers());
      std::printf(", %.2f s\n", scene.seconds());
    }
  }
}

void slabs() {
  for (const Vec3& spacing : kSpacings) {
    for (const test::SlabPhantom& slab :
         {test::SlabPhantom{{24, 20, 8}}, test::SlabPhantom{{40, 30, 4}}}) {
      const Image image = slab.image(spacing);
      const LabelScene scene(image);
      const Field& field = *scene.field(1);
      printName("slab", spacing);
      std::printf("off %.3f from 3 voxels on, %.3f from 2, %.3f from 1; edges cut by %.2f voxel; ",
                  slab.error(field, spacing, 3.0, kInfinity), slab.error(field, spacing, 2.0, 3.0),
                  slab.error(field, spacing, 1.0, 2.0), slab.cutOff(field, spacing));
      printCenters(scene.centers());
      std::printf(", %.2f s\n", scene.seconds());
    }
  }
}

void folds() {
  for (const Vec3& spacing : kSpacings) {
    test::FoldedHead head;
    const double voxel = std::cbrt(spacing.x * spacing.y * spacing.z);
    head.radius = 36.0 * voxel;
    head.ribbon = 2.2 * voxel;
    head.period = 14.0 * voxel;
    const Image image = head.image(spacing);
    const LabelScene scene(image);
    printName("folds", spacing);
    printCenters(scene.centers());
    std::printf(", open rays: dura %d, skin %d, %.2f s\n",
                test::openRays(scene, 4, head.radius, 0.05 * spacing.x, 3000),
                test::openRays(scene, 6, head.radius, 0.05 * spacing.x, 3000), scene.seconds());
  }
}

void scan(const std::string& file) {
  const Image image = readImage(file);
  const LabelScene scene(image);
  std::printf("%s  ", file.substr(file.find_last_of('/') + 1).c_str());
  printCenters(scene.centers());
  std::printf(", %.2f s\n", scene.seconds());
}

int run(const std::vector<std::string>& names) {
  const std::map<std::string, void (*)()> phantoms = {
      {"ball", balls}, {"plane", planes}, {"slab", slabs}, {"folds", folds}};
  for (const std::string& name : names) {
    const auto phantom = phantoms.find(name);
    phantom == phantoms.end() ? scan(name) : phantom->second();
  }
  if (names.empty()) {
    for (const auto& phantom : phantoms) phantom.second();
  }
  return 0;
}

}  // namespace
}  // namespace palpate::vdb

int main(int count, char** arguments) {
  try {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    return palpate::vdb::run({arguments + 1, arguments + count});
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
