#pragma once
/// HapticRenderer: HIP in, force out, one tick at a time. The scene is shared and const. Only two
/// things change from tick to tick: the RendererState that a renderer owns, and the changes made to
/// contents.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/export.h"
#include "palpate/interior/port.h"
#include "palpate/scene/scene.h"

namespace palpate {

struct TickState;

/// What the device measures at one tick.
struct HipState {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] the haptic interface point P
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] by the estimator that the caller chooses
  double dt = 1e-3;              ///< [s] since the last tick; used by limits and by relaxation
};

/// How the proxy went through a port.
struct PortCrossing {
  /// The reason why the port let the proxy through.
  enum class How : std::uint8_t {
    kOpen,      ///< the port stood open
    kPuncture,  ///< its wall gave way to the force; a port that makes holes has made a new one here
    kHole,      ///< by a hole made before, at its reopening force
  };
  PortId port = 0;            ///< the port passed
  RegionId from = kOutside;   ///< the region that the proxy left
  RegionId to = kOutside;     ///< the region that it entered
  How how = How::kOpen;       ///< why the port let the proxy through
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] where the surface was crossed
  /// [-, world] of the surface there, pointing back to where the proxy came from; zero where the
  /// surface has none
  Vec3 normal{0.0, 0.0, 0.0};
  double force = 0.0;  ///< [N] elastic normal force that it gave way to; 0 where it stood open
};

/// How the proxy got from one region into the next: through a port, or across a wall that is
/// absent.
struct RegionEntry {
  RegionId from = kOutside;   ///< the region that the proxy left
  RegionId to = kOutside;     ///< the region that it entered
  int port = -1;              ///< PortId; -1: an absent wall
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] of the wall, where it was crossed
  Vec3 normal{0.0, 0.0,
              0.0};  ///< [-, world] of the wall there, pointing to `from`; zero where it has none
  double force =
      0.0;  ///< [N] elastic normal force that the wall gave way to; 0 where none was needed
  double cut =
      0.0;  ///< [N] cutting force of the content of `from` on the way there; 0 without a needle
  double hole_radius = 0.0;  ///< [m] Port::hole_radius
};

/// Result of one tick.
struct TickResult {
  /// The largest number of crossings in one tick; any more are made in the next tick.
  static constexpr std::size_t kMaxEvents = 32;
  static_assert(kMaxEvents <= 255, "event_count counts them");

  Vec3 force{0.0, 0.0, 0.0};   ///< [N, world] on the hand; always finite
  Vec3 proxy{0.0, 0.0, 0.0};   ///< [m, world] the tip held in its region
  RegionId region = kOutside;  ///< of the proxy, at the end of the tick
  bool contact = false;        ///< a closed wall is pressed
  /// The proxy rests where it is closest to the hand, within the stated tolerances (the paper's
  /// renderer: always true). False: the budget of the tick ran out while the proxy was on its way
  /// there; it is at a permitted point that is not further from the hand than the last one.
  bool settled = true;
  std::uint8_t event_count = 0;  ///< crossings of this tick that passed a port, in path order
  /// Ports passed, in path order; entries from event_count on mean nothing.
  std::array<PortId, kMaxEvents> events{};
};

/// How the force of a tick changes when the hand moves. A component that is not known is 0.
struct ForceSlope {
  Vec3 normal{0.0, 0.0,
              0.0};        ///< [-] unit, out of the wall that is pressed; zero: no wall is pressed
  double stiffness = 0.0;  ///< [N/m] against a motion along `normal`
  double sideways = 0.0;   ///< [N/m] against a motion across `normal`, from a wall that sticks
  double damping = 0.0;    ///< [N s/m] along `normal`
  double drag = 0.0;       ///< [N s/m] along any direction
};

/// A limit that is NaN or below 0 permits nothing: the force is then zero, or cannot grow.
struct ForceLimits {
  double max_force = kInfinity;   ///< [N] longer forces are shortened to it, direction kept
  double max_growth = kInfinity;  ///< [N/s] the slew rate; see ForceGuard::apply()
  double ramp = 0.0;              ///< [s] from zero to full force after the first tick; 0: none
  /// [s] the nominal time from tick to tick. A longer one (a gap, a late tick) counts as this, so
  /// that what one tick may bring is max_growth * period at most, whatever the clock says.
  double period = 1e-3;

