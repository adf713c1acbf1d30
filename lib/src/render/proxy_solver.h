#pragma once
/// ProxySolver: moves the proxy. It minimizes |x - P|^2 over the proxy's region along a
/// connected path: at each place the region is a union of cells, each a conjunction of sides of
/// smooth leaves, and x rests if and only if it rests in every cell that holds it. So edges,
/// corners of any number of walls, apexes and the rims of unions need no rule of their own.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "near_walls.h"
#include "palpate/contact/planes.h"
#include "palpate/contact/slide.h"
#include "solver_limits.h"

namespace palpate {

/// A closed wall that holds the proxy.
struct WallContact {
  LeafId leaf = 0;
  Facet facet;
  HeldWall held;
};

struct HeldWalls {
  std::array<HeldWall, 3> wall{};
  std::size_t count = 0;
  [[nodiscard]] std::span<const HeldWall> walls() const noexcept { return {wall.data(), count}; }
};

/// The walls that hold the proxy.
struct ContactSet {
  std::array<WallContact, 3> wall{};
  std::size_t count = 0;
  Vec3 lag{0.0, 0.0, 0.0};  ///< [m] the part of P - x along the walls that friction holds
  /// [m] from the proxy, which stands off its walls by half a tolerance, onto their surfaces
  Vec3 snug{0.0, 0.0, 0.0};
  Vec3 left{0.0, 0.0, 0.0};  ///< [m] part of P - x along the walls, held or still to slide

  [[nodiscard]] std::span<const WallContact> walls() const noexcept { return {wall.data(), count}; }
  void clear() noexcept {
    count = 0;
    lag = snug = left = Vec3(0.0);
  }
  [[nodiscard]] HeldWalls held() const noexcept;
  [[nodiscard]] Vec3 along(const Vec3& v) const noexcept;  ///< the part of `v` along all walls
  [[nodiscard]] double load() const noexcept;  ///< [m] length of the sum of multiplier * normal
};

/// Decides, when the proxy rests, whether a wall that is pressed gives way.
class WallOpener {
 public:
  /// True if a wall gave way; the walker then has gone through it.
  virtual bool open(const ContactSet& contact) noexcept = 0;

 protected:
  ~WallOpener() = default;
};

class ProxySolver {
 public:
  ProxySolver(const Scene& scene, CellWalker& walker)
      : scene_(scene), walker_(walker), near_(scene, walker) {}

  /// Brings the proxy to where |x - P| is smallest in its region, as far as one tick's budget
  /// allows. The result is never further from P than before, except for what friction holds. True
  /// if the proxy came to rest.
  bool track(const Vec3& hip, FrictionState& friction, WallOpener& opener) noexcept;

  /// The walls that hold the proxy after the last track(); empty if the proxy is at P.
  [[nodiscard]] const ContactSet& contact() const noexcept { return contact_; }

 private:
  static constexpr std::size_t kMaxCells = NearCells::kMaxCells;
  static constexpr std::size_t kMaxNear = NearWalls::kMax;
  static constexpr std::size_t kMaxSeen =
      6;  ///< planes of folds that are kept while a step is brought back onto the walls

  /// A plane of a cell's problem: a near wall, or a tangent plane that was met further on (a cut).
  struct Source {
    std::uint8_t near = 0;  ///< index of the near wall
    bool inside = false;    ///< the side of it that the cell is on
    std::int16_t cut = -1;  ///< index of the cut; -1: the plane of the wall as it is here

    [[nodiscard]] bool isCut() const noexcept { return cut >= 0; }
  };
  struct CellProblem {
    NearCell cell;
    std::array<Plane, kMaxPlanes> plane{};
    std::array<Source, kMaxPlanes> source{};
    std::size_t planes = 0;
    PlaneSolution solution;
    double gain = 0.0;  ///< [m^2] by how much the solution reduces the squared distance

