#include "scene/paper_reader.h"

namespace palpate {

PaperParameters readPaper(const MapReader& reader) {
  constexpr AlphaForm kForms[] = {AlphaForm::kByMetric, AlphaForm::kLength, AlphaForm::kNewton};
  constexpr PaperInterior kInteriors[] = {PaperInterior::kTogether, PaperInterior::kWall};
  PaperParameters paper;
  if (reader.has("epsilon")) paper.epsilon = reader.value("epsilon");
  if (reader.has("halvings")) paper.max_halvings = static_cast<int>(reader.value("halvings"));
  if (reader.has("alpha")) paper.alpha = reader.value("alpha");
  if (reader.has("form")) paper.alpha_form = kForms[reader.choice("form")];
  if (reader.has("interior")) paper.interior = kInteriors[reader.choice("interior")];
  return paper;
}

}  // namespace palpate