  /// These limits; where one is not set, that of the scene.
  [[nodiscard]] ForceLimits over(const ForceRequest& scene) const noexcept {
    ForceLimits out = *this;
    if (out.max_force == kInfinity) out.max_force = scene.max.value_or(kInfinity);
    if (out.max_growth == kInfinity) out.max_growth = scene.slew.value_or(kInfinity);
    if (out.ramp == 0.0) out.ramp = scene.ramp.value_or(0.0);
    return out;
  }
};

/// What a region's content feels like from now on, everywhere in the region, instead of what the
/// scene states. Members without a value leave it as the scene has it.
struct ContentChange {
  std::optional<double> viscosity = {};  ///< [N s/m] 0 or more
  std::optional<Vec3> flow = {};         ///< [m/s]
  std::optional<double> lattice_force =
      {};                              ///< [N] 0 to the most that the material's lattice permits
  std::optional<double> cutting = {};  ///< [N] 0 or more; needs a material with stiffness
};

/// Whether a renderer of `scene` accepts `change` for the content of `region`: the answer that
/// HapticRenderer::setContent() would give. For set-up: it allocates.
[[nodiscard]] PALPATE_EXPORT bool canChangeContent(const Scene& scene, RegionId region,
                                                   const ContentChange& change);

/// The choice of a renderer and its parameters; for makeRenderer().
struct RendererSettings {
  std::optional<RendererKind> kind = {};  ///< no value: as the scene states
  PaperParameters paper = {};  ///< paper's renderer only; takes precedence over the scene's own
  ForceLimits limits = {};     ///< none unless asked for, so that closed forms hold
};

/// All that one tick of a renderer leaves for the next. This value and the scene together determine
/// the renderer: a copy is a snapshot, and handing it back rewinds. It has a fixed size and is
/// copied in about a microsecond. Its contents are private to the renderer, and a stored state is
/// valid only for the build that made it. A scene that needs more room than there is (65 535 smooth
/// surfaces, 128 ports that some `after` names) is refused when it is compiled.
class PALPATE_EXPORT RendererState {
 public:
  /// The state before any scene: HapticRenderer::setState() takes it for a first tick.
  RendererState() noexcept;

  /// A number that differs between builds whose states have a different layout; for files of
  /// states.
  [[nodiscard]] static std::uint64_t layout() noexcept;

 private:
  friend struct TickState;
  static constexpr std::size_t kBytes = std::size_t{24} * 1024;

  explicit RendererState(const TickState& state) noexcept;

  alignas(8) std::array<std::byte, kBytes> bytes_{};
};
static_assert(std::is_trivially_copyable_v<RendererState>);

/// One algorithm of haptic rendering. Construction may throw and allocate; all else never
/// allocates, locks, throws or blocks, and belongs to one thread at a time.
class PALPATE_EXPORT HapticRenderer {
 public:
  /// [m] The hand is never that far away: such a position comes from a broken sensor. Beyond it
  /// double precision no longer distinguishes the two sides of a wall along the way there.
  static constexpr double kFarthest = 1e4;
  /// False beyond kFarthest, and for NaN.
  [[nodiscard]] static bool isInReach(const Vec3& p) noexcept {
    return std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest &&
           std::fabs(p.z) <= kFarthest;
  }

  virtual ~HapticRenderer() = default;
  HapticRenderer(const HapticRenderer&) = delete;
  HapticRenderer& operator=(const HapticRenderer&) = delete;

  /// One tick. A non-finite position or velocity, or a position more than kFarthest from the origin
  /// in any coordinate, gives zero force and changes no state; the next good tick goes on from
  /// where the proxy was. The force is finite and within the limits.
  [[nodiscard]] virtual TickResult update(const HipState& hip) noexcept = 0;

  /// The crossings of the last update(), in path order, one for each of TickResult::events. Valid
  /// until the next update().
  [[nodiscard]] virtual std::span<const PortCrossing> crossings() const noexcept = 0;

  /// The regions that the proxy came into in the last update(), in path order: each layer that it
  /// went through, however many there were. The last one is TickResult::region, if there is any.
  /// Valid until the next update().
  [[nodiscard]] virtual std::span<const RegionEntry> entries() const noexcept = 0;