    void add(const Plane& added, const Source& from) noexcept {
      if (planes == kMaxPlanes) return;
      plane[planes] = added;
      source[planes++] = from;
    }
    [[nodiscard]] std::span<const Plane> given() const noexcept { return {plane.data(), planes}; }
    [[nodiscard]] bool holds(std::size_t plane_index) const noexcept;
  };
  struct Cut {
    Plane plane;     ///< as a constraint on steps from the present place
    Mat3 bend{0.0};  ///< [1/m] curvature of that wall, outward; zero where it is not known here
    LeafId leaf = 0;
    bool inside = false;
    double away = 0.0;  ///< [m] how far away it was met
  };

  /// The regions that the proxy left at one place in this tick.
  struct Crossed {
    struct From {
      RegionId region = kOutside;
      bool leads_on = false;  ///< a step led on from there, along the walls crossed
    };
    Vec3 place{kInfinity, kInfinity, kInfinity};  ///< [m]
    std::array<From, 16> from{};
    std::size_t count = 0;
    bool is_last = false;  ///< the proxy stays where it is now
  };

  /// The steps since the proxy last flew or crossed a wall in this tick.
  struct Wander {
    Vec3 from{0.0, 0.0, 0.0};  ///< [m]
    double farthest = 0.0;     ///< [-] distance from `from` over the noise of the walls
    int in_vain = 0;           ///< steps that came no nearer to the aim than an earlier one
  };

  enum class Look { kFree, kRests, kCrossed, kMoves, kNowhere };
  enum class Try { kMoved, kRests, kRefused };
  /// What a step must achieve: end on the walls and gain a share of what it promised (kUsual); gain
  /// at all (kMustGain); or gain, and be allowed to end in free space (kMayFly).
  enum class StepRule { kUsual, kMustGain, kMayFly };

  /// [m] A step from `x` as short as this counts as none, for a hand that is `wish` away.
  [[nodiscard]] static double restLength(const Vec3& x, const Vec3& wish) noexcept;
  [[nodiscard]] bool goQuickly(const Vec3& hip, FrictionState& friction) noexcept;
  [[nodiscard]] bool glide(LeafId id, int free, const Vec3& hip, FrictionState& friction) noexcept;
  [[nodiscard]] bool isPassed(LeafId id, const Vec3& y, double length) noexcept;
  [[nodiscard]] bool glideBetween(LeafId a, LeafId b, const Vec3& hip,
                                  FrictionState& friction) noexcept;
  void takeOnly(LeafId id, const Facet& facet, const WallThere& wall, const FieldJet& jet,
                const Vec3& wish) noexcept;
  [[nodiscard]] bool goesNowhere() const noexcept;
  [[nodiscard]] Look lookAround(FrictionState& friction, bool is_first) noexcept;
  [[nodiscard]] bool goesOnInto(RegionId beyond, const CellProblem& problem) noexcept;
  [[nodiscard]] Try moveOn() noexcept;
  [[nodiscard]] bool lookWithin(double radius) noexcept;
  void poseAll(const Vec3& wish) noexcept;
  [[nodiscard]] static double roomOf(const CellProblem& problem) noexcept;
  [[nodiscard]] static bool areHeldAlike(const CellProblem& a, const CellProblem& b) noexcept;
  [[nodiscard]] std::size_t roomiest() const noexcept;
  void pose(const NearCell& cell, CellProblem& out) const noexcept;
  void solve(CellProblem& problem, const Vec3& wish) const noexcept;
  [[nodiscard]] double noiseOf(const CellProblem& problem) const noexcept;
  [[nodiscard]] double turningLength(const CellProblem& problem) const noexcept;
  [[nodiscard]] Mat3 bendOf(const CellProblem& problem) const noexcept;
  [[nodiscard]] Try tryCell(CellProblem& problem, double ball) noexcept;
  [[nodiscard]] bool tryStep(const CellProblem& problem, const Vec3& step, double ball,
                             StepRule rule) noexcept;
  [[nodiscard]] Vec3 limited(const CellProblem& problem, const Vec3& step,
                             double ball) const noexcept;
  [[nodiscard]] Vec3 bentBack(const CellProblem& problem, const Vec3& step) const noexcept;
  [[nodiscard]] bool flyOff(double ball) noexcept;
  [[nodiscard]] bool hasLandedFree(const CellProblem& problem) const noexcept;
  [[nodiscard]] bool restore(const CellProblem& problem, Vec3& y, double length) noexcept;
  [[nodiscard]] bool keepsOnWay(const CellProblem& problem, const Vec3& y) noexcept;
  [[nodiscard]] bool go(const CellProblem& problem, const Vec3& y) noexcept;
  [[nodiscard]] bool isCut(const CellProblem& problem, std::size_t i, Cut& out) const noexcept;
  [[nodiscard]] bool foundCrease(const CellProblem& problem, double length) const noexcept;
  [[nodiscard]] bool addCuts(const CellProblem& problem) noexcept;
  [[nodiscard]] bool lookFar(const CellProblem& problem, const Vec3& step, double ball) noexcept;
  bool lookAt(const CellProblem& problem, const Vec3& p) noexcept;
  [[nodiscard]] bool lookCloser(const CellProblem& problem, const Vec3& way) noexcept;
  [[nodiscard]] bool kick() noexcept;
  void takeLastContact(const Vec3& hip) noexcept;
  void takeContact(const CellProblem& problem) noexcept;
  [[nodiscard]] int materialAside(const CellProblem& problem, std::size_t near) noexcept;
  void nameMaterials(int last) noexcept;
  /// The largest friction ratios [-] of some walls.
  struct FrictionRatios {
    double at_rest = 0.0;
    double sliding = 0.0;
    void take(const Friction& own, const Vec3& x) noexcept {
      at_rest = std::max(at_rest, own.static_ratio.at(x));
      sliding = std::max(sliding, own.kinetic_ratio.at(x));
    }
  };
  void holdByFriction(FrictionState& friction, bool is_first) noexcept;
  [[nodiscard]] Vec3 lagOf(const FrictionRatios& ratios, const Vec3& pulled, const Vec3& rest,
                           double load, bool is_first, FrictionState& friction) const noexcept;
  [[nodiscard]] const Friction& frictionOf(const Facet& facet) const noexcept {
    return scene_.materials()[static_cast<std::size_t>(facet.material)].friction;
  }
  [[nodiscard]] bool isReached(std::size_t plane) const noexcept {
    return ((reached_ >> plane) & 1U) != 0;
  }
  [[nodiscard]] WallThere wallAt(std::size_t near, const Vec3& p) const noexcept;

