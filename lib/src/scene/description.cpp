#include "palpate/scene/description.h"

namespace palpate {

Error errorAt(const SourcePlace& place, std::string code, std::string message, std::string hint) {
  return Error(ErrorKind::kInput, {std::move(code), std::move(message), std::move(hint), place.file,
                                   place.line, place.column, place.excerpt});
}

namespace {

FieldPtr checked(FieldPtr made, const std::string& summary) {
  if (!made) {
    throw inputError("field.empty",
                     "the field" + (summary.empty() ? "" : " " + summary) + " could not be made");
  }
  return made;
}

}  // namespace

const FieldPtr& FieldSource::get(const Progress& progress) const {
  if (!made_) {
    FieldPtr made;
    if (maker_) made = maker_(progress);
    if (part_maker_) made = part_maker_(Box3::everything(), progress);
    made_ = checked(std::move(made), summary_);
  }
  return made_;
}

const FieldPtr& FieldSource::get(const Box3& within, const Progress& progress) const {
  if (part_ && part_within_.lo == within.lo && part_within_.hi == within.hi) return part_;
  if (made_ || !part_maker_ || !within.isBounded()) return get(progress);
  part_ = checked(part_maker_(within, progress), summary_);
  part_within_ = within;
  return part_;
}

std::optional<Box3> FieldSource::bounds(const Progress& progress) const {
  if (made_) return made_->bounds();
  if (!measurer_) return std::nullopt;
  return measurer_(progress);
}

}  // namespace palpate
