#pragma once
/// The tolerances and budgets of the proxy's motion, in one place, each with its reason. Lengths
/// are relative to a leaf's feature size, so that a scene behaves the same when all its lengths are
/// in micrometers.

#include <cstddef>
#include <cstdint>

namespace palpate::limits {

// On a wall ---------------------------------------------------------------------------------------

/// Share of the feature size that counts as on the surface. Far above rounding (1e-16 of
/// coordinates of a hundred feature sizes), far below what changes a force noticeably (1e-6 of a
/// depth of a millimeter).
inline constexpr double kOnSurface = 1e-9;
/// Tolerances in S follow the slope only down to this share of the Lipschitz bound.
inline constexpr double kFlattest = 1e-3;
/// The proxy rests this many tolerances off its walls, on their free side, ...
inline constexpr double kRest = 0.5;
/// ... and counts as on them up to here. Restoring converges to rounding; this much is needed only
/// where walls meet at an angle of about rounding.
inline constexpr double kOnWall = 2.5;

/// Walls within this many tolerances count as touched when it is tested whether they leave any
/// room.
inline constexpr double kRoom = 4.0;

// At rest -----------------------------------------------------------------------------------------

/// The proxy has settled when the remaining slide is this share of the depth (6e-8 degree of the
/// force's direction), ...
inline constexpr double kSettled = 1e-9;
/// ... or this share of the coordinates, which is their rounding.
inline constexpr double kRounding = 4e-15;
/// A negative eigenvalue below this means that the proxy can come closer by the second order;
/// above, it may be rounding of Hessians.
inline constexpr double kSaddle = -1e-6;
/// In that case the proxy is moved by these shares of the feature size along the eigenvector.
inline constexpr double kKicks[] = {0.1, 1e-3};

/// A slide ends within this share of the border of the kinetic cone.
inline constexpr double kSticksWithin = 1e-6;

// One step ----------------------------------------------------------------------------------------

/// Smaller eigenvalues are raised to this in a Newton step: longer steps along almost flat valleys
/// overshoot.
inline constexpr double kLeastEigenvalue = 0.02;
/// A step considers the leaves within this many times its length of the proxy.
inline constexpr double kReachOverStep = 1.25;
/// Radius of the ball in which a step is searched, over the length of the step that the present
/// walls allow.
inline constexpr double kBallOverStep = 1.5;
/// On a wall that bulges towards the proxy a step is at most this share of the wall's feature size,
/// so that it does not land on the wall's opposite side, ...
inline constexpr double kShareOfFeature = 0.5;
/// ... unless it is examined in strides of this share of the feature size, at most kMostStrides of
/// them, ...
inline constexpr double kStride = 0.4;
inline constexpr double kMostStrides = 48.0;
/// ... where kStridesPerBatch strides cost as much as evaluating all fields at one place.
inline constexpr int kStridesPerBatch = 8;
/// A step turns the normal of no wall that holds the proxy by more than this [rad].
inline constexpr double kLargestTurn = 0.5;
/// Restoring onto the walls: the number of rounds, and the total way over the length of the step. A
/// longer way would jump to another part of the wall.
inline constexpr int kRestorations = 6;
inline constexpr double kRestoredShare = 0.5;
/// ... plus this many tolerances: needed to leave a groove of 0.1 degree when one tolerance deep.
inline constexpr double kRestoredLeast = 1000.0;
/// A step is kept if it gains this share of what it promised, minus the noise of the distances.
inline constexpr double kGain = 0.01;
inline constexpr double kNoise = 10.0;
/// In units of restLength(): a step that ends this close to where it began counts as none.
inline constexpr double kNowhere = 0.1;
/// The proxy also rests after this many steps in a row that led nowhere. A step leads nowhere if it
/// ends where one of the last kPlaces steps began, or if it stays within the noise of its walls and
/// brings the squared distance to the hand down by less than the share kRoundedGain, which is
/// rounding. Around an apex steps go back and forth like that. Up to kIdleMore further steps are
/// made until one ends at the nearest place.
inline constexpr int kIdleSteps = 4;
inline constexpr int kIdleMore = 2;
inline constexpr int kPlaces = 4;  ///< number of earlier steps that are compared
inline constexpr double kRoundedGain = 1e-14;
/// If the budget ends during such steps, the proxy also rests if all places of the tick are within
/// this many times the noise of its walls, 1e-7 of the feature size, of the first one.
inline constexpr double kWanders = 10.0;
/// A Newton step is shorter than this share of the plain step, and the normal would turn by more
/// than kSingularTurn [rad] over the plain step: that means a singular point, and the plain step is
/// tried instead.
inline constexpr double kSingularStep = 0.2;
inline constexpr double kSingularTurn = 10.0;
/// A step from a saddle is lengthened if that makes it at least this many times longer.
inline constexpr double kFarther = 1.5;
/// If normals turn by more than this [rad] on the way, the middle of the chord is checked, ...
inline constexpr double kTurnsMuch = 0.02;
/// ... and from this turn on the quarters too, ...
inline constexpr double kTurnsMore = 0.05;
/// ... where the chord may dip into a wall by these shares of curvature times length squared, and
/// of the length.
inline constexpr double kDipByBend = 0.2;
inline constexpr double kDipByLength = 0.1;
/// The most cuts (tangent planes met where a step was refused) that are kept while the proxy is at
/// one place.
inline constexpr std::size_t kMaxCuts = 8;
inline constexpr int kCutRounds = 8;
/// A cut is kept if its normal differs by at least this [rad] from that of the same wall here:
/// smaller turns are handled by the curvature in Newton's step, which a cut would replace by a
/// plane.
inline constexpr double kCutTurn = 0.05;
/// If a leaf's curvature is this many times what its feature size suggests, it has a fold at the
/// place. ...
inline constexpr double kFolds = 8.0;
/// ... It is then evaluated this share of the feature size beyond the fold, ...
inline constexpr double kBeyondFold = 1e-3;
/// ... and that value is used if the curvature there is below this share.
inline constexpr double kFoldsLess = 0.1;
/// Two cuts of one wall whose normals differ by less than this [rad] are the same, unless the new
/// one is closer.
inline constexpr double kSameCut = 1e-6;
/// Cuts whose normals differ by less than this [rad] belong to the same wall: the last one replaces
/// the others.
inline constexpr double kSameWall = 0.1;
/// Before the proxy rests on a cut, or makes a step shorter than this share of the feature size,
/// the cut's wall is evaluated this far ahead.
inline constexpr double kClose = 1e-5;
/// A cut that was met this many times nearer replaces an older one that could have been carried to
/// it.
inline constexpr double kNearer = 10.0;
/// A cut is carried back to the proxy with its curvature if its wall turns by less than this [rad]
/// between there and the proxy, ...
inline constexpr double kCarries = 0.3;
/// ... and if the proxy is then beyond it by no more than this share of the correction by the
/// curvature.
inline constexpr double kCarriedShare = 0.1;
/// The fast way on one smooth wall, or between two, gives up after this many steps and leaves the
/// rest to the general method. It also gives up ...
inline constexpr int kGlides = 6;
/// ... on ways over which the normal turns by more than kTurnsMore, or on a sphere by more than
/// this [rad], ...
inline constexpr double kGlidesFar = 0.2;
/// ... where the resting place is a minimum by less than this (an eigenvalue: 0 at the wall's
/// center of curvature), ...
inline constexpr double kFirm = 0.02;
/// ... and where the normal turns by more than this [rad] beyond twice the turn that the wall's
/// curvature explains.
inline constexpr double kFirmTurn = 1e-6;
/// Two walls between which the proxy glides meet at an angle whose sine has at least this square (6
/// degrees).
inline constexpr double kSharp = 0.01;
/// A wall counts as a sphere if the sum of the squares of its curvatures differs by less than this
/// share from that of two equal ones; the curvatures then differ by 3e-5.
inline constexpr double kEven = 1e-9;
/// If no step along the walls is kept, these shares of the step are tried, which may end in free
/// space beyond a sharp edge.
inline constexpr double kFlights[] = {1.0, 0.1, 0.01};
/// The proxy may fly at once after this many steps that were cut short because they ended in free
/// space.
inline constexpr int kHops = 2;
/// A refused step is shortened to these shares in turn; then the ball shrinks by the factor
/// kShrink, up to kShrinks times.
inline constexpr double kShorter[] = {0.5, 0.125, 0.02};
inline constexpr double kShrink = 0.2;
inline constexpr int kShrinks = 4;

// The way through cells ---------------------------------------------------------------------------

/// Sweeps ignore passages in and out again that are shorter than this share of the feature size:
/// such a passage is at most 5e-7 of it deep.
inline constexpr double kGraze = 0.002;
inline constexpr int kEvaluationsPerTick = 4096;
inline constexpr int kEvaluationsPerSweep = 256;
/// The hot list holds the leaves within this many times the length of the motion that made the
/// list, ...
inline constexpr double kHorizon = 16.0;
/// ... and at least those within this share of the smallest feature size.
inline constexpr double kHorizonShare = 0.1;
/// Within this many tolerances of a leaf the point counts as touching it.
inline constexpr double kTouch = 4.0;
/// Two leaves that the point touches are one facet if their normals are parallel to this (1 minus
/// the cosine).
inline constexpr double kParallel = 1e-6;
/// A slide consists of this many straight moves: to above where it lands, and down.
inline constexpr std::uint64_t kStaysOfSlide = 2;

// One tick ----------------------------------------------------------------------------------------

/// The number of places at which fields are evaluated. A smooth wall takes 2 or 3, corners 8;
/// beyond the budget the next tick goes on.
inline constexpr int kMaxBatches = 160;
/// Crossings of facets between cells; each takes some microseconds at most.
inline constexpr int kCrossings = 32;

}  // namespace palpate::limits
