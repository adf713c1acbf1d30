#include "paper_faces.h"

#include <algorithm>

#include "palpate/fields/csg.h"

namespace palpate {

PaperWall::PaperWall(const FieldPtr& whole, const Partition& partition) {
  takeApart(whole, Pose{}, false, partition);
  is_open_.assign(faces_.size(), 0);
  if (faces_.size() > 1) metric_ = Metric::kBound;
  for (const PaperFace& face : faces_) {
    if (face.field->metric() == Metric::kImplicit || faces_.size() == 1) {
      metric_ = face.field->metric();
    }
    lipschitz_ = std::max(lipschitz_, face.field->lipschitz());
    feature_ = std::min(feature_, face.field->featureSize());
  }
}

void PaperWall::takeApart(const FieldPtr& field, const Pose& pose, bool is_inverted,
                          const Partition& partition) {
  using Kind = FieldStructure::Kind;
  const FieldStructure structure = field->structure();
  if (structure.kind == Kind::kTransform) {
    return takeApart(structure.operands.front(), pose.after(structure.pose), is_inverted,
                     partition);
  }
  if (structure.kind == Kind::kComplement) {
    return takeApart(structure.operands.front(), pose, !is_inverted, partition);
  }
  if (structure.kind == (is_inverted ? Kind::kUnion : Kind::kIntersection)) {
    for (const FieldPtr& operand : structure.operands) {
      takeApart(operand, pose, is_inverted, partition);
    }
    return;
  }
  const bool is_moved = pose.rotation != Mat3(1.0) || pose.translation != Vec3(0.0);
  const FieldPtr placed = is_moved ? place(field, pose) : field;
  faces_.push_back(
      {is_inverted ? complement(placed) : placed, partition.leavesOf(field.get()), {}});
}

void PaperWall::setOpen(std::size_t face, bool is_open) noexcept {
  if ((is_open_[face] != 0) == is_open) return;
  is_open_[face] = is_open ? 1 : 0;
  open_count_ = is_open ? open_count_ + 1 : open_count_ - 1;
}

bool PaperWall::isWithinOpenings(const Vec3& p) const noexcept {
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (is_open_[i] != 0 && !(faces_[i].field->value(p) < 0.0)) return false;
  }
  return true;
}

FieldSample PaperWall::sample(const Vec3& p) const noexcept {
  std::size_t most = faces_.size();
  double largest = -kInfinity;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (is_open_[i] != 0) continue;
    const double value = faces_[i].field->value(p);
    if (value > largest) {
      largest = value;
      most = i;
    }
  }
  return most < faces_.size() ? faces_[most].field->sample(p) : FieldSample{};
}

double PaperWall::value(const Vec3& p) const noexcept {
  double largest = -kInfinity;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (is_open_[i] == 0) largest = std::max(largest, faces_[i].field->value(p));
  }
  return largest;
}

}  // namespace palpate
