#pragma once
/// A contact case: a scene, the path of a hand through it, and where a perfect proxy would be.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/path.h"
#include "palpate/core/progress.h"
#include "palpate/render/haptic_renderer.h"
#include "support/oracle/closed_forms.h"
#include "support/oracle/feasible_set.h"

namespace palpate::tools {

/// [m/s] Largest speed on the way to the judged part
inline constexpr double kApproachSpeed = 0.05;
/// [N/m] Stiffness of the only wall of every case
inline constexpr double kWallStiffness = 1000.0;

/// Where the proxy should be at each tick [m]; not given where the tick is not judged.
using Truth = std::vector<std::optional<Vec3>>;

/// Computes the truth for a path; `run` is the renderer's own result, for judges that start from
/// its proxy.
using Judge = std::function<Truth(std::span<const Vec3> path, std::span<const TickResult> run,
                                  const Progress& progress)>;

struct ContactCase {
  ScenePtr scene;
  std::vector<Vec3> path = {};  ///< [m] of the HIP, one point a tick
  std::size_t first = 0;        ///< the ticks from here ...
  std::size_t end = 0;  ///< ... to before here are judged and timed; the others lead in and out
  Judge judge;
};

/// Makes a case on demand: that may take seconds (bakes, thousands of primitives).
struct CaseEntry {
  std::string name;
  std::string about;
  std::function<ContactCase()> make;
};

/// All cases, in the order in which they are shown.
[[nodiscard]] const std::vector<CaseEntry>& contactCases();

/// Five nested layers made of grids of 1 mm, with every material parameter a grid of 2 mm. A needle
/// goes through three of them to the bone, along the bone, out, and along the skin. Not judged.
[[nodiscard]] ContactCase fiveLayers();

/// The lump of data/scenes/lump.yaml, felt by strokes over the closed skin at 0.2 m/s. Not judged.
[[nodiscard]] ContactCase lumpUnderSkin();

/// Corners, apexes and nested trees, felt from within: several walls hold the proxy at once.
[[nodiscard]] ContactCase boxCorner();
/// Three balls that meet at a point; `hollow`: all are felt from within; otherwise one from within
/// and two from outside.
[[nodiscard]] ContactCase threeBalls(bool hollow);
/// [radians] `half_angle` is the angle between the axis of a hollow cone and its side; the cone is
/// felt about its tip.
[[nodiscard]] ContactCase coneTip(double half_angle);
[[nodiscard]] ContactCase nestedCsg();

enum class StartIn { kOutside, kSolid };

/// A scene of one layer, `solid`, whose wall has the stiffness kWallStiffness and neither friction
/// nor damping.
[[nodiscard]] ScenePtr solidScene(FieldPtr field, StartIn start = StartIn::kOutside);

/// A path that comes in from `start`, follows the curve and stops; the part along the curve is
/// judged.
[[nodiscard]] ContactCase along(ScenePtr scene, const Vec3& start, const Curve& curve, double from,
                                double to, double speed, Judge judge);

/// Judges by formula: the truth is the minimum nearest to the true proxy of the tick before.
[[nodiscard]] Judge judgeByFormula(std::function<oracle::Minima(const Vec3& hip)> minima);

/// Judges every `stride`-th tick by the oracle (tools/support/oracle). `allowed` is the set of
/// points where the proxy may be, the same for all ticks.
[[nodiscard]] Judge judgeByOracle(oracle::FeasibleSet allowed, std::size_t stride);

}  // namespace palpate::tools
