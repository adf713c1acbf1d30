#pragma once
/// Passivity in the time domain: an observer that adds up the energy which a sampled loop gives to
/// the hand, and a controller that takes it back. Both work at the device, in its frame, on the
/// forces that its motors really hold.

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <type_traits>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::devices {

/// Properties of the device that are guaranteed at its tip, in any direction and anywhere in its
/// workspace, and the measures to take.
struct PassivitySettings {
  double mass = 0.0;      ///< [kg] the smallest effective mass, without the hand; above 0
  double damping = 0.0;   ///< [N s/m] the smallest viscous damping of the device alone; 0 or more
  double friction = 0.0;  ///< [N] the smallest Coulomb friction of the device alone; 0 or more
  double encoder = 0.0;   ///< [m] one step of a reading; 0 or more
  double max_force =
      std::numeric_limits<double>::infinity();  ///< [N] the most that the motors hold
  double period = 1e-3;                         ///< [s] of the loop; above 0
  /// [ticks] from the tick that writes a force to the tick from which it is held; 0 to
  /// PassivityObserver::kMostDelay.
  int delay = 0;
  bool controls = true;  ///< false: the energy is only observed, and every force left unchanged
  /// [N] The largest force of the hand. If it is given, no force is held that could give away more
  /// energy by the next tick than the account holds. Needs a delay of 0.
  std::optional<double> hand_force = {};
};

/// The energy that has gone from the motors into the hand. A value type; add() and hold() never
/// allocate, lock or throw.
///
/// A force f that is held from one tick to the next does exactly the work f . (x_k - x_{k-1}),
/// however the hand moved in between. (f_k . v_k T, with the velocity of the tick that computes
/// f_k, is wrong by K times the sum of the squared steps: a loop that gives energy away would pass
/// as passive.) Two things that a real device surely dissipates are credited against that: viscous
/// damping b dissipates b |x_k - x_{k-1}|^2 / T or more, friction f_c dissipates f_c |x_k -
/// x_{k-1}| or more.
class PALPATE_EXPORT PassivityObserver {
 public:
  /// [ticks] The largest PassivitySettings::delay.
  static constexpr int kMostDelay = 64;
  /// [J] The account begins with this, and holds no more than this while no force is held.
  static constexpr double kSeed = 1e-9;

  /// @throws Error (kUsage, passivity.*) for a value out of its range.
  explicit PassivityObserver(const PassivitySettings& settings);

  /// The tip is at `position` [m], `dt` [s] after the last time. `source` [J] is what sources in
  /// the scene gave to the hand in between, by their nature (HapticRenderer::sourceWork(),
  /// converted to the hand): that is not counted against the loop.
  void add(const Vec3& position, double dt, double source) noexcept;
  /// `force` [N] is written: shortened to max_force, it will be held `delay` ticks later.
  void hold(const Vec3& force) noexcept;

  /// A state for which this is false cannot have come from add() and hold().
  [[nodiscard]] bool isSound() const noexcept {
    return delay_ >= 0 && delay_ <= kMostDelay && next_ <= static_cast<std::size_t>(delay_);
  }

  /// [J] Work of the held forces on the tip since the first tick, without that of sources.
  [[nodiscard]] double given() const noexcept { return given_; }
  /// [J] The energy that may still be given: the seed plus what was dissipated minus what was
  /// given. Negative: the loop gave energy away.
  [[nodiscard]] double reserve() const noexcept { return reserve_; }
  /// [J] The lowest reserve() so far.
  [[nodiscard]] double lowest() const noexcept { return lowest_; }
  /// [J] The possible error of given() because readings come in steps of the encoder: half a step
  /// times the changes of the force along each axis.
  [[nodiscard]] double doubt() const noexcept { return doubt_; }
  /// [m] The displacement of the tip between the last two calls of add().
  [[nodiscard]] const Vec3& moved() const noexcept { return moved_; }
  /// [N] the force held until the last add().
  [[nodiscard]] const Vec3& held() const noexcept { return held_; }

 private:
  double damping_ = 0.0;
  double friction_ = 0.0;
  double unsure_ = 0.0;     ///< [m] error of a step between two readings, due to the encoder
  double half_step_ = 0.0;  ///< [m] half a step of the encoder
  double max_force_ = 0.0;
  int delay_ = 0;

  std::array<Vec3, kMostDelay + 1> written_{};  ///< [N] a ring of delay + 1, the oldest at next_
  std::size_t next_ = 0;
  Vec3 held_{0.0, 0.0, 0.0};
  Vec3 position_{0.0, 0.0, 0.0};
  Vec3 moved_{0.0, 0.0, 0.0};
  bool has_position_ = false;
  double given_ = 0.0;
  double reserve_ = kSeed;
  double lowest_ = kSeed;
  double doubt_ = 0.0;
};

/// The result of one tick of the controller.
struct PassivityTick {
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] to be written
  Vec3 added{0.0, 0.0, 0.0};  ///< [N] the controller's share of it
};

