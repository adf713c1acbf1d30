// A scanned pelvis, imported and touched: its layers are felt where the labels have them, and a
// needle feels them as its model predicts.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "palpate/core/math.h"
#include "support/scan_folder.h"
#include "tools/helpers.h"
#include "vdb/python_oracle.h"

namespace palpate::testing {
namespace {

const std::string kData = scanPath("pelvis");
const char* const kOracle = "tools/scan_oracle.py";
const std::string kMuscles = "5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28";
const std::string kSets = kMuscles + ";1,2,3,4";

/// A slice through the head of a femur.
constexpr int kSlice = 56;

/// The whole pelvis takes minutes, and is felt with PALPATE_SLOW_TESTS=1, each label as a region.
/// Otherwise one half of 11 slices, with all muscles as one region and all bones as another.
struct Pelvis {
  bool is_whole = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  TempFolder folder;
  std::string labels = kData + "/label.mhd";
  std::string body = kData + "/mask.mhd";
  int slice = kSlice;

  Pelvis() {
    if (is_whole) return;
    constexpr int kAround = 5;
    for (std::string* const file : {&labels, &body}) {
      const std::string slab = folder.path(file == &labels ? "labels.nii.gz" : "body.nii.gz");
      (void)vdb::test::askScript(
          kOracle, "slab",
          {*file, "280", std::to_string(kSlice - kAround), std::to_string(kSlice + kAround), slab});
      *file = slab;
    }
    slice = kAround;
  }
};

/// "muscle" for the region of a muscle, and so on.
std::string kindOf(const std::string& region) {
  if (region == "pelvis" || region == "femur" || region == "sacrum" || region == "spine")
    return "bone";
  return region.find("muscle") != std::string::npos ? "muscle" : region;
}

/// One value each for skin, muscle and bone, in the order in which a ray meets them.
using Three = std::array<double, 3>;
constexpr std::array<const char*, 3> kNames = {"soft_tissue", "muscle", "bone"};

/// A ray through the head of a femur, in its slice, by the labels.
struct Ray {
  Vec3 from{0.0};      ///< [mm] far outside
  Vec3 way{0.0};       ///< inwards
  Three depth{};       ///< [mm] from `from`
  Three angle{};       ///< [degrees] to the border's normal
  double voxel = 0.0;  ///< [mm] length of the ray within a voxel of 1 x 1 x 3 mm

