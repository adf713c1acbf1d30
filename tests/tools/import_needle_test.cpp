// palpate import: the sideways support of a needle's shaft in a scene that was made from a scan.

#include <cmath>
#include <functional>
#include <numbers>

#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

using vdb::test::bytesOf;
using vdb::test::gzipped;
using vdb::test::NiftiFile;

void writeImage(const TempFolder& folder, const std::string& name,
                const std::function<double(double)>& label) {
  NiftiFile file;
  file.dim = {41, 41, 41};
  file.sform = {{{1, 0, 0, -20}, {0, 1, 0, -20}, {0, 0, 1, -20}}};
  file.pixdim = {1, 1, 1, 1};
  file.datatype = 16;  // float
  for (int k = -20; k <= 20; ++k) {
    for (int j = -20; j <= 20; ++j) {
      for (int i = -20; i <= 20; ++i) file.values.push_back(label(std::hypot(i, j)));
    }
  }
  const auto bytes = gzipped(bytesOf(file));
  (void)folder.file(name,
                    std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// [N/m^2] Lateral stiffness for a solid steel rod in a tissue of Young's modulus `young` [Pa]
/// (Vesic 1961, with tissue on both sides of the rod).
double vesic(double young) {
  constexpr double kSteel = 193e9;
  constexpr double kNu = 0.45;
  return 1.3 * std::pow(64.0 * young / (std::numbers::pi * kSteel), 1.0 / 12.0) * young /
         (1.0 - kNu * kNu);
}

/// Imports a leg along z: muscle within 13 mm of the axis, fat and skin within 18 mm around it.
std::string importedLeg(const TempFolder& folder) {
  writeImage(folder, "leg.nii.gz", [](double r) { return r < 13 ? 1 : 0; });
  writeImage(folder, "body.nii.gz", [](double r) { return r < 18 ? 1 : 0; });
  (void)folder.file("names.csv", "value,name\n1,vastus muscle\n");
  const CommandResult made = runPalpate(
      {"import", "leg.nii.gz", "--names", "names.csv", "--body", "body.nii.gz", "-o", "leg.yaml"},
      folder.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  return textOf(folder.path("leg.yaml"));
}

/// The number before ` unit` in the first `key` of the material `name`.
double numberOf(const std::string& scene, const std::string& name, const std::string& key) {
  const std::size_t material = scene.find("\n  " + name + ": {");
  const std::size_t at = scene.find(key, material);
  EXPECT_NE(material, std::string::npos);
  EXPECT_LT(at, scene.find('\n', material + 1));
  return at == std::string::npos ? 0.0 : std::stod(scene.substr(at + key.size()));
}

TEST(ImportNeedle, EveryTissueThatCanBeCutHoldsTheShaftByVesicsModulus) {
  const TempFolder folder;
  const std::string scene = importedLeg(folder);
  const std::string stiffness = "lateral: {stiffness: ";
  // Young's moduli are those of data/materials/tissues.yaml; that of skin follows from its wall's
  // 400 N/m at a tip of 1 mm. Three digits are written.
  EXPECT_NEAR(numberOf(scene, "muscle", stiffness) / vesic(62.2e3), 1.0, 5e-3);
  EXPECT_NEAR(numberOf(scene, "fat", stiffness) / vesic(26.1e3), 1.0, 5e-3);
  const double skin = 400.0 * (1.0 - 0.45 * 0.45) / 2e-3;
  EXPECT_NEAR(numberOf(scene, "skin", stiffness) / std::min(9e4, vesic(skin)), 1.0, 5e-3);
  // Each tissue tears at its cutting force divided by the tip's 2 mm.
  EXPECT_NEAR(numberOf(scene, "muscle", "strength: "), 300.0, 0.5);
  EXPECT_NEAR(numberOf(scene, "fat", "strength: "), 100.0, 0.5);
  EXPECT_NE(scene.find("#   shaft, sideways, "), std::string::npos);
  EXPECT_NE(scene.find("derived: k = 1.3 (E d^4 / (E_n I))^(1/12) E / (1 - nu^2) (Vesic 1961"),
            std::string::npos);
}

TEST(ImportNeedle, ATableWithoutAShaftsModulusHasNothingSideways) {
  const TempFolder folder;
  (void)importedLeg(folder);
  (void)folder.file("plain.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: x}
stiffest: {value: 2000 N/m, basis: assumed, source: x}
shaft_spring: {value: 3e4 N/m^2, basis: assumed, source: x}
tissues:
  all:
    labels: ["*"]
    stiffness: {value: 1000 N/m, basis: assumed, source: x}
    opens_at: {value: 1 N, basis: assumed, source: x}
    cutting: {value: 0.5 N, basis: assumed, source: x}
    shaft: {value: 40 N/m, basis: assumed, source: x}
)");
  ASSERT_EQ(
      runPalpate({"import", "leg.nii.gz", "--materials", "plain.yaml", "-o", "plain_leg.yaml"},
                 folder.path())
          .exit_code,
      0);
  EXPECT_EQ(textOf(folder.path("plain_leg.yaml")).find("lateral"), std::string::npos);
}

/// z component of the force on the hand [N] at the end of a path straight in and then sideways; and
/// y [mm] of the proxy where it entered fat and muscle, and at the end.
struct Walked {
  double force = 0.0;
  std::vector<double> y;
};

Walked walked(const TempFolder& folder, const std::string& scene) {
  Walked out;
  // The path leads along y, and then by 2 mm along z.
  const CommandResult touch = runPalpate({"touch", scene, "--insert", "0,30,0", "0,-2,0", "0,-2,2",
                                          "--speed", "10mm/s", "--trace", scene + ".csv"},
                                         folder.path());
  EXPECT_EQ(touch.exit_code, 0) << touch.err;
  std::string last;
  double y = 0.0;
  for (const std::string& row : linesOf(textOf(folder.path(scene + ".csv")))) {
    const std::vector<std::string> cells = cellsOf(row);
    if (cells[0] == "time_s" || cells.size() < 11 || row[0] < '0' || row[0] > '9') continue;
    // Before the tip goes through a wall it rests on it.
    if (!last.empty() && cells[10] != last) out.y.push_back(y);
    last = cells[10];
    y = std::stod(cells[5]) * 1e3;
    out.force = std::stod(cells[9]);
  }
  out.y.push_back(y);
  return out;
}

TEST(ImportNeedle, ANeedleThatIsWalkedSidewaysIsHeld) {
  const TempFolder folder;
  std::string scene = importedLeg(folder);
  const Walked held = walked(folder, "leg.yaml");
  ASSERT_EQ(held.y.size(), 3u);
  for (std::size_t at = scene.find(", lateral: {"); at != std::string::npos;
       at = scene.find(", lateral: {")) {
    scene.erase(at, scene.find('}', at) + 1 - at);
  }
  (void)folder.file("free.yaml", scene);
  const Walked free = walked(folder, "free.yaml");
  // tools/docs/scene.md: from s0 to s1 below the hole a tissue holds the tip by k (s1^3 - s0^3) /
  // (3 L) sin(angle), perpendicular to the needle. The cutting force at the tip is the same in both
  // runs.
  const double to_muscle = (held.y[0] - held.y[1]) * 1e-3;
  const double length = std::hypot((held.y[0] - held.y[2]) * 1e-3, 2e-3);
  const double angle = std::asin(2e-3 / length);
  const double muscle_from = to_muscle / std::cos(angle);
  const auto share = [&](double from, double to) {
    return (to * to * to - from * from * from) / (3.0 * length);
  };
  const double expected =
      (vesic(26.1e3) * share(0.0, muscle_from) + vesic(62.2e3) * share(muscle_from, length)) *
      std::sin(angle) * std::cos(angle);
  std::printf("  sideways %.3f N, without %.3f N, by the formula %.3f N more\n", held.force,
              free.force, expected);
  EXPECT_GT(expected, 0.1);
  // 3 %: the needle gets 0.5 % longer as it rotates, which counts with the third power, and the
  // force at the tip rotates with it.
  EXPECT_NEAR(std::fabs(held.force - free.force), expected, 0.03 * expected);
}

}  // namespace
}  // namespace palpate::testing