/// The observer, followed by a controller (after Hannaford and Ryu, IEEE Transactions on Robotics
/// and Automation 18(1), 2002, with the energy of the observer above). A value type; step() never
/// allocates, locks or throws.
///
/// - While the reserve is negative it damps: -alpha v with alpha = -reserve / (T |v|^2), limited to
///   kDampingShare mass / T and to tan(pi / (4 (d + 1))) mass / T, with d ticks of delay. A damper
///   that is sampled and held gives energy itself: on a mass alone it is stable below twice the
///   latter. So the controller acts only after energy was given.
/// - From then on, until the wanted force is zero, it damps along that force with the largest
///   permitted alpha: a damper that came and went with the reserve would leave a limit cycle. It
///   never reverses the force. Motions as short as an encoder's step count as none.
/// - Where that damper is not enough, it softens: a force that grows with more than mostStiffness()
///   is scaled down to that. To first order, a damping of at most alpha stabilizes a stiffness of
///   alpha / (T / 2 + d T); half of that is below the exact limit for any delay. And friction f_c
///   cannot damp the motion that an encoder of step D causes above a stiffness of 2 f_c / D:
///   kFrictionShare of that is the limit if both are known.
/// - With `hand_force` F_H it acts beforehand, without delay. Until the next tick the tip moves by
///   x_k - x_{k-1} + T^2 / (2 m) (f_{k-1} + f_k + 2 F) with |F| <= F_H along the force at most. So
///   |f| <= (-s + sqrt(s^2 + 4 c reserve)) / (2 c) gives no more than the reserve, where c = T^2 /
///   (2 m), s = n . (x_k - x_{k-1}) + c n . f_{k-1} + 2 c F_H (plus the encoder's step), and n = f
///   / |f|.
///
/// All of these are felt: a wall that is too stiff is felt with mostStiffness(), is softer where it
/// is first touched, and a fast tap on it gets a kick.
class PALPATE_EXPORT PassivityController {
 public:
  static constexpr double kDampingShare = 0.25;  ///< [-]
  static constexpr double kFrictionShare = 0.8;  ///< [-]

  /// @throws Error (kUsage, passivity.*) for a value out of its range, and for hand_force with a
  /// delay.
  explicit PassivityController(const PassivitySettings& settings);

  /// The tip is at `position` [m], `dt` [s] after the last time, and `force` [N] is wanted.
  /// `stiffness` [N/m] bounds how fast that force grows when the tip moves against it; 0: not
  /// known. `source` is as in PassivityObserver::add(), for the forces as they were wanted. A
  /// position that is not finite gives zero force, and is otherwise ignored.
  [[nodiscard]] PassivityTick step(const Vec3& position, double dt, const Vec3& force,
                                   double stiffness, double source) noexcept;

  /// The account of energy that step() keeps.
  [[nodiscard]] const PassivityObserver& observer() const noexcept { return observer_; }
  /// [N/m] A stiffer wall is felt with this stiffness; infinite if nothing is controlled.
  [[nodiscard]] double mostStiffness() const noexcept { return most_stiffness_; }
  /// A state for which this is false cannot have come from step().
  [[nodiscard]] bool isSound() const noexcept { return observer_.isSound(); }

 private:
  /// [m] The last motion, less the encoder's step.
  [[nodiscard]] Vec3 sureStep() const noexcept;
  [[nodiscard]] Vec3 damped(const Vec3& force) const noexcept;
  [[nodiscard]] Vec3 bounded(const Vec3& force) const noexcept;

  PassivityObserver observer_;
  double per_period_ = 1e3;      ///< [1/s]
  double most_damping_ = 0.0;    ///< [N s/m]
  double most_stiffness_ = 0.0;  ///< [N/m]
  double encoder_ = 0.0;         ///< [m] one step
  double least_step_ = 0.0;      ///< [m] a shorter motion counts as rest
  double travel_ = 0.0;          ///< [m/N] c = T^2 / (2 m)
  double margin_ = 0.0;          ///< [m] 2 c F_H plus the encoder's step
  double scale_ = 1.0;           ///< [-] factor on the force in the last tick
  bool controls_ = false;
  bool bounds_ = false;
  bool is_damping_ = false;  ///< energy was given since the force was last zero
};

static_assert(std::is_trivially_copyable_v<PassivityController>);

}  // namespace palpate::devices