  [[nodiscard]] double widestAngle() const { return *std::max_element(angle.begin(), angle.end()); }
};

/// Of twenty rays all around, those that meet each of the three borders at less than 60 degrees to
/// its normal. A ray that grazes a border has no certain place on it: half a voxel across is a
/// whole one along the ray, or more. The femur is the thicker bone of the slice; the choice does
/// not depend on anything felt.
std::vector<Ray> raysOf(const Pelvis& pelvis) {
  std::vector<Ray> rays;
  for (const std::vector<double>& row : vdb::test::askScript(
           kOracle, "ring",
           {pelvis.labels, pelvis.body, "2", std::to_string(pelvis.slice), "20", kSets})) {
    EXPECT_EQ(row.size(), 13U);
    const Ray ray{Vec3(row[0], row[1], row[2]),
                  Vec3(row[3], row[4], row[5]),
                  {row[6], row[7], row[8]},
                  {row[9], row[10], row[11]},
                  row[12]};
    if (ray.widestAngle() < 60.0) rays.push_back(ray);
  }
  return rays;
}

void importPelvis(const Pelvis& pelvis, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"import", pelvis.labels, "--names", kData + "/labels.csv",
                                        "--body", pelvis.body,   "-o",      "pelvis.yaml"};
  if (!pelvis.is_whole) {
    arguments.insert(arguments.end(), {"--region", "muscle=5-28", "--region", "bone=1-4"});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  const CommandResult result = runPalpate(arguments, pelvis.folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
}

/// The part of a trace's row that is used.
struct Row {
  Vec3 hand{0.0};      ///< [mm]
  Vec3 proxy{0.0};     ///< [mm]
  Vec3 force{0.0};     ///< [N]
  std::string region;  ///< the kind of region
  std::string event;
};

std::vector<Row> touched(const Pelvis& pelvis, std::vector<std::string> motion) {
  motion.insert(motion.begin(), {"touch", "pelvis.yaml"});
  motion.insert(motion.end(), {"--trace", "t.csv", "--json"});
  const CommandResult result = runPalpate(motion, pelvis.folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<Row> rows;
  for (const std::string& line : linesOf(textOf(pelvis.folder.path("t.csv")))) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells[0] == "t") continue;
    const auto vector = [&](std::size_t first) {
      return Vec3(std::stod(cells[first]), std::stod(cells[first + 1]),
                  std::stod(cells[first + 2]));
    };
    rows.push_back({vector(1) * 1e3, vector(4) * 1e3, vector(7), kindOf(cells[10]), cells[12]});
  }
  return rows;
}

TEST(ImportPelvis, LayersAreFeltAsDeepAsTheLabelsHaveThem) {
  PALPATE_NEEDS_SCAN(kData);
  const Pelvis pelvis;
  const std::vector<Ray> rays = raysOf(pelvis);
  ASSERT_GE(rays.size(), 10U);
  // Walls that open at the lightest touch, so that the probe goes wherever the hand goes, and shows
  // only where it enters the next region.
  (void)pelvis.folder.file("open.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: a needle}
stiffest: {value: 2000 N/m, basis: assumed, source: a device}
tissues:
  skin: {labels: ["skin"], stiffness: {value: 400 N/m, basis: assumed, source: round}, opens_at: {value: 0 N, basis: assumed, source: open}}
  fat: {labels: ["fat"], stiffness: {value: 100 N/m, basis: assumed, source: round}}
  any: {labels: ["*"], stiffness: {value: 500 N/m, basis: assumed, source: round}, opens_at: {value: 0 N, basis: assumed, source: open}}
)");
  importPelvis(pelvis, {"--materials", "open.yaml"});

  constexpr double kFine = 0.05;  // [mm] a tick
  std::string path = "t,x,y,z\n";
  std::vector<std::size_t> first_row;
  std::size_t ticks = 0;
  const auto go = [&](const Vec3& p) {
    char line[120];
    std::snprintf(line, sizeof line, "%.4f,%.9g,%.9g,%.9g\n", 1e-3 * static_cast<double>(ticks++),
                  p.x * 1e-3, p.y * 1e-3, p.z * 1e-3);
    path += line;
  };
  for (const Ray& ray : rays) {
    first_row.push_back(ticks);
    const double near = ray.depth[0] - 5.0;
    const double end = ray.depth[2] + 5.0;
    for (double s = 0.0; s < near; s += 1.0) go(ray.from + s * ray.way);
    for (double s = near; s < end; s += kFine) go(ray.from + s * ray.way);
    for (double s = end; s > 0.0; s -= 1.0) go(ray.from + s * ray.way);
  }
  first_row.push_back(ticks);
  (void)pelvis.folder.file("path.csv", path);
  const std::vector<Row> rows = touched(pelvis, {"--path", "path.csv"});
  ASSERT_EQ(rows.size(), ticks);

  std::string points;  // places where borders were felt, for the oracle
  std::vector<std::string> told;
  int met_well = 0;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const Ray& ray = rays[r];
    Three felt = {-1.0, -1.0, -1.0};
    std::vector<std::string> order;
    for (std::size_t n = first_row[r]; n < first_row[r + 1] && felt[2] < 0.0; ++n) {
      const Row& row = rows[n];
      if (order.empty() || order.back() != row.region) order.push_back(row.region);
      for (std::size_t k = 0; k < 3; ++k) {
        if (felt[k] < 0.0 && row.region == kNames[k]) {
          felt[k] = glm::dot(row.hand - ray.from, ray.way);
        }
      }
    }
    // The hand enters the body first, and skips no layer.
    ASSERT_GE(order.size(), 4U) << "ray " << r;
    EXPECT_EQ(order[0], "outside");
    EXPECT_EQ(order[1], "soft_tissue");
    EXPECT_EQ(order[2], "muscle");
    EXPECT_EQ(order.back(), "bone");
    for (std::size_t k = 0; k < 3; ++k) {
      // A border is noticed up to a step behind it.
      const double off = felt[k] - 0.5 * kFine - ray.depth[k];
      char line[160];
      std::snprintf(line, sizeof line,
                    "  ray %zu %-11s %6.2f mm deep by the labels, off %+.2f mm, at %2.0f degrees",
                    r, kNames[k], ray.depth[k] - ray.depth[0], off, ray.angle[k]);
      told.emplace_back(line);
      EXPECT_NEAR(off, 0.0, ray.voxel) << line;
      // The depth below the skin lies between two borders, so both have to be met well: at less
      // than 45 degrees, half a voxel across is less than one along the ray.
      if (ray.widestAngle() < 45.0) {
        EXPECT_NEAR(felt[k] - felt[0], ray.depth[k] - ray.depth[0], ray.voxel) << line;
        met_well += k == 0 ? 1 : 0;
      }
      const Vec3 p = ray.from + felt[k] * ray.way;
      std::snprintf(line, sizeof line, "%zu %.6f %.6f %.6f\n", k, p.x, p.y, p.z);
      points += line;
    }
  }
  for (const std::string& line : told) std::printf("%s\n", line.c_str());
  EXPECT_GE(met_well, 10);

