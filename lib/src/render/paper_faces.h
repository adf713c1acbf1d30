#pragma once
/// The faces of one layer, as the paper's table of states uses them: A, the faces that are walls
/// now, and B, those that are open ports now.

#include <vector>

#include "palpate/fields/field.h"
#include "palpate/interior/partition.h"
#include "palpate/interior/port.h"

namespace palpate {

/// A smooth part of a layer's border: one operand of the intersection that forms the layer.
struct PaperFace {
  FieldPtr field;              ///< [world] negative on the layer's side
  std::vector<LeafId> leaves;  ///< of the partition
  std::vector<PortId> ports;  ///< those that lie on all of this face, and are open everywhere on it
};

/// The walls of a layer as one field: the max of its closed faces. The set of closed faces changes
/// only between two ticks; in a tick it is a field like any other.
class PaperWall final : public Field {
 public:
  /// Splits `whole` into the operands of its intersections.
  PaperWall(const FieldPtr& whole, const Partition& partition);

  [[nodiscard]] std::vector<PaperFace>& faces() noexcept { return faces_; }
  [[nodiscard]] const std::vector<PaperFace>& faces() const noexcept { return faces_; }

  /// Makes a face a wall or an opening. Real-time safe.
  void setOpen(std::size_t face, bool is_open) noexcept;
  [[nodiscard]] bool hasWalls() const noexcept { return open_count_ < faces_.size(); }
  /// Whether `p` [m] is on the layer's side of all openings. A point on an opening is not, as in
  /// the cells of ports.
  [[nodiscard]] bool isWithinOpenings(const Vec3& p) const noexcept;

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override;
  [[nodiscard]] double value(const Vec3& p) const noexcept override;
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return metric_; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  void takeApart(const FieldPtr& field, const Pose& pose, bool is_inverted,
                 const Partition& partition);

  std::vector<PaperFace> faces_;
  std::vector<char> is_open_;  ///< by face
  std::size_t open_count_ = 0;
  Metric metric_ = Metric::kExact;
  double lipschitz_ = 0.0;
  double feature_ = kInfinity;  ///< [m]
};

}  // namespace palpate
