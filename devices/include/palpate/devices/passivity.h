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

/// What may be relied on of the device at its tip, in any direction and anywhere in its workspace,
/// and what is to be done.
struct PassivitySettings {
  double mass = 0.0;      ///< [kg] the least, without the hand; above 0
  double damping = 0.0;   ///< [N s/m] the least viscous one of the device alone; 0 or more
  double friction = 0.0;  ///< [N] the least Coulomb friction of the device alone; 0 or more
  double encoder = 0.0;   ///< [m] one step of a reading; 0 or more
  double max_force = std::numeric_limits<double>::infinity();  ///< [N] the motors hold no more
  double period = 1e-3;                                        ///< [s] of the loop; above 0
  /// [ticks] from the tick that writes a force to the one from which it is held; 0 to
  /// PassivityObserver::kMostDelay.
  int delay = 0;
  bool controls = true;  ///< false: the energy is observed, and every force left as it is
  /// [N] The largest force of the hand. If it is given, no force is held that could give away more
  /// energy by the next tick than there is. Needs a delay of 0.
  std::optional<double> hand_force = {};
};

/// The energy that has gone from the motors into the hand. A value; add() and hold() never
/// allocate, lock or throw.
///
/// A force f that is held from one tick to the next does exactly the work f . (x_k - x_{k-1}),
/// however the hand moved in between. (f_k . v_k T, with the velocity of the tick that computes
/// f_k, is off by K times the sum of the squared steps, and calls a loop passive that gives energy
/// away.) Against that count two incomes that a real device surely has: viscous damping b takes b
/// |x_k - x_{k-1}|^2 / T or more, friction f_c takes f_c |x_k - x_{k-1}| or more.
class PALPATE_EXPORT PassivityObserver {
 public:
  static constexpr int kMostDelay = 64;
  /// [J] With so much the account begins, and it has no more than that while no force is held.
  static constexpr double kSeed = 1e-9;

  /// @throws Error (kUsage, passivity.*) for a value out of its range.
  explicit PassivityObserver(const PassivitySettings& settings);

  /// The tip is at `position` [m], `dt` [s] after the last time. `source` [J] is what sources in
  /// the scene gave to the hand in between, by their nature (HapticRenderer::sourceWork(), at the
  /// hand): it is not counted against the loop.
  void add(const Vec3& position, double dt, double source) noexcept;
  /// `force` [N] is written. Shortened to max_force, it is held `delay` ticks later.
  void hold(const Vec3& force) noexcept;

  /// What is not so cannot have come from add() and hold().
  [[nodiscard]] bool isSound() const noexcept {
    return delay_ >= 0 && delay_ <= kMostDelay && next_ <= static_cast<std::size_t>(delay_);
  }

  /// [J] Work of the held forces on the tip since the first tick, sources left out.
  [[nodiscard]] double given() const noexcept { return given_; }
  /// [J] What may still be given: the seed and the incomes less what was given. Below 0: the loop
  /// gave energy away.
  [[nodiscard]] double reserve() const noexcept { return reserve_; }
  /// [J] The lowest reserve() so far.
  [[nodiscard]] double lowest() const noexcept { return lowest_; }
  /// [J] By how much readings in steps of the encoder may have put given() off:
  /// half a step times the changes of the force along each axis.
  [[nodiscard]] double doubt() const noexcept { return doubt_; }
  /// [m] from the last position but one to the last.
  [[nodiscard]] const Vec3& moved() const noexcept { return moved_; }
  /// [N] held until the last add().
  [[nodiscard]] const Vec3& held() const noexcept { return held_; }

 private:
  double damping_ = 0.0;
  double friction_ = 0.0;
  double unsure_ = 0.0;     ///< [m] of a step, by the encoder
  double half_step_ = 0.0;  ///< [m] of the encoder
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

/// What a tick of the controller did.
struct PassivityTick {
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] to be written
  Vec3 added{0.0, 0.0, 0.0};  ///< [N] of it by the controller
};

