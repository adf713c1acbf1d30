#pragma once
// Fields that hide their structure, as a mesh or a grid does.

#include "lib/render/drive.h"

namespace palpate::test {

/// A field with a hidden structure.
class Opaque final : public Field {
 public:
  Opaque(FieldPtr field, double feature) : field_(std::move(field)), feature_(feature) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return field_->sample(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return field_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return field_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return field_->lipschitz(); }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  FieldPtr field_;
  double feature_;
};

/// The field as a black box, in a scene that starts outside it.
inline ScenePtr sceneOfLeaf(FieldPtr field, double feature) {
  SceneDescription description;
  LayerDescription layer;
  layer.name = "solid";
  layer.inside = std::make_shared<FieldSource>(std::make_shared<Opaque>(std::move(field), feature));
  description.layers.push_back(layer);
  return compile(description);
}

}  // namespace palpate::test
