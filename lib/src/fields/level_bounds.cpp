#include "fields/level_bounds.h"

namespace palpate::fields {

Box3 boundsBelow(const Field& field, double level) {
  if (level <= 0.0) return field.bounds();
  if (field.metric() == Metric::kExact) return field.bounds().grownBy(level);
  if (const auto* leaf = dynamic_cast<const LevelBounded*>(&field)) return leaf->boundsBelow(level);
  using Kind = FieldStructure::Kind;
  const FieldStructure structure = field.structure();
  switch (structure.kind) {
    case Kind::kUnion: {
      Box3 box;
      for (const FieldPtr& operand : structure.operands) {
        box = box.unitedWith(boundsBelow(*operand, level));
      }
      return box;
    }
    case Kind::kIntersection: {
      Box3 box = Box3::everything();
      for (const FieldPtr& operand : structure.operands) {
        box = box.intersectedWith(boundsBelow(*operand, level));
      }
      return box.isEmpty() ? Box3{} : box;
    }
    case Kind::kTransform:
      return structure.pose.apply(boundsBelow(*structure.operands.front(), level));
    case Kind::kComplement:
    case Kind::kFaces:
    case Kind::kLeaf:
      break;
  }
  return Box3::everything();
}

}  // namespace palpate::fields
