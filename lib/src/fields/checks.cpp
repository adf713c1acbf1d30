#include "fields/checks.h"

#include <string>
#include <utility>

#include "fields/vector.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"

namespace palpate::fields {
namespace {

std::string text(const Vec3& v) {
  return "[" + exactNumber(v.x) + ", " + exactNumber(v.y) + ", " + exactNumber(v.z) + "]";
}

std::string place(std::string_view shape, std::string_view parameter) {
  return std::string(shape) + ": " + std::string(parameter);
}

bool hasBand(const Field& field, const Box3& bounds) {
  const Box3 around = bounds.grownBy(glm::length(bounds.size()));
  return !field.sample(around.lo).in_band || !field.sample(around.hi).in_band;
}

bool isLength(double value) { return value >= kSmallestLength && value <= kLargestLength; }

std::string lengthRange() {
  return "from " + exactNumber(kSmallestLength) + " to " + exactNumber(kLargestLength) + " m";
}

}  // namespace

void checkLength(std::string_view shape, std::string_view parameter, double value) {
  if (isLength(value)) return;
  throw inputError(
      "field.bad_length",
      place(shape, parameter) + " is " + exactNumber(value) + "; it must be " + lengthRange(),
      "lengths are positive and in meters");
}

void checkNonNegative(std::string_view shape, std::string_view parameter, double value) {
  checkRange(shape, parameter, value, 0.0, kLargestLength);
}

void checkRange(std::string_view shape, std::string_view parameter, double value, double lowest,
                double highest) {
  if (value >= lowest && value <= highest) return;
  throw inputError("field.out_of_range", place(shape, parameter) + " is " + exactNumber(value) +
                                             "; it must be from " + exactNumber(lowest) + " to " +
                                             exactNumber(highest));
}

void checkFinite(std::string_view shape, std::string_view parameter, double value) {
  if (std::isfinite(value)) return;
  throw inputError("field.not_finite", place(shape, parameter) + " is " + exactNumber(value) +
                                           "; it must be a finite number");
}

void checkPoint(std::string_view shape, std::string_view parameter, const Vec3& value) {
  if (isFinite(value)) return;
  throw inputError("field.not_finite", place(shape, parameter) + " is " + text(value) +
                                           "; it must be three finite numbers");
}

void checkLengths(std::string_view shape, std::string_view parameter, const Vec3& value) {
  if (isLength(value.x) && isLength(value.y) && isLength(value.z)) return;
  throw inputError("field.bad_length",
                   place(shape, parameter) + " is " + text(value) + "; each of the three must be " +
                       lengthRange(),
                   "lengths are positive and in meters");
}

Vec3 checkedDirection(std::string_view shape, std::string_view parameter, const Vec3& value) {
  checkPoint(shape, parameter, value);
  const Polar direction = polar(value, Vec3(0.0, 0.0, 0.0));
  if (direction.length > 0.0) {
    // Normalize once more: the first quotient is off by an ulp or two, and every query would
    // inherit that.
    return direction.direction / glm::length(direction.direction);
  }
  throw inputError("field.zero_direction",
                   place(shape, parameter) + " is " + text(value) + ", which has no direction",
                   "give any vector but zero; its length does not matter");
}

FieldPtr checkedOperand(std::string_view shape, FieldPtr value) {
  if (value) return value;
  throw inputError("field.null_operand",
                   std::string(shape) + ": the operand is null; it must be a field");
}

void checkOperands(std::string_view shape, const std::vector<FieldPtr>& operands,
                   std::size_t fewest) {
  if (operands.size() < fewest) {
    throw inputError("field.too_few_operands",
                     std::string(shape) + ": there are " + std::to_string(operands.size()) +
                         " operands; there must be " + std::to_string(fewest) + " or more");
  }
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (operands[i]) continue;
    throw inputError("field.null_operand",
                     std::string(shape) + ": operand " + std::to_string(i + 1) + " of " +
                         std::to_string(operands.size()) + " is null; it must be a field");
  }
}

void checkBand(std::string_view shape, const Field& field, double reach) {
  const FieldStructure structure = field.structure();
  for (const FieldPtr& operand : structure.operands) checkBand(shape, *operand, reach);
  const Box3 bounds = field.bounds();
  if (!structure.operands.empty() || !bounds.isBounded() || !hasBand(field, bounds)) return;
  // A band narrower than `reach` shows at some of these points, deep inside and between the surface
  // and its box.
  constexpr int kSteps = 32;
  for (int i = 0; i < (kSteps + 1) * (kSteps + 1) * (kSteps + 1); ++i) {
    const Vec3 share(i % (kSteps + 1), i / (kSteps + 1) % (kSteps + 1),
                     i / (kSteps + 1) / (kSteps + 1));
    const FieldSample s = field.sample(bounds.lo + share * (1.0 / kSteps) * bounds.size());
    if (s.in_band || std::fabs(s.value) >= reach) continue;
    throw inputError("field.band_too_narrow",
                     std::string(shape) + ": it needs distances up to " + exactNumber(reach) +
                         " m from the surface, and the band of the grid ends at " +
                         exactNumber(std::fabs(s.value)) + " m",
                     "make the band wider, or the voxels larger");
  }
}

}  // namespace palpate::fields
