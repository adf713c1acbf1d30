#include "closed_loop.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>

#include "palpate/core/error.h"
#include "plant_matrix.h"

namespace palpate::devices {
namespace {

constexpr int kMostDelay = 1000;  // [samples] a matrix with that many rows takes seconds

void check(const LoopModel& loop) {
  check(loop.device);
  if (loop.hand) check(*loop.hand);
  if (!(std::isfinite(loop.period) && loop.period > 0.0)) {
    throw Error(ErrorKind::kUsage, {"loop.period", "the period of a loop must be above 0 s, not " +
                                                       std::to_string(loop.period)});
  }
  if (loop.delay < 0 || loop.delay > kMostDelay) {
    throw Error(ErrorKind::kUsage,
                {"loop.delay", "the delay of a loop must be 0 to " + std::to_string(kMostDelay) +
                                   " samples, not " + std::to_string(loop.delay)});
  }
}

/// The same matrix with the moving mass and the period as units.
plant::Matrix scaledMatrix(const LoopModel& loop, double mass) {
  const double t = loop.period;
  DeviceModel device = loop.device;
  device.mass /= mass;
  device.damping *= t / mass;
  device.lag /= t;
  std::optional<HandModel> hand = loop.hand;
  if (hand) {
    hand->mass /= mass;
    hand->damping *= t / mass;
    hand->stiffness *= t * t / mass;
    hand->grip_stiffness *= t * t / mass;
    hand->grip_damping *= t / mass;
  }
  return plant::matrixOf(device, hand);
}

}  // namespace

ClosedLoop::ClosedLoop(const LoopModel& loop)
    : weights_((check(loop), velocityWeights(loop.velocity, loop.period))),
      mass_(plant::movingMass(loop.device, loop.hand)),
      period_(loop.period),
      delay_(loop.delay) {
  for (double& weight : weights_) weight *= period_;
  const plant::Matrix step = scaledMatrix(loop, mass_).exp();
  std::vector<int> states = {plant::kX, plant::kV};
  if (loop.hand && loop.hand->hasGrip()) {
    states.push_back(plant::kHandX);
    states.push_back(plant::kHandV);
  }
  const bool has_lag = loop.device.lag > 0.0;
  if (has_lag) states.push_back(plant::kForce);
  const int from = has_lag ? plant::kCommand : plant::kForce;
  const auto size = static_cast<Eigen::Index>(states.size());
  plant_.resize(size, size);
  input_.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int row = states[static_cast<std::size_t>(i)];
    input_(i) = step(row, from);
    for (Eigen::Index j = 0; j < size; ++j) {
      plant_(i, j) = step(row, states[static_cast<std::size_t>(j)]);
    }
  }
}

double ClosedLoop::growth(const WallModel& wall) const {
  const double stiffness = wall.stiffness / unitOfStiffness();
  const double damping = wall.damping / unitOfDamping();
  const Eigen::Index own = plant_.rows();
  const Eigen::Index memory = damping > 0.0 ? static_cast<Eigen::Index>(weights_.size()) - 1 : 0;
  const Eigen::Index size = own + memory + delay_;
  // The present force as a function of the present state: the plant, its earlier positions, the
  // earlier forces.
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(size);
  force(0) = -stiffness;
  if (damping > 0.0) {
    force(0) -= damping * weights_[0];
    for (Eigen::Index i = 0; i < memory; ++i) {
      force(own + i) = -damping * weights_[static_cast<std::size_t>(i) + 1];
    }
  }
  Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(size, size);
  loop.topLeftCorner(own, own) = plant_;
  if (delay_ == 0) {
    loop.topRows(own) += input_ * force;
  } else {
    loop.col(size - 1).head(own) += input_;
    loop.row(own + memory) = force;
    for (Eigen::Index i = 1; i < delay_; ++i) loop(own + memory + i, own + memory + i - 1) = 1.0;
  }
  for (Eigen::Index i = 0; i < memory; ++i) loop(own + i, i == 0 ? 0 : own + i - 1) = 1.0;
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}

bool ClosedLoop::isStable(const WallModel& wall) const {
  // Without a spring the position itself neither grows nor decays, and a mass without damping is a
  // double root.
  const double rounding = wall.stiffness > 0.0 ? 1e-12 : 1e-9;
  return growth(wall) <= 1.0 + rounding;
}

}  // namespace palpate::devices
