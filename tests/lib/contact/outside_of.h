#pragma once
// Walls for the tests of contact.

#include "palpate/contact/slide.h"
#include "palpate/fields/field.h"

namespace palpate::test {

/// The surface of `field`, for a hand outside it.
inline HeldWall outsideOf(const FieldPtr& field) {
  HeldWall out;
  out.field = field.get();
  out.side = 1.0;
  return out;
}

}  // namespace palpate::test
