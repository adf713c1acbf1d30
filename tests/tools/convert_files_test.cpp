// palpate convert: independent code reads its files (file_oracle.py: meshes from their bytes,
// images by nibabel), and it converts grids made by python3-openvdb (tests/vdb/vdb_interop.py).

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "folders/folders.h"
#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

double ballVolume(double radius) { return 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0); }

/// Numbers that file_oracle.py prints.
std::vector<double> told(const std::string& command, const std::string& path) {
  const std::string line = "/usr/bin/python3 '" + test::sourceFolder() +
                           "/tests/tools/file_oracle.py' " + command + " '" + path + "'";
  FILE* pipe = popen(line.c_str(), "r");
  std::vector<double> numbers;
  double number = 0.0;
  while (pipe != nullptr && std::fscanf(pipe, "%lf", &number) == 1) numbers.push_back(number);
  EXPECT_EQ(pclose(pipe), 0) << line;
  return numbers;
}

struct MeshFile {
  double triangles, open_edges, volume;
  double lo[3], hi[3];
};

MeshFile meshFile(const std::string& path) {
  const std::vector<double> n = told("mesh", path);
  EXPECT_EQ(n.size(), 9U) << path;
  if (n.size() != 9) return {};
  return {n[0], n[1], n[2], {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
}

std::vector<std::string> gridsOf(const TempFolder& folder, const std::string& name) {
  const CommandResult result = runPalpate({"info", name, "--json"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> names;
  const Json json = parseOnly(result);
  for (const auto& grid : json["files"][0]["grids"]) names.push_back(grid["name"]);
  return names;
}

constexpr const char* kTwo = R"(palpate: 1
length: cm
layers:
  - {name: egg, inside: {ellipsoid: {center: [1, 2, 3], radii: [1, 1.5, 2]}}}
  - {name: pearl, inside: {sphere: {center: [1, 2, 3], radius: 0.6}}}
)";

TEST(ConvertFiles, MeshesOfEveryFormatWindOutwardsInTheirUnit) {
  const TempFolder folder;
  (void)folder.file("two.yaml", kTwo);
  (void)converted(folder, {"two.yaml", "-o", "two.vdb", "--voxel", "0.7mm"});
  EXPECT_EQ(gridsOf(folder, "two.vdb"), (std::vector<std::string>{"egg/surface", "pearl/surface"}));
  const double egg = 4.0 / 3.0 * std::numbers::pi * 1.0 * 1.5 * 2.0;  // [cm^3]
  const std::pair<std::string, std::string> cases[] = {
      {"stl", ""}, {"stl", "m"}, {"obj", "mm"}, {"ply", ""}, {"glb", ""}};
  for (const auto& [extension, unit] : cases) {
    SCOPED_TRACE(extension + " " + unit);
    std::vector<std::string> arguments{"two.vdb", "--layer",          "egg",
                                       "-o",      "egg." + extension, "--force"};
    if (!unit.empty()) arguments.insert(arguments.end(), {"--to-units", unit});
    (void)converted(folder, arguments);
    const MeshFile mesh = meshFile(folder.path("egg." + extension));
    const double cm = extension == "glb" || unit == "m" ? 0.01 : (unit == "mm" ? 10.0 : 1.0);
    EXPECT_EQ(mesh.open_edges, 0.0);
    // Triangles of 0.7 mm lie some 1e-3 of the radii below the surface.
    EXPECT_NEAR(mesh.volume, egg * cm * cm * cm, 0.005 * egg * cm * cm * cm);
    const double middle[3] = {1.0, 2.0, 3.0};
    const double radius[3] = {1.0, 1.5, 2.0};
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(mesh.lo[axis], (middle[axis] - radius[axis]) * cm, 0.01 * cm);
      EXPECT_NEAR(mesh.hi[axis], (middle[axis] + radius[axis]) * cm, 0.01 * cm);
    }
  }
}

TEST(ConvertFiles, DistancesAreMillimetersInAnImage) {
  const TempFolder folder;
  (void)folder.file("two.yaml", kTwo);
  (void)converted(folder, {"two.yaml", "-o", "two.vdb", "--voxel", "0.5mm", "--half-width", "4"});
  for (const std::string name : {"pearl.nii", "pearl.nii.gz"}) {
    const Json json = converted(folder, {"two.vdb", "--layer", "pearl", "-o", name});
    EXPECT_EQ(json["values"], "signed distance, mm");
    const std::vector<double> n = told("image", folder.path(name));
    ASSERT_EQ(n.size(), 18U);
    EXPECT_NEAR(n[0], -2.0, 0.01);  // the band's 4 voxels
    EXPECT_NEAR(n[1], 2.0, 0.01);
    EXPECT_NEAR(n[2], ballVolume(6.0), 0.02 * ballVolume(6.0));
    EXPECT_NEAR(n[3], 10.0, 0.01);
    EXPECT_NEAR(n[4], 20.0, 0.01);
    EXPECT_NEAR(n[5], 30.0, 0.01);
  }
}

/// Two labels that touch, a ball cut by a plane, in an oblique, stretched image.
vdb::test::NiftiFile slanted() {
  vdb::test::NiftiFile file;
  file.dim = {40, 44, 30};
  const double c = std::cos(0.4);
  const double s = std::sin(0.4);
  file.sform = {{{c, -s, 0, -12}, {s, c, 0, 5}, {0, 0, 1.5, -20}}};
  file.pixdim = {1, 1, 1, 1.5};
  for (int k = 0; k < 30; ++k) {
    for (int j = 0; j < 44; ++j) {
      for (int i = 0; i < 40; ++i) {
        const double radius = std::hypot(i - 20.0, j - 22.0, 1.5 * (k - 15.0));
        file.values.push_back(radius > 15.0 ? 0 : (i < 20 ? 3 : 7));
      }
    }
  }
  return file;
}

void writeImage(const TempFolder& folder, const std::string& name,
                const vdb::test::NiftiFile& file) {
  const auto bytes = vdb::test::bytesOf(file);
  (void)folder.file(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

TEST(ConvertFiles, ALabelScanBecomesAGridForEachLabel) {
  const TempFolder folder;
  writeImage(folder, "labels.nii", slanted());
  (void)folder.file("names.txt", "3 left\n7 right\n");
  (void)converted(folder,
                  {"labels.nii", "-o", "l.vdb", "--labels", "left,right", "--names", "names.txt"});
  EXPECT_EQ(gridsOf(folder, "l.vdb"),
            (std::vector<std::string>{"left/surface", "right/surface", "united"}));
  double sum = 0.0;
  for (const std::string layer : {"left", "right"}) {
    (void)converted(folder, {"l.vdb", "--layer", layer, "-o", layer + ".ply"});
    const MeshFile mesh = meshFile(folder.path(layer + ".ply"));
    EXPECT_EQ(mesh.open_edges, 0.0);
    EXPECT_GT(mesh.volume, 0.4 * ballVolume(15.0));
    sum += mesh.volume;
  }
  // Within a third of a voxel of 1 x 1 x 1.5 mm all around. Other tests check the accuracy of
  // labels; this one checks that all labels arrive, in the right size.
  EXPECT_NEAR(sum, ballVolume(15.0), 0.06 * ballVolume(15.0));
}

TEST(ConvertFiles, AMaskBecomesAGrid) {
  const TempFolder folder;
  vdb::test::NiftiFile mask = slanted();
  for (double& value : mask.values) value = value > 0.0 ? 1.0 : 0.0;
  writeImage(folder, "mask.nii", mask);
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--labels", "1"}, std::vector<std::string>{"--above", "0.5"}}) {
    std::vector<std::string> arguments{"mask.nii", "-o", "mask.vdb", "--force"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    (void)converted(folder, arguments);
    ASSERT_EQ(gridsOf(folder, "mask.vdb").size(), 1U);
    (void)converted(folder, {"mask.vdb", "-o", "mask.stl", "--force"});
    EXPECT_NEAR(meshFile(folder.path("mask.stl")).volume, ballVolume(15.0),
                0.04 * ballVolume(15.0));
  }
  // The place in the world is preserved: the middle of the image's voxel (20, 22, 15).
  (void)converted(folder, {"mask.nii", "-o", "ball.nii.gz", "--above", "0.5"});
  const std::vector<double> n = told("image", folder.path("ball.nii.gz"));
  ASSERT_EQ(n.size(), 18U);
  EXPECT_NEAR(n[2], ballVolume(15.0), 0.03 * ballVolume(15.0));
  EXPECT_NEAR(n[3], 20.0 * std::cos(0.4) - 22.0 * std::sin(0.4) - 12.0, 0.1);
  EXPECT_NEAR(n[4], 20.0 * std::sin(0.4) + 22.0 * std::cos(0.4) + 5.0, 0.1);
  EXPECT_NEAR(n[5], 1.5 * 15.0 - 20.0, 0.1);
}

/// Grids as python3-openvdb writes them: the ball about (1, 2, 3) mm with radius 6 mm.
class ConvertGrids : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home = new TempFolder;
    const std::string command = "/usr/bin/python3 '" + test::sourceFolder() +
                                "/tests/vdb/vdb_interop.py' '" + folder().path() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  static void TearDownTestSuite() {
    delete home;
    home = nullptr;
  }
  static const TempFolder& folder() { return *home; }

  /// `share`: tolerance of the volume; `far` [mm]: tolerance of the ball's ends.
  static void expectBall(const std::string& name, double share, double far = 0.1) {
    const MeshFile mesh = meshFile(folder().path(name));
    EXPECT_EQ(mesh.open_edges, 0.0) << name;
    EXPECT_NEAR(mesh.volume, ballVolume(6.0), share * ballVolume(6.0)) << name;
    const double middle[3] = {1.0, 2.0, 3.0};
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(mesh.lo[axis], middle[axis] - 6.0, far) << name;
      EXPECT_NEAR(mesh.hi[axis], middle[axis] + 6.0, far) << name;
    }
  }

  /// Converts `name`.vdb to a grid that can be touched, and that grid to a mesh of the ball.
  static void expectGrid(const std::string& name, const std::vector<std::string>& options,
                         double share, double far = 0.1) {
    SCOPED_TRACE(name);
    std::vector<std::string> arguments{name + ".vdb", "-o", name + "_new.vdb"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    (void)converted(folder(), arguments);
    const CommandResult check = runPalpate({"check", name + "_new.vdb", "--json"}, folder().path());
    EXPECT_EQ(check.exit_code, 0) << check.out;
    const Json json = parseOnly(check);
    const Json& grid = json["files"][0]["grids"][0];
    EXPECT_EQ(grid["class"], "level set");
    EXPECT_EQ(grid["half_width_voxels"], 6.0);
    EXPECT_EQ(grid["frame"], "world");
    EXPECT_NEAR(grid["volume_m3"], 1e-9 * ballVolume(6.0), share * 1e-9 * ballVolume(6.0));
    EXPECT_NEAR(grid["gradient"]["mean"], 1.0, 0.01);
    (void)converted(folder(), {name + "_new.vdb", "-o", name + ".stl"});
    expectBall(name + ".stl", share, far);
  }

 private:
  static TempFolder* home;
};
TempFolder* ConvertGrids::home = nullptr;

TEST_F(ConvertGrids, TurnedMirroredAndStretchedGridsAreStraightened) {
  expectGrid("turned", {}, 0.015);
  expectGrid("mirrored", {}, 0.015);
  expectGrid("stretched", {"--voxel", "0.5"}, 0.015);
}

TEST_F(ConvertGrids, DensitiesAndMasksGetASurface) {
  expectGrid("fog", {"--above", "0.5"}, 0.015);
  // A mask consists of whole voxels, here of 0.5 mm; it ends half a voxel before the ball where the
  // ball is widest.
  expectGrid("mask", {"--labels", "1"}, 0.05, 0.35);
}

TEST_F(ConvertGrids, OtherVoxelsAndAClass) {
  expectGrid("ball", {"--voxel", "0.4"}, 0.015);
  expectGrid("no_class", {"--level-set", "--voxel", "0.4"}, 0.015);
}

TEST_F(ConvertGrids, TurnedGridsBecomeMeshesAndTurnedImages) {
  for (const std::string name : {"turned", "stretched", "mirrored"}) {
    SCOPED_TRACE(name);
    (void)converted(folder(), {name + ".vdb", "-o", name + ".ply"});
    expectBall(name + ".ply", 0.015);
    const Json json = converted(folder(), {name + ".vdb", "-o", name + ".nii.gz"});
    EXPECT_EQ(json["values"], "signed distance, mm");
    const std::vector<double> n = told("image", folder().path(name + ".nii.gz"));
    ASSERT_EQ(n.size(), 18U);
    EXPECT_NEAR(n[2], ballVolume(6.0), 0.02 * ballVolume(6.0));
    EXPECT_NEAR(n[3], 1.0, 0.02);
    EXPECT_NEAR(n[4], 2.0, 0.02);
    EXPECT_NEAR(n[5], 3.0, 0.02);
    // The axes are unchanged, without resampling: compare the rows of the affine.
    const double c = 0.5 * std::cos(std::numbers::pi / 6.0);
    const double first = name == "turned" ? c : (name == "mirrored" ? -0.5 : 0.5);
    EXPECT_NEAR(n[6], first, 1e-6);
    EXPECT_NEAR(n[7], name == "turned" ? -0.25 : 0.0, 1e-6);
    EXPECT_NEAR(n[16], name == "stretched" ? 0.7 : 0.5, 1e-6);
  }
}

TEST_F(ConvertGrids, AnInsideThatIsNotMarkedIsMarked) {
  // There must be no second wall where the band ends inside.
  const CommandResult made =
      runPalpate({"convert", "hollow.vdb", "-o", "marked.stl"}, folder().path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find("its inside was not marked"), std::string::npos) << made.err;
  expectBall("marked.stl", 0.015);
  (void)converted(folder(), {"hollow_turned.vdb", "-o", "hollow_turned.ply"});
  expectBall("hollow_turned.ply", 0.015);
  for (const std::string name : {"hollow", "hollow_turned"}) {
    (void)converted(folder(), {name + ".vdb", "-o", name + ".nii.gz"});
    const std::vector<double> n = told("image", folder().path(name + ".nii.gz"));
    EXPECT_NEAR(n[2], ballVolume(6.0), 0.02 * ballVolume(6.0)) << name;
    EXPECT_LT(n[0], -1.4) << name;  // the middle is 3 voxels inside
  }
  // A ball with a hollow of 2.5 mm: the wall around the hollow is inside, the hollow is not.
  (void)converted(folder(), {"nested.vdb", "-o", "nested.stl"});
  EXPECT_NEAR(meshFile(folder().path("nested.stl")).volume, ballVolume(6.0) - ballVolume(2.5),
              0.02 * ballVolume(6.0));
  expectGrid("hollow", {"--voxel", "0.4"}, 0.015);
  const CommandResult whole = runPalpate({"convert", "ball.vdb", "-o", "w.stl"}, folder().path());
  EXPECT_EQ(whole.err.find("inside"), std::string::npos) << whole.err;
}

/// A line for each active voxel of a grid: place and value, printed by python3-openvdb.
std::string bandOf(const std::string& path) {
  const std::string line =
      "/usr/bin/python3 -c \"import pyopenvdb, sys; g = pyopenvdb.readAll(sys.argv[1])[0][0]; "
      "print(*[(i.min, i.max, i.value) for i in g.iterOnValues()], sep='\\n'); "
      "print('middle', g.getConstAccessor().getValue((2, 4, 6)))\" '" +
      path + "'";
  FILE* pipe = popen(line.c_str(), "r");
  std::string text;
  char part[4096];
  while (pipe != nullptr && std::fgets(part, sizeof part, pipe) != nullptr) text += part;
  EXPECT_EQ(pclose(pipe), 0) << line;
  return text;
}

TEST_F(ConvertGrids, MarkingTheInsideKeepsTheBandToTheLastBit) {
  (void)converted(folder(), {"hollow.vdb", "-o", "marked.vdb"});
  std::string before = bandOf(folder().path("hollow.vdb"));
  const std::string after = bandOf(folder().path("marked.vdb"));
  const std::size_t at = before.find("middle 1.5");
  ASSERT_NE(at, std::string::npos);
  before.replace(at, 10, "middle -1.5");
  EXPECT_EQ(after, before);
  const CommandResult check = runPalpate({"check", "marked.vdb", "--json"}, folder().path());
  EXPECT_EQ(check.exit_code, 0) << check.out;
}

TEST_F(ConvertGrids, ABandWithHolesIsRefusedNamingThePlace) {
  for (const std::string output : {"t.stl", "t.nii.gz", "t.vdb"}) {
    const CommandResult torn =
        runPalpate({"convert", "torn.vdb", "-o", output, "--json"}, folder().path());
    EXPECT_EQ(torn.exit_code, 3) << torn.out;
    const Json error = Json::parse(torn.out, nullptr, false);
    EXPECT_EQ(error["error"]["code"], "vdb.torn") << torn.out;
    EXPECT_NE(torn.out.find("one at ("), std::string::npos) << torn.out;
    EXPECT_FALSE(std::filesystem::exists(folder().path(output)));
  }
}

TEST_F(ConvertGrids, RefusesWithTheOptionThatHelps) {
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    const char* says;
  } cases[] = {
      {{"fog.vdb", "-o", "a.stl"}, 3, "--above"},
      {{"no_class.vdb", "-o", "a.stl"}, 3, "--level-set"},
      {{"mask.vdb", "-o", "a.vdb"}, 3, "--labels"},
      {{"no_unit.vdb", "-o", "a.stl"}, 3, "unit"},
      {{"no_unit.vdb", "-o", "a.vdb", "--above", "0"}, 3, "unit"},
      {{"vectors.vdb", "-o", "a.vdb", "--units", "mm"}, 3, "vector"},
      {{"empty.vdb", "-o", "a.vdb", "--voxel", "1"}, 3, "no voxels"},
      {{"ball.vdb", "-o", "a.vdb"}, 2, "--voxel"},
      {{"ball.vdb", "-o", "a.vdb", "--voxel", "0"}, 2, "greater than 0"},
      {{"ball.vdb", "-o", "a.vdb", "--sign", "flood", "--voxel", "1"}, 2, "--sign"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments = c.arguments;
    arguments.insert(arguments.begin(), "convert");
    const CommandResult result = runPalpate(arguments, folder().path());
    EXPECT_EQ(result.exit_code, c.exit_code) << c.arguments[0] << ": " << result.err;
    EXPECT_NE(result.err.find(c.says), std::string::npos) << c.says << " in: " << result.err;
  }
}

}  // namespace
}  // namespace palpate::testing
