#pragma once
// A field that counts queries of it.

#include <atomic>
#include <cstdint>
#include <utility>

#include "palpate/fields/field.h"

namespace palpate::vdb::test {

/// Counts queries of a field; a batch counts once for each of its points.
class Counted final : public Field {
 public:
  explicit Counted(FieldPtr field) : field_(std::move(field)) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    ++looks_;
    return field_->sample(p);
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    ++looks_;
    return field_->value(p);
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    looks_ += PointBatch::kCount;
    field_->values(points, out);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    ++looks_;
    return field_->jet(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return field_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return field_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return field_->lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return field_->lipschitzDomain(); }
  [[nodiscard]] double featureSize() const noexcept override { return field_->featureSize(); }
  [[nodiscard]] double looks() const noexcept { return static_cast<double>(looks_.load()); }

 private:
  FieldPtr field_;
  mutable std::atomic<std::uint64_t> looks_ = 0;
};

}  // namespace palpate::vdb::test
