#pragma once
/// The tolerances and budgets of the proxy's way, on one page, each with its reason. Lengths are
/// shares of a leaf's feature size, so that a scene in micrometers is the same scene.

#include <cstddef>
#include <cstdint>

namespace palpate::limits {

// On a wall ---------------------------------------------------------------------------------------

/// Share of the feature size that counts as on the surface. Far above rounding (1e-16 of
/// coordinates of a hundred feature sizes), far below what a force can show (1e-6 of a millimeter's
/// depth).
inline constexpr double kOnSurface = 1e-9;
/// A slope below this share of the Lipschitz bound is not made up for in tolerances.
inline constexpr double kFlattest = 1e-3;
/// The proxy rests this many tolerances off its walls, on their free side, ...
inline constexpr double kRest = 0.5;
/// ... and counts as on them up to here. Restoring converges to rounding; this much is never needed
/// but where walls meet at an angle of about rounding.
inline constexpr double kOnWall = 2.5;

/// Walls this many tolerances off count as touched where it is looked whether they leave any room.
inline constexpr double kRoom = 4.0;

// At rest -----------------------------------------------------------------------------------------

/// The proxy has settled when what is left to slide is this share of the depth: 6e-8 degree of the
/// force's direction, ...
inline constexpr double kSettled = 1e-9;
/// ... or this share of the coordinates, which is their rounding.
inline constexpr double kRounding = 4e-15;
/// It can come closer by the second order where an eigenvalue lies below this: rounding of
/// Hessians.
inline constexpr double kSaddle = -1e-6;
/// Then it is moved by these shares of the feature size along the eigenvector.
inline constexpr double kKicks[] = {0.1, 1e-3};

/// A slide ends within this share of where the kinetic cone holds it.
inline constexpr double kSticksWithin = 1e-6;

// One step ----------------------------------------------------------------------------------------

/// Newton's eigenvalues count as at least this: longer steps along almost flat valleys overshoot.
inline constexpr double kLeastEigenvalue = 0.02;
/// Leaves within this many times the step's length of the proxy take part in it.
inline constexpr double kReachOverStep = 1.25;
/// The ball that a step is looked for in, over the step that the walls at hand allow.
inline constexpr double kBallOverStep = 1.5;
/// A step on a wall that bulges towards the proxy is at most this share of its feature size, so
/// that it does not land on the wall's other sheet, ...
inline constexpr double kShareOfFeature = 0.5;
/// ... unless it is looked at in strides of this share of it, at most so many, ...
inline constexpr double kStride = 0.4;
inline constexpr double kMostStrides = 48.0;
/// ... which cost as much as the fields at one place, so many of them;
inline constexpr int kStridesPerBatch = 8;
/// it turns no held wall's normal by more [rad].
inline constexpr double kLargestTurn = 0.5;
/// Restoring onto the walls: rounds, and how far in all, over the step. Longer jumps to another
/// sheet.
inline constexpr int kRestorations = 6;
inline constexpr double kRestoredShare = 0.5;
/// ... and this many tolerances more: what it takes to leave a groove of 0.1 degree by one.
inline constexpr double kRestoredLeast = 1000.0;
/// A step is kept if it gains this share of what it promised, less the noise of the distances.
inline constexpr double kGain = 0.01;
inline constexpr double kNoise = 10.0;
/// A step that ends within this share of the length of rest from where it began is none.
inline constexpr double kNowhere = 0.1;
/// The proxy rests too after so many steps in a row that lead nowhere: back to where one of the
/// steps before began, or within the noise of its walls and no nearer to the hand by more than this
/// share of the squared depth, which is rounding. About an apex they lead back and forth. Some more
/// may be made until one ends where the proxy is nearest.
inline constexpr int kIdleSteps = 4;
inline constexpr int kIdleMore = 2;
inline constexpr int kPlaces = 4;  ///< steps before
inline constexpr double kRoundedGain = 1e-14;
/// Where the budget ends amid such steps, the proxy rests too if all places of the tick lie within
/// so many times the noise of its walls of the first, 1e-7 of the feature size.
inline constexpr double kWanders = 10.0;
/// A Newton step shorter than this share of the plain one, where the normal would turn by more than
/// that [rad] over it, is one of a singular point: the plain step is tried in its place.
inline constexpr double kSingularStep = 0.2;
inline constexpr double kSingularTurn = 10.0;
/// Share of the curvature that is rounding: a wall that bends no more towards the proxy is convex
/// there.
inline constexpr double kFlat = 1e-6;
/// Off a saddle the step is lengthened where that makes it this many times longer.
inline constexpr double kFarther = 1.5;
/// Where normals turn by more than this [rad] on the way, its middle is looked at, ...
inline constexpr double kTurnsMuch = 0.02;
/// ... from here on its quarters too, ...
inline constexpr double kTurnsMore = 0.05;
/// ... which may dip by these shares of curvature times length squared, and of the length.
inline constexpr double kDipByBend = 0.2;
inline constexpr double kDipByLength = 0.1;
/// Tangent planes met where a step was refused, kept for the rest of the look at that place.
inline constexpr std::size_t kMaxCuts = 8;
inline constexpr int kCutRounds = 8;
/// A cut is worth keeping if its normal differs by this [rad] from the same wall's here: Newton's
/// curvature does the rest, which cuts would make linear.
inline constexpr double kCutTurn = 0.05;
/// A leaf that bends this many times more than its feature size says has a fold at the place, ...
inline constexpr double kFolds = 8.0;
/// ... and is asked this share of the feature size beyond it, ...
inline constexpr double kBeyondFold = 1e-3;
/// ... which counts if it bends by less than this share there.
inline constexpr double kFoldsLess = 0.1;
/// Cuts of one wall whose normals differ by less than this [rad] are one, if the new one is not
/// closer.
inline constexpr double kSameCut = 1e-6;
/// Cuts whose normals differ by less than this [rad] are of the same wall: the last one counts.
inline constexpr double kSameWall = 0.1;
/// Before the proxy rests on a cut, or makes a step shorter than that, its wall is asked for this
/// share of the feature size ahead.
inline constexpr double kClose = 1e-5;
/// Met so many times nearer by, a cut takes the place of one that it could have been carried to.
inline constexpr double kNearer = 10.0;
/// A cut whose wall turns by less than this [rad] between where it was met and the proxy is carried
/// back with its curvature, ...
inline constexpr double kCarries = 0.3;
/// ... if the proxy is then not further beyond it than this share of what the curvature moved it
/// by.
inline constexpr double kCarriedShare = 0.1;
/// The quick way on one smooth wall, or between two, is left to the general one after so many
/// steps, ...
inline constexpr int kGlides = 6;
/// ... for ways over which its normal turns by more than kTurnsMore, or on a ball by more than this
/// [rad], ...
inline constexpr double kGlidesFar = 0.2;
/// ... where the place of rest is a minimum by less than this (an eigenvalue: 0 at the wall's
/// center of curvature), ...
inline constexpr double kFirm = 0.02;
/// ... and where the normal turns by more than this [rad] over twice what the wall's curvature
/// explains.
inline constexpr double kFirmTurn = 1e-6;
/// Two walls between which the proxy glides meet at an angle whose sine has at least this square (6
/// degrees).
inline constexpr double kSharp = 0.01;
/// A wall is a ball's where the sum of the squares of its curvatures differs by less than this
/// share from that of two equal ones: they differ by 3e-5 then.
inline constexpr double kEven = 1e-9;
/// Where no step along the walls is kept, these shares of one are tried that may end in free space,
/// over a sharp edge.
inline constexpr double kFlights[] = {1.0, 0.1, 0.01};
/// It flies at once after this many steps that were cut short because they ended in free space.
inline constexpr int kHops = 2;
/// What a refused step is shortened to, in turn; then the ball shrinks by kShrink, kShrinks times.
inline constexpr double kShorter[] = {0.5, 0.125, 0.02};
inline constexpr double kShrink = 0.2;
inline constexpr int kShrinks = 4;

// The way through cells ---------------------------------------------------------------------------

/// Sweeps let go of grazes shorter than this share of the feature size: what they miss is no deeper
/// than 5e-7 of it.
inline constexpr double kGraze = 0.002;
inline constexpr int kEvaluationsPerTick = 4096;
inline constexpr int kEvaluationsPerSweep = 256;
/// Leaves are listed that come within so many times the length of the motion that made the list,
/// ...
inline constexpr double kHorizon = 16.0;
/// ... and at least within this share of the smallest feature.
inline constexpr double kHorizonShare = 0.1;
/// So many tolerances off a leaf the point counts as touching it.
inline constexpr double kTouch = 4.0;
/// Two leaves there are one facet where their normals are parallel to this (1 less the cosine).
inline constexpr double kParallel = 1e-6;
/// A slide takes so many straight moves: to above where it lands, and down.
inline constexpr std::uint64_t kStaysOfSlide = 2;

// One tick ----------------------------------------------------------------------------------------

/// Places at which fields are asked. A smooth wall takes 2 or 3, corners 8; the rest waits for the
/// next tick.
inline constexpr int kMaxBatches = 160;
/// Crossings of facets between cells; each takes some microseconds at most.
inline constexpr int kCrossings = 32;

}  // namespace palpate::limits
