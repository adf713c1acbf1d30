#include "support/oracle/feasible_set.h"

#include <algorithm>
#include <utility>

namespace palpate::oracle {

double FieldSide::spacing() const noexcept {
  // Truncation error (spacing / feature)^4 / 30 and rounding error 1e-16 feature / spacing are both
  // near 1e-13.
  return 1e-3 * field->featureSize();
}

Vec3 FieldSide::gradient(const Vec3& p, double scale) const noexcept {
  const double h = scale * spacing();
  Vec3 out(0.0);
  for (int i = 0; i < 3; ++i) {
    Vec3 step(0.0);
    step[i] = h;
    out[i] = (8.0 * (value(p + step) - value(p - step)) -
              (value(p + 2.0 * step) - value(p - 2.0 * step))) /
             (12.0 * h);
  }
  return out;
}

Mat3 FieldSide::hessian(const Vec3& p) const noexcept {
  const double h = 4.0 * spacing();  // second differences divide the rounding error by h twice
  const double center = value(p);
  Mat3 out(0.0);
  for (int i = 0; i < 3; ++i) {
    Vec3 a(0.0);
    a[i] = h;
    out[i][i] = (16.0 * (value(p + a) + value(p - a)) - (value(p + 2.0 * a) + value(p - 2.0 * a)) -
                 30.0 * center) /
                (12.0 * h * h);
    for (int j = 0; j < i; ++j) {
      Vec3 b(0.0);
      b[j] = h;
      const auto mixed = [&](double scale) {
        return (value(p + scale * (a + b)) + value(p - scale * (a + b)) -
                value(p + scale * (a - b)) - value(p - scale * (a - b))) /
               (4.0 * scale * scale * h * h);
      };
      out[i][j] = out[j][i] = (4.0 * mixed(1.0) - mixed(2.0)) / 3.0;
    }
  }
  return out;
}

FeasibleSet FeasibleSet::of(FieldPtr field, double sign, const Pose& pose) {
  const FieldStructure structure = field->structure();
  using Kind = FieldStructure::Kind;
  switch (structure.kind) {
    case Kind::kComplement:
      return of(structure.operands[0], -sign, pose);
    case Kind::kTransform:
      return of(structure.operands[0], sign, pose.after(structure.pose));
    case Kind::kUnion:
    case Kind::kIntersection:
    case Kind::kFaces: {
      std::vector<FeasibleSet> sets;
      for (const FieldPtr& operand : structure.operands) sets.push_back(of(operand, sign, pose));
      // Outside a union means outside all its operands; inside it means inside any of them.
      const bool all = (structure.kind == Kind::kUnion) == (sign > 0.0);
      return all ? allOf(sets) : anyOf(sets);
    }
    case Kind::kLeaf:
      break;
  }
  FeasibleSet set;
  set.feature_ = field->featureSize();
  set.sides_.push_back({std::move(field), sign, pose});
  set.branches_.push_back({0});
  return set;
}

std::size_t FeasibleSet::append(const FeasibleSet& other) {
  const std::size_t offset = sides_.size();
  sides_.insert(sides_.end(), other.sides_.begin(), other.sides_.end());
  feature_ = std::min(feature_, other.feature_);
  return offset;
}

FeasibleSet FeasibleSet::anyOf(const std::vector<FeasibleSet>& sets) {
  FeasibleSet out;
  for (const FeasibleSet& set : sets) {
    const std::size_t offset = out.append(set);
    for (Branch branch : set.branches_) {
      for (std::size_t& side : branch) side += offset;
      out.branches_.push_back(std::move(branch));
    }
  }
  return out;
}

FeasibleSet FeasibleSet::allOf(const std::vector<FeasibleSet>& sets) {
  FeasibleSet out;
  out.branches_ = {Branch{}};
  for (const FeasibleSet& set : sets) {
    const std::size_t offset = out.append(set);
    std::vector<Branch> product;
    for (const Branch& left : out.branches_) {
      for (const Branch& right : set.branches_) {
        Branch both = left;
        for (const std::size_t side : right) both.push_back(side + offset);
        product.push_back(std::move(both));
      }
    }
    out.branches_ = std::move(product);
  }
  return out;
}

double FeasibleSet::value(const Vec3& p) const noexcept {
  double best = -kInfinity;
  for (const Branch& branch : branches_) {
    double worst = kInfinity;
    for (const std::size_t side : branch) worst = std::min(worst, sides_[side].value(p));
    best = std::max(best, worst);
  }
  return best;
}

}  // namespace palpate::oracle