/// The observer, and a controller behind it (after Hannaford and Ryu, IEEE Transactions on Robotics
/// and Automation 18(1), 2002, with the energy of the observer above). A value; step() never
/// allocates, locks or throws.
///
/// - While the reserve is below 0 it damps: -alpha v, alpha = -reserve / (T |v|^2), but
/// kDampingShare mass / T and
///   tan(pi / (4 (d + 1))) mass / T at most, with d ticks of delay. A damper that is sampled and
///   held gives energy itself: on a mass alone it is stable below twice the latter. The controller
///   acts once energy was given.
/// - From then on until the force wanted is zero it damps along that force with all it may: a
/// damper that came and went with the
///   reserve would leave a limit cycle. It never turns the force around. Steps as short as the
///   encoder's count for no motion.
/// - What that damper cannot hold it softens: a force that grows with more than mostStiffness() is
/// scaled down to it. At most
///   alpha of damping holds alpha / (T / 2 + d T) by first order; half of that is below the exact
///   limit with any delay. And no friction f_c stills what an encoder of step D sets going above 2
///   f_c / D: kFrictionShare of that, if both are known.
/// - With `hand_force` F_H it acts before that, without delay. Until the next tick the tip goes
///   x_k - x_{k-1} + T^2 / (2 m) (f_{k-1} + f_k + 2 F) with |F| <= F_H along the force at most, so
///   |f| <= (-s + sqrt(s^2 + 4 c reserve)) / (2 c), c = T^2 / (2 m), s = n . (x_k - x_{k-1}) + c n
///   . f_{k-1} + 2 c F_H (and the encoder's step), n = f / |f|, gives no more than the reserve.
///
/// All are felt: a wall that is too stiff has mostStiffness(), is softer where it is first touched,
/// and a fast tap gets a kick against it.
class PALPATE_EXPORT PassivityController {
 public:
  static constexpr double kDampingShare = 0.25;  ///< [-]
  static constexpr double kFrictionShare = 0.8;  ///< [-]

  /// @throws Error (kUsage, passivity.*) for a value out of its range, and for hand_force with a
  /// delay.
  explicit PassivityController(const PassivitySettings& settings);

  /// The tip is at `position` [m], `dt` [s] after the last time, and `force` [N] is wanted, which
  /// grows with `stiffness` [N/m] at most where the tip goes against it; 0: not known. `source` is
  /// as in PassivityObserver::add(), of the forces as they were wanted. A position that is not
  /// finite gives zero force, and counts for nothing.
  [[nodiscard]] PassivityTick step(const Vec3& position, double dt, const Vec3& force,
                                   double stiffness, double source) noexcept;

  [[nodiscard]] const PassivityObserver& observer() const noexcept { return observer_; }
  /// [N/m] A stiffer wall is felt as one of this; infinite if nothing is controlled.
  [[nodiscard]] double mostStiffness() const noexcept { return most_stiffness_; }
  /// What is not so cannot have come from step().
  [[nodiscard]] bool isSound() const noexcept { return observer_.isSound(); }

 private:
  /// [m] The last step, less the encoder's.
  [[nodiscard]] Vec3 sureStep() const noexcept;
  [[nodiscard]] Vec3 damped(const Vec3& force) const noexcept;
  [[nodiscard]] Vec3 bounded(const Vec3& force) const noexcept;

  PassivityObserver observer_;
  double per_period_ = 1e3;      ///< [1/s]
  double most_damping_ = 0.0;    ///< [N s/m]
  double most_stiffness_ = 0.0;  ///< [N/m]
  double encoder_ = 0.0;         ///< [m] one step
  double least_step_ = 0.0;      ///< [m] shorter is at rest
  double travel_ = 0.0;          ///< [m/N] c = T^2 / (2 m)
  double margin_ = 0.0;          ///< [m] 2 c F_H and the encoder's step
  double scale_ = 1.0;           ///< [-] of the force that was wanted last
  bool controls_ = false;
  bool bounds_ = false;
  bool is_damping_ = false;  ///< energy was given since a force was first wanted
};

static_assert(std::is_trivially_copyable_v<PassivityController>);

}  // namespace palpate::devices