  // Perpendicular to the border, whatever the angle: within the shorter side of a voxel.
  double farthest = 0.0;
  for (const std::vector<double>& row : vdb::test::askScript(
           kOracle, "borders",
           {pelvis.labels, pelvis.body, pelvis.folder.file("points.txt", points), kSets})) {
    farthest = std::max(farthest, row[0]);
  }
  std::printf("  farthest from a border of the labels: %.2f mm\n", farthest);
  EXPECT_LE(farthest, 1.0);
}

TEST(ImportPelvis, ANeedleGoesThroughSkinFatAndMuscleToTheBoneAsItsModelSays) {
  PALPATE_NEEDS_SCAN(kData);
  const Pelvis pelvis;
  const std::vector<Ray> rays = raysOf(pelvis);
  // The ray that meets skin and muscle most perpendicularly: there the probe does not slide along a
  // wall before it opens.
  const auto slant = [](const Ray& ray) { return std::max(ray.angle[0], ray.angle[1]); };
  const Ray ray = *std::min_element(
      rays.begin(), rays.end(), [&](const Ray& a, const Ray& b) { return slant(a) < slant(b); });
  importPelvis(pelvis, {});

  const auto text = [](const Vec3& p) {
    char out[96];
    std::snprintf(out, sizeof out, "%.6f,%.6f,%.6f", p.x, p.y, p.z);
    return std::string(out);
  };
  constexpr double kSpeed = 0.01;  // [m/s] slow enough for damping to be small
  const std::vector<Row> rows =
      touched(pelvis, {"--insert", text(ray.from + (ray.depth[0] - 10.0) * ray.way),
                       text(ray.from + (ray.depth[2] + 2.0) * ray.way), "--speed", "10mm/s"});

  // Fat and muscle, from the project's table.
  struct Tissue {
    double cutting;    // [N]
    double shaft;      // [N/m] sliding
    double viscosity;  // [N s/m]
  };
  constexpr std::array<Tissue, 2> kTissues = {{{0.2, 35.0, 1.5}, {0.6, 47.0, 3.0}}};
  const std::vector<std::vector<double>> runs = vdb::test::askScript(
      kOracle, "runs", {pelvis.labels, pelvis.body, text(ray.from) + "," + text(ray.way), kSets});
  /// Predictions on the way in, by the labels.
  struct Model {
    double force = 0.0;  ///< [N]
    double since = 0.0;  ///< [mm] from the previous border
    double until = 0.0;  ///< [mm] to the next border
  };
  const auto model = [&](double depth) {
    Model at;
    for (std::size_t n = 0; n + 1 < runs.size() && runs[n][0] < depth; ++n) {
      const double end = std::min(runs[n + 1][0], depth);
      at.since = end - runs[n][0];
      at.until = runs[n + 1][0] - depth;
      if (runs[n][1] < 1.0 || runs[n][1] > 2.0) continue;
      const Tissue& tissue = kTissues[static_cast<std::size_t>(runs[n][1]) - 1];
      at.force += tissue.shaft * at.since * 1e-3;
      if (end == depth) at.force += tissue.cutting + tissue.viscosity * kSpeed;
    }
    return at;
  };

  std::vector<std::string> order;
  struct Opened {
    double before = 0.0;  // [N]
    double after = 0.0;
    bool is_held = false;  // by the next wall
  };
  std::vector<Opened> opened;
  std::size_t compared = 0;
  double worst = 0.0;
  double last = 0.0;
  std::size_t borders = 0;
  for (const Row& row : rows) {
    const double depth = glm::dot(row.hand - ray.from, ray.way);
    const double force = -glm::dot(row.force, ray.way);
    if (order.empty() || order.back() != row.region) order.push_back(row.region);
    const bool is_held = glm::length(row.hand - row.proxy) > 1e-6;  // by a wall
    if (!row.event.empty()) {
      opened.push_back({last, force, is_held});
      ++borders;
    }
    last = force;
    const bool is_in = row.region == "soft_tissue" || row.region == "muscle";
    if (!is_in || is_held) continue;
    const Model by_labels = model(depth);
    // On leaving a muscle the needle presses up to 10 mm before its wall opens (1.5 N at 156 N/m,
    // slanting), and then up to 4 mm before it cuts (0.6 N); and borders are off by a voxel.
    if (by_labels.since < 15.0 || by_labels.until < ray.voxel) continue;
    // Each border is off by up to a voxel, and the force by that length times the difference in
    // friction between the two sides; outside the first border there is no friction. On leaving the
    // muscle the tip may slide along a slanting wall as far as it presses on it, so that this
    // border is off by that distance.
    const double slid = borders > 2 ? 12.0 * 1.5 / 156.0 : 0.0;
    const double off = ray.voxel * 1e-3 * (35.0 + 12.0 * static_cast<double>(borders - 1)) + slid;
    EXPECT_NEAR(force, by_labels.force, off) << "at " << depth << " mm";
    worst = std::max(worst, std::abs(force - by_labels.force));
    ++compared;
  }
  for (std::size_t n = 0; n < opened.size(); ++n) {
    std::printf("  border %zu: %.3f N, then %.3f N\n", n, opened[n].before, opened[n].after);
    // The wall's force is gone; cutting and friction remain. In a layer that is thinner than the
    // needle pressed, the next wall takes over at once.
    EXPECT_LT(opened[n].after, opened[n].before - (opened[n].is_held ? 0.0 : 0.2));
  }
  // Each layer by the labels, up to the bone, that is at least a voxel thick is met: also the fat
  // between two muscles that lie 1.2 mm apart.
  std::size_t layers = 0;
  for (std::size_t n = 0; n + 1 < runs.size() && runs[n][0] < ray.depth[2] - ray.voxel; ++n) {
    layers += runs[n][1] > 0.0 && runs[n + 1][0] - runs[n][0] > 1.0 ? 1U : 0U;
  }
  EXPECT_EQ(opened.size(), layers);
  std::printf("  %zu ticks, off by %.4f N at most\n", compared, worst);
  ASSERT_GE(opened.size(), 2U);
  // The skin opens at its own force; the muscle at its force plus the force on the needle in the
  // fat. Tolerances: the error of the depth, damping at 10 mm/s, and friction of a wall that is not
  // met perpendicularly: the hand pushes along the ray, while the wall opens by the component
  // across it. Its normal is known to some 5 degrees.
  const auto aside = [&](double opens_at, std::size_t border) {
    constexpr double kDamping = 0.01;
    return kDamping +
           opens_at * (1.0 / std::cos((ray.angle[border] + 5.0) * std::numbers::pi / 180.0) - 1.0);
  };
  EXPECT_NEAR(opened[0].before, 2.78, aside(2.78, 0));
  EXPECT_NEAR(opened[1].before, 1.5 + model(ray.depth[1]).force,
              aside(1.5, 1) + 35.0 * ray.voxel * 1e-3);
  EXPECT_GT(compared, 500U);
  ASSERT_GE(order.size(), 3U);
  EXPECT_EQ(order[0], "outside");
  EXPECT_EQ(order[1], "soft_tissue");
  EXPECT_EQ(order[2], "muscle");
  // The needle rests on bone, and never enters it
  EXPECT_EQ(std::count(order.begin(), order.end(), "bone"), 0);
  const double stands = glm::dot(rows.back().proxy - ray.from, ray.way);
  EXPECT_NEAR(stands, ray.depth[2], ray.voxel);
}

}  // namespace
}  // namespace palpate::testing