  const Scene& scene_;
  CellWalker& walker_;
  NearWalls near_;
  ContactSet contact_;

  // Scratch of one tick.
  Vec3 x_{0.0, 0.0, 0.0};     ///< [m] the place being examined
  Vec3 wish_{0.0, 0.0, 0.0};  ///< [m] from there to P
  Vec3 aim_{0.0, 0.0, 0.0};   ///< [m] `wish_` without the part that friction holds
  double rest_ = 0.0;         ///< [m] a step as short as this counts as none
  std::array<CellProblem, kMaxCells> problem_{};
  std::size_t problems_ = 0;
  std::array<Cut, limits::kMaxCuts> cut_{};
  std::size_t cuts_ = 0;
  std::array<WallThere, kMaxPlanes> landed_{};  ///< by plane: its wall where the last step landed
  Vec3 landed_at_{0.0, 0.0, 0.0};               ///< [m]
  bool has_landed_ = false;
  bool leads_nowhere_ =
      false;  ///< the last step is within the noise, and came back to where it began
  std::uint64_t reached_ = 0;  ///< one bit for each plane: the present step ends on it
  int rim_ = -1;               ///< leaf that the way back onto the walls must also end on; -1: none
  int other_ = -1;  ///< leaf that the fast way meets, or that no longer holds the proxy; -1: none
  bool trusts_sides_ = false;
  int batches_left_ = 0;
  Crossed crossed_;
  int hops_ = 0;  ///< steps cut short in this tick because the full step ended in free space
  /// [m^2] smallest squared distance from the aim before or after a step of this tick
  double nearest_ = kInfinity;
  std::array<Vec3, limits::kPlaces> before_{};  ///< [m] where the last steps of this tick began
  bool is_nearest_ = false;  ///< the last step of this tick ended at that distance, within rounding
  int idle_steps_ = 0;       ///< number of steps in a row that led nowhere (limits::kIdleSteps)
  Wander wander_;
};

}  // namespace palpate