  /// From the next tick on, the content of `region` feels as `change` says; the force may jump.
  /// Returns false, and changes nothing, for an unknown region or a value out of its range.
  /// Real-time safe, to be called on the thread of update(). The change survives reset(); an empty
  /// change takes it back.
  [[nodiscard]] virtual bool setContent(RegionId region, const ContentChange& change) noexcept = 0;

  /// [N, world] The force of the last update() before its limits; zero if that update kept the
  /// previous state.
  [[nodiscard]] virtual const Vec3& unlimitedForce() const noexcept = 0;

  /// The slope at the last update(), which was called with `hip`: for a coupling between the hand
  /// and the tool. A spring that is not linear counts with the highest slope it can have at its
  /// present force; lattices and needles count as if their force did not change. By default nothing
  /// is known.
  [[nodiscard]] virtual ForceSlope slope(const HipState& hip) const noexcept;

  /// [J] Work done on the hand, from the first tick to the last, by those things that are sources
  /// of energy by nature: flows, lattices whose potential differs where a region is entered and
  /// left, and walls that give way while the hand is so far ahead that the next wall it presses
  /// stores more energy than they did. A hand that got no more energy than this from the renderer
  /// met a passive world. Counted before the limits of the force.
  [[nodiscard]] virtual double sourceWork() const noexcept = 0;

  /// Back to the start region, with no port passed and no hole made; the next update() is a first
  /// tick.
  virtual void reset() noexcept = 0;

  /// Everything that the last tick left for the next.
  [[nodiscard]] virtual RendererState state() const noexcept = 0;
  /// The same state, and from here this renderer goes on exactly, bit for bit, as any other
  /// renderer does that is given it: it discards its knowledge of the leaves around the proxy and
  /// finds them anew in the next tick.
  [[nodiscard]] virtual RendererState checkpoint() noexcept = 0;
  /// Goes on from `state` as the renderer that it was taken from would: bit for bit if the state
  /// comes from checkpoint(). Otherwise the two may differ by rounding, since the knowledge of the
  /// leaves around the proxy is not in the state, and it decides which leaves are evaluated again.
  /// Returns false, and changes nothing, if `state` cannot be a state of this scene and of this
  /// kind of renderer. Every number in it that stands for a part of the scene is checked, and
  /// update() is safe with any state that is accepted. Changes by setContent() are not part of the
  /// state. Until the next tick crossings() and entries() are empty.
  [[nodiscard]] virtual bool setState(const RendererState& state) noexcept = 0;

 protected:
  HapticRenderer() = default;
};

/// @throws Error (kInput) if the scene is null, the kind of renderer is unknown, or the scene needs
/// what the paper's renderer cannot do.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<HapticRenderer> makeRenderer(
    ScenePtr scene, RendererSettings settings = {});

/// A state carried over into a scene that was edited: regions and ports are matched by their names.
struct CarriedState {
  RendererState state;  ///< of the other scene: for HapticRenderer::setState()
  /// True: the probe is where it was. False: it starts anew, in the start region, with no port
  /// passed and with the ramp of its limits.
  bool goes_on = false;
  /// What could not be carried over, in words: the probe's region, or its place in it; ports that
  /// were passed, have holes or wait for their `rearm` distance; the whole state, if it is not one
  /// of `from` and of that kind of renderer.
  std::vector<std::string> lost;
};

/// The state in the scene `to` that corresponds to `state`, which is of a renderer of `kind` in the
/// scene `from`. The proxy goes on if the scene `to` has a region of that name that still contains
/// the proxy's place (for the paper's renderer the name is enough: its state is not where the HIP
/// is). Carried over are: ports passed, how often and which way; the holes made, and the ports that
/// wait for their `rearm` distance; the friction anchor; how far the wall that is pressed has
/// relaxed; how far the content behind the opening that the proxy came by has faded in, if that
/// opening's surface is still at its place; and the work of sources. A needle's cut and the anchors
/// that hold it begin anew, so the force may jump; the limits of the force take care of that. For
/// set-up, between two ticks: it allocates.
[[nodiscard]] PALPATE_EXPORT CarriedState carryState(const RendererState& state, RendererKind kind,
                                                     const Scene& from, const Scene& to);

}  // namespace palpate
