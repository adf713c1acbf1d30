#include "plant_tables.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "plant_matrix.h"

namespace palpate::devices {
namespace {

using plant::kSize;
using plant::Matrix;

/// With friction, events are searched between the ends of a step. Speed and force must not reverse
/// twice within it: the phase of the fastest mode changes by at most this [rad].
constexpr double kMostTurn = 0.25;

using Form = Eigen::Matrix<double, kSize, kSize>;
using Twice = Eigen::Matrix<double, 2 * kSize, 2 * kSize>;

/// The integral of e^(M't) Q e^(Mt) over `length` (Van Loan, IEEE Transactions on Automatic Control
/// 23(3), 1978).
Form gramian(const Matrix& m, const Form& q, double length) {
  Twice block = Twice::Zero();
  block.topLeftCorner<kSize, kSize>() = -m.transpose() * length;
  block.topRightCorner<kSize, kSize>() = q * length;
  block.bottomRightCorner<kSize, kSize>() = m * length;
  const Twice e = block.exp();
  return e.bottomRightCorner<kSize, kSize>().transpose() * e.topRightCorner<kSize, kSize>();
}

void store(const Form& form, std::array<double, 81>& out) {
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) out[static_cast<std::size_t>(kSize * i + j)] = form(i, j);
  }
}

PlantStep stepOf(const Matrix& m, double length, bool has_lag) {
  PlantStep step;
  const Matrix e = (m * length).exp();
  for (int i = 0; i < plant::kPath; ++i) {
    for (int j = 0; j < kSize; ++j) step.next[static_cast<std::size_t>(kSize * i + j)] = e(i, j);
  }
  Form q = Form::Zero();
  q(plant::kV, plant::kV) = 1.0;
  store(gramian(m, q, length), step.speed);
  if (!has_lag) return step;
  q.setZero();
  q(plant::kV, plant::kForce) = 0.5;
  q(plant::kForce, plant::kV) = 0.5;
  store(gramian(m, q, length), step.power);
  return step;
}

PlantState rowOf(const Eigen::Matrix<double, 1, kSize>& row) {
  PlantState out{};
  for (int j = 0; j < kSize; ++j) out[static_cast<std::size_t>(j)] = row(j);
  return out;
}

}  // namespace

PlantTables::PlantTables(const DeviceModel& device, const std::optional<HandModel>& hand,
                         double period)
    : mass(plant::movingMass(device, hand)),
      friction(device.friction),
      has_lag(device.lag > 0.0),
      has_grip(hand && hand->hasGrip()) {
  const Matrix moves = plant::matrixOf(device, hand);
  const Matrix sticks = plant::matrixOf(device, hand, true);
  double steps = 1.0;
  if (friction > 0.0) {
    const double fastest = std::max(moves.eigenvalues().cwiseAbs().maxCoeff(),
                                    sticks.eigenvalues().cwiseAbs().maxCoeff());
    steps = std::max(1.0, std::ceil(period * fastest / kMostTurn));
  }
  double length = period / steps;
  quantum = std::ldexp(length, -kDepth);
  for (std::size_t level = 0; level < moving.size(); ++level, length *= 0.5) {
    moving[level] = stepOf(moves, length, has_lag);
    if (friction > 0.0) sticking[level] = stepOf(sticks, length, has_lag);
  }
  acceleration = rowOf(moves.row(plant::kV));
  jerk = rowOf(moves.row(plant::kV) * sticks);
}

}  // namespace palpate::devices
