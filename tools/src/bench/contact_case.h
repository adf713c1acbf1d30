#pragma once
/// A contact case: a scene, a hand's path through it, and where a perfect proxy would be.

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

inline constexpr double kApproachSpeed = 0.05;  ///< [m/s] of the way to where it is judged, at most
inline constexpr double kWallStiffness = 1000.0;  ///< [N/m] of every case's only wall

/// Where the proxy should be at each tick [m]; not given where the tick is not judged.
using Truth = std::vector<std::optional<Vec3>>;

/// Makes the truth for a path; `run` is what the renderer did, for judges that start from its
/// proxy.
using Judge = std::function<Truth(std::span<const Vec3> path, std::span<const TickResult> run,
                                  const Progress& progress)>;

struct ContactCase {
  ScenePtr scene;
  std::vector<Vec3> path = {};  ///< [m] of the HIP, one a tick
  std::size_t first = 0;        ///< judged and timed are the ticks from here ...
  std::size_t end = 0;          ///< ... to before here; the others lead in and out
  Judge judge;
};

/// A case that can be made: making one may take seconds (bakes, thousands of primitives).
struct CaseEntry {
  std::string name;
  std::string about;
  std::function<ContactCase()> make;
};

/// Every case, in the order in which they are shown.
[[nodiscard]] const std::vector<CaseEntry>& contactCases();

/// Five nested layers out of grids of 1 mm, every parameter of their materials a grid of 2 mm: a
/// needle goes through three of them to the bone, along it, out, and along the skin. Not judged.
[[nodiscard]] ContactCase fiveLayers();

/// The lump of data/scenes/lump.yaml, stroked over through the closed skin at 0.2 m/s. Not judged.
[[nodiscard]] ContactCase lumpUnderSkin();

/// Corners, apexes and nested trees, felt from within: where several walls hold at once.
[[nodiscard]] ContactCase boxCorner();
/// Three balls at a point; `hollow`: all felt from within, else one from within and two from
/// outside.
[[nodiscard]] ContactCase threeBalls(bool hollow);
/// [radians] between the axis of a hollow cone and its side; felt about its tip.
[[nodiscard]] ContactCase coneTip(double half_angle);
[[nodiscard]] ContactCase nestedCsg();

enum class StartIn { kOutside, kSolid };

/// A scene of one layer `solid` with a wall of kWallStiffness, without friction and damping.
[[nodiscard]] ScenePtr solidScene(FieldPtr field, StartIn start = StartIn::kOutside);

/// A path that comes in from `start`, follows the curve and stops; judged is what follows the
/// curve.
[[nodiscard]] ContactCase along(ScenePtr scene, const Vec3& start, const Curve& curve, double from,
                                double to, double speed, Judge judge);

/// Judged by formula: the minimum nearest to the true proxy of the tick before.
[[nodiscard]] Judge judgeByFormula(std::function<oracle::Minima(const Vec3& hip)> minima);

/// Judged by the oracle (tools/support/oracle), at every `stride`-th tick. The set is as the region
/// of that tick has it.
[[nodiscard]] Judge judgeByOracle(oracle::FeasibleSet allowed, std::size_t stride);

}  // namespace palpate::tools
