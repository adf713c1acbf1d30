#pragma once
/// Boxes around level sets other than zero. Private to fields.

#include "palpate/fields/field.h"

namespace palpate::fields {

/// Implemented by leaves that know where their value is low although they are not exact.
class LevelBounded {
 public:
  /// Box around the points with value <= `level` [m], for level > 0.
  [[nodiscard]] virtual Box3 boundsBelow(double level) const = 0;

 protected:
  ~LevelBounded() = default;
};

/// Box around the points where `field` <= `level`; all space where no smaller box is known. Set-up
/// only.
[[nodiscard]] Box3 boundsBelow(const Field& field, double level);

}  // namespace palpate::fields
