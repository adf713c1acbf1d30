#include <utility>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

class WithFaces final : public Field {
 public:
  WithFaces(FieldPtr whole, std::vector<FieldPtr> faces)
      : whole_(std::move(whole)), faces_(std::move(faces)) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return whole_->sample(p);
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return whole_->value(p); }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    whole_->values(points, out);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override { return whole_->jet(p); }
  [[nodiscard]] Box3 bounds() const noexcept override { return whole_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return whole_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return whole_->lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return whole_->lipschitzDomain(); }
  [[nodiscard]] double featureSize() const noexcept override { return whole_->featureSize(); }
  [[nodiscard]] FieldStructure structure() const noexcept override {
    return {FieldStructure::Kind::kFaces, faces_, {}};
  }

 private:
  FieldPtr whole_;
  std::vector<FieldPtr> faces_;
};

}  // namespace

FieldPtr withFaces(FieldPtr whole, std::vector<FieldPtr> faces) {
  bool is_complete = whole != nullptr && !faces.empty();
  for (const FieldPtr& face : faces) is_complete = is_complete && face != nullptr;
  if (!is_complete) {
    throw inputError("field.faces", "a solid with faces needs the solid and at least one face");
  }
  return std::make_shared<WithFaces>(std::move(whole), std::move(faces));
}

}  // namespace palpate
