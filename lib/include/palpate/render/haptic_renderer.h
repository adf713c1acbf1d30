#pragma once
/// HapticRenderer: HIP in, force out, one tick at a time. The scene is shared and const; all that
/// changes from tick to tick is the RendererState that a renderer owns, and what was changed of the
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

/// What the device says at one tick.
struct HipState {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] the haptic interface point P
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] by whatever estimator the caller names
  double dt = 1e-3;              ///< [s] since the last tick; for limits, and what relaxes in time
};

/// How the proxy went through a port.
struct PortCrossing {
  enum class How : std::uint8_t {
    kOpen,      ///< the port stood open
    kPuncture,  ///< its wall gave way to the force; a port that makes holes has a new one here
    kHole,      ///< by a hole made before, at its reopening force
  };
  PortId port = 0;
  RegionId from = kOutside;
  RegionId to = kOutside;
  How how = How::kOpen;
  Vec3 point{0.0, 0.0, 0.0};   ///< [m, world] where the surface was crossed
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-, world] of the surface there, back to where the proxy came
                               ///< from; zero where the surface has none
  double force = 0.0;  ///< [N] elastic normal force that it gave way to; 0 where it stood open
};

/// How the proxy got from one region into the next: through a port, or across a wall that is
/// absent.
struct RegionEntry {
  RegionId from = kOutside;
  RegionId to = kOutside;
  int port = -1;              ///< PortId; -1: an absent wall
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] of the wall, where it was crossed
  Vec3 normal{0.0, 0.0,
              0.0};  ///< [-, world] of the wall there, back to `from`; zero where it has none
  double force =
      0.0;  ///< [N] elastic normal force that the wall gave way to; 0 where none was needed
  double cut =
      0.0;  ///< [N] what the content of `from` took to be cut through to there; 0 without a needle
  double hole_radius = 0.0;  ///< [m] Port::hole_radius
};

/// What one tick came to.
struct TickResult {
  /// Crossings that one tick can make; any more are made in the next tick.
  static constexpr std::size_t kMaxEvents = 32;
  static_assert(kMaxEvents <= 255, "event_count counts them");

  Vec3 force{0.0, 0.0, 0.0};  ///< [N, world] on the hand; always finite
  Vec3 proxy{0.0, 0.0, 0.0};  ///< [m, world] the tip held in its region
  RegionId region = kOutside;
  bool contact = false;  ///< a closed wall is pressed
  /// The proxy rests where it is closest to the hand, within the stated tolerances (the paper's
  /// renderer: always true); false: on its way there, at a point that is allowed and no further
  /// from the hand than the last one, out of budget.
  bool settled = true;
  std::uint8_t event_count = 0;  ///< crossings of this tick that passed a port, in path order
  std::array<PortId, kMaxEvents> events{};
};

/// How the force of a tick changes when the hand does. What is not known is 0.
struct ForceSlope {
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit, out of the wall that is pressed; zero: none is
  double stiffness = 0.0;      ///< [N/m] against a motion along `normal`
  double sideways = 0.0;       ///< [N/m] against one across it: of a wall that sticks
  double damping = 0.0;        ///< [N s/m] along `normal`
  double drag = 0.0;           ///< [N s/m] along any direction
};

/// A limit that is NaN or below 0 permits nothing: the force is then zero, or cannot grow.
struct ForceLimits {
  double max_force = kInfinity;   ///< [N] longer forces are shortened to it, direction kept
  double max_growth = kInfinity;  ///< [N/s] the slew rate; see ForceGuard::apply()
  double ramp = 0.0;              ///< [s] from zero to full force after the first tick; 0: none
  /// [s] the nominal time from tick to tick. A longer one (a gap, a late tick) counts as this, so
  /// that what one tick may bring is max_growth * period at most, whatever the clock says.
  double period = 1e-3;

  /// These, and those of a scene where these set no limit.
  [[nodiscard]] ForceLimits over(const ForceRequest& scene) const noexcept {
    ForceLimits out = *this;
    if (out.max_force == kInfinity) out.max_force = scene.max.value_or(kInfinity);
    if (out.max_growth == kInfinity) out.max_growth = scene.slew.value_or(kInfinity);
    if (out.ramp == 0.0) out.ramp = scene.ramp.value_or(0.0);
    return out;
  }
};

/// What to feel in a region from now on, in the place of what the scene says, everywhere in it.
/// What is not given is as the scene has it.
struct ContentChange {
  std::optional<double> viscosity = {};  ///< [N s/m] 0 or more
  std::optional<Vec3> flow = {};         ///< [m/s]
  std::optional<double> lattice_force =
      {};                              ///< [N] 0 to what the material's lattice may have at most
  std::optional<double> cutting = {};  ///< [N] 0 or more; needs a material with stiffness
};

/// Whether a renderer of `scene` takes `change` for the content of `region`: what
/// HapticRenderer::setContent() would answer. For set-up: it allocates.
[[nodiscard]] PALPATE_EXPORT bool canChangeContent(const Scene& scene, RegionId region,
                                                   const ContentChange& change);

struct RendererSettings {
  std::optional<RendererKind> kind = {};  ///< not given: as the scene says
  PaperParameters paper = {};             ///< paper's renderer only; goes before the scene's own
  ForceLimits limits = {};                ///< none unless asked for, so that closed forms hold
};

