#include "scene/paper_reader.h"

#include <cmath>

#include "scene/values.h"

namespace palpate {
namespace {

constexpr double kMostHalvings = 1000.0;

}  // namespace

PaperParameters readPaper(const SceneLoader& loader, const Node& node) {
  const Document& document = loader.document();
  MapReader reader(loader, node, "'paper'");
  PaperParameters paper;
  if (reader.optional("epsilon") != nullptr) {
    paper.epsilon = reader.requireLength("epsilon");
    if (!(*paper.epsilon > 0.0)) {
      throw reader.errorAt("epsilon", "scene.range", "'epsilon' must be more than 0");
    }
  }
  if (reader.optional("halvings") != nullptr) {
    const double halvings = reader.numberOr("halvings", 0.0);
    if (halvings != std::floor(halvings) || halvings < 1.0 || halvings > kMostHalvings) {
      throw reader.errorAt("halvings", "scene.range",
                           "'halvings' must be a whole number from 1 to 1000");
    }
    paper.max_halvings = static_cast<int>(halvings);
  }
  if (reader.optional("alpha") != nullptr) {
    paper.alpha = reader.numberOr("alpha", 0.0);
    if (!(*paper.alpha >= 0.0)) {
      throw reader.errorAt("alpha", "scene.range", "'alpha' must be 0 or more");
    }
  }
  if (const Node* form = reader.optional("form")) {
    constexpr AlphaForm kForms[] = {AlphaForm::kByMetric, AlphaForm::kLength, AlphaForm::kNewton};
    paper.alpha_form =
        kForms[readChoice(document, *form, "'form'", {"by_field", "printed", "newton"})];
  }
  if (const Node* interior = reader.optional("interior")) {
    constexpr PaperInterior kInteriors[] = {PaperInterior::kTogether, PaperInterior::kWall};
    paper.interior =
        kInteriors[readChoice(document, *interior, "'interior'", {"together", "wall"})];
  }
  reader.finish();
  return paper;
}

}  // namespace palpate
