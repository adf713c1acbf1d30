#include "palpate/scene/description.h"

namespace palpate {

Error errorAt(const SourcePlace& place, std::string code, std::string message, std::string hint) {
  return Error(ErrorKind::kInput, {std::move(code), std::move(message), std::move(hint), place.file,
                                   place.line, place.column, place.excerpt});
}

const FieldPtr& FieldSource::get(const Progress& progress) const {
  if (!made_) {
    if (maker_) made_ = maker_(progress);
    if (!made_) {
      throw inputError("field.empty", "nothing came of the field" +
                                          (summary_.empty() ? std::string() : " " + summary_));
    }
  }
  return made_;
}

std::optional<Box3> FieldSource::bounds(const Progress& progress) const {
  if (made_) return made_->bounds();
  if (!measurer_) return std::nullopt;
  return measurer_(progress);
}

}  // namespace palpate
