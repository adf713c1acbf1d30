#pragma once
/// Layers from one label image share its points: each point belongs to the label whose field is
/// smallest, so that touching organs have one common wall and no sliver between them.

#include <vector>

#include "palpate/interior/partition.h"

namespace palpate {

/// A layer of the image.
struct LabelField {
  FieldPtr field;
  /// Ascending. Layers that share a label do not limit each other.
  std::vector<int> labels = {};
};

struct SharedLabels {
  /// For every field f_i of one image: max(f_i, max over j of (f_i - f_j) / 2), where j runs over
  /// the layers that limit it. It is negative where f_i is negative and smallest; the results of
  /// two neighbors are exact negatives of each other at their wall. Its structure contains f_i and
  /// one smooth wall for each neighbor, which both share.
  std::vector<FieldPtr> fields;
  std::vector<LeafBetween> walls;
};
[[nodiscard]] SharedLabels shareLabels(const std::vector<LabelField>& layers);

}  // namespace palpate