/// All that one tick of a renderer leaves for the next. Whoever has this value and the scene has
/// the renderer: copied it is a snapshot, given back it rewinds. A value of fixed size, copied in
/// about a microsecond, for the build that made it: what is in it is the renderer's own, and stored
/// it means nothing to another build. A scene that needs more room than there is (65 535 smooth
/// surfaces, 128 ports that some `after` names) is refused when it is compiled.
class PALPATE_EXPORT RendererState {
 public:
  /// That of no scene yet: HapticRenderer::setState() takes it for a first tick.
  RendererState() noexcept;

  /// A number that differs between builds whose states differ, for files of states.
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
  /// [m] No hand is that far away: such a position is a broken one. Beyond it double precision no
  /// longer tells one side of a wall from the other along the way there.
  static constexpr double kFarthest = 1e4;
  /// False beyond it, and for NaN.
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

  /// Each crossing of TickResult::events of the last update(), in path order. Valid until the next
  /// one.
  [[nodiscard]] virtual std::span<const PortCrossing> crossings() const noexcept = 0;

  /// The regions that the proxy came into in the last update(), in path order: each layer that it
  /// went through, however many there were. The last one is TickResult::region, if there is any.
  /// Valid until the next update().
  [[nodiscard]] virtual std::span<const RegionEntry> entries() const noexcept = 0;

  /// From the next tick on, the content of `region` feels as `change` says; what is felt may jump.
  /// False, and nothing is changed, for an unknown region or a value out of its range. Real-time
  /// safe, on the thread that update() is called on. It stays so after reset(); an empty change
  /// takes it back.
  [[nodiscard]] virtual bool setContent(RegionId region, const ContentChange& change) noexcept = 0;

  /// [N, world] The force of the last update() before its limits; zero if that held the last state.
  [[nodiscard]] virtual const Vec3& unlimitedForce() const noexcept = 0;

  /// Of the last update(), which was asked for `hip`: for a coupling between the hand and the tool.
  /// Springs that bend count at the highest slope that they can have for what they push with;
  /// lattices and needles count as if their force did not change. By default nothing is known.
  [[nodiscard]] virtual ForceSlope slope(const HipState& hip) const noexcept;

  /// [J] Work on the hand since the first tick, up to the last, of what is a source of energy by
  /// its nature: flows, lattices whose potential differs where a region is entered and left, and
  /// walls that give way while the hand is so far ahead that the next one it comes to press holds
  /// more than they did. A hand that got no more than this from the renderer met a passive world.
  /// Counted before the limits of the force.
  [[nodiscard]] virtual double sourceWork() const noexcept = 0;

  /// Back to the start region, with no port passed and no hole made; the next update() is a first
  /// tick.
  virtual void reset() noexcept = 0;

  /// All that the last tick left for the next.
  [[nodiscard]] virtual RendererState state() const noexcept = 0;
  /// The same, and this renderer goes on from it as each other does that is given it: bit for bit.
  /// What it knows of the leaves around the proxy it finds anew in the next tick.
  [[nodiscard]] virtual RendererState checkpoint() noexcept = 0;
  /// Goes on from `state` as the renderer that it was taken from would: bit for bit if that gave it
  /// by checkpoint(), else but for rounding, since its knowledge of the leaves around the proxy,
  /// which is not in the state, decides which of them it looks at once more. False, and nothing is
  /// changed, if it cannot be a state of this scene and of this kind of renderer; every number in
  /// it that stands for a part of the scene is looked at, and update() is safe with what is taken.
  /// Changes by setContent() are not part of it. Until the next tick crossings() and entries() are
  /// empty.
  [[nodiscard]] virtual bool setState(const RendererState& state) noexcept = 0;

 protected:
  HapticRenderer() = default;
};

/// @throws Error (kInput) if the scene is null, the kind of renderer is unknown, or it asks the
/// paper's renderer for what it cannot do.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<HapticRenderer> makeRenderer(
    ScenePtr scene, RendererSettings settings = {});

/// A state taken over into a scene that was edited: regions and ports are known again by their
/// names.
struct CarriedState {
  RendererState state;  ///< of the other scene: for HapticRenderer::setState()
  /// The probe is where it was. False: it starts anew, in the start region, with no port passed and
  /// with the ramp of its limits.
  bool goes_on = false;
  /// What the other scene does not have, in words: the probe's region, or its place in that; ports
  /// that were passed, and those whose walls have holes or that rest; a state that is not one of
  /// `from` and of that kind of renderer.
  std::vector<std::string> lost;
};

/// What `state`, of a renderer of `kind` of the scene `from`, comes to in the scene `to`. The proxy
/// goes on if its region is there by name and holds its place still (the paper's renderer asks for
/// the region only: its state is not where the HIP is). With it goes what was passed, how often and
/// which way; the holes made, and the ports that rest; what friction holds; how far the wall that
/// is pressed has relaxed; how much of the content behind the opening that the proxy came by is
/// felt, where that opening's surface is there by its place; and the work of sources. What a needle
/// has cut and what holds it begin anew, and what is felt may jump: limits of the force see to
/// that. For set-up, between two ticks: it allocates.
[[nodiscard]] PALPATE_EXPORT CarriedState carryState(const RendererState& state, RendererKind kind,
                                                     const Scene& from, const Scene& to);

}  // namespace palpate
