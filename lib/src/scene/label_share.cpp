#include "label_share.h"

#include <algorithm>
#include <utility>

#include "palpate/core/stop.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

/// Share of the feature size: where both labels are positive, the wall between them is kept away
/// from zero by this.
constexpr double kApart = 0.25;

/// The wall between two labels where both fields are negative: (f_a - f_b) / 2, negative where the
/// point belongs to `a`. It has a meaning only there. Elsewhere it is kept from being zero: far
/// from both labels two grids may have the same constant value, and a wall would appear everywhere
/// there.
class LabelWall final : public Field {
 public:
  LabelWall(FieldPtr a, FieldPtr b, const Box3& box)
      : a_(std::move(a)),
        b_(std::move(b)),
        box_(box),
        lipschitz_(std::max({1.0, 1.5 * a_->lipschitz() + 0.5 * b_->lipschitz(),
                             0.5 * a_->lipschitz() + 1.5 * b_->lipschitz()})),
        feature_(std::min(a_->featureSize(), b_->featureSize())),
        margin_(kApart * feature_) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample a = a_->sample(p);
    const FieldSample b = b_->sample(p);
    FieldSample out;
    out.in_band = a.in_band && b.in_band;
    out.value = 0.5 * (a.value - b.value);
    out.gradient = 0.5 * (a.gradient - b.gradient);
    const FieldSample& low = a.value <= b.value ? a : b;
    if (low.value > margin_) {
      out.value += low.value - margin_;
      out.gradient += low.gradient;
    }
    const double away = box_.distanceTo(p);
    if (away > 0.0 && away > out.value) {
      const Vec3 nearest = glm::clamp(p, box_.lo, box_.hi);
      return {away, unitOr(p - nearest, Vec3(0.0, 0.0, 1.0)), true};
    }
    if (!out.in_band) out.gradient = Vec3(0.0);
    return out;
  }

  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    const double a = a_->value(p);
    const double b = b_->value(p);
    return std::max(0.5 * (a - b) + std::max(0.0, std::min(a, b) - margin_), awayAt(p));
  }

  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldJet a = a_->jet(p);
    const FieldJet b = b_->jet(p);
    const double half = 0.5 * (a.value - b.value);
    if (!a.in_band || !b.in_band || std::min(a.value, b.value) > margin_ || awayAt(p) > half) {
      return Field::jet(p);
    }
    return {half, 0.5 * (a.gradient - b.gradient), 0.5 * (a.hessian - b.hessian), true};
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return box_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    return a_->lipschitzDomain().intersectedWith(b_->lipschitzDomain());
  }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  /// Distance from the box; -infinity within it, so that it never raises the wall itself.
  [[nodiscard]] double awayAt(const Vec3& p) const noexcept {
    const double away = box_.distanceTo(p);
    return away > 0.0 ? away : -kInfinity;
  }

  FieldPtr a_;
  FieldPtr b_;
  Box3 box_;
  double lipschitz_;
  double feature_;
  double margin_;
};

class LabelShare final : public Field {
 public:
  /// `faces`: the label's own field, and for each other label the wall between the two.
  LabelShare(FieldPtr own, std::vector<FieldPtr> others, std::vector<FieldPtr> faces)
      : own_(std::move(own)), others_(std::move(others)), faces_(std::move(faces)) {
    lipschitz_ = own_->lipschitz();
    feature_ = own_->featureSize();
    domain_ = own_->lipschitzDomain();
    for (const FieldPtr& other : others_) {
      lipschitz_ = std::max(lipschitz_, 0.5 * (own_->lipschitz() + other->lipschitz()));
      feature_ = std::min(feature_, other->featureSize());
      domain_ = domain_.intersectedWith(other->lipschitzDomain());
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample own = own_->sample(p);
    FieldSample out = own;
    for (const FieldPtr& other : others_) {
      // If the other label's field is at least -own.value, half the difference is at most own.value
      // and cannot be the maximum.
      if (other->value(p) >= -own.value) continue;
      const FieldSample theirs = other->sample(p);
      const double half = 0.5 * (own.value - theirs.value);
      if (half > out.value) {
        out.value = half;
        out.in_band = own.in_band && theirs.in_band;
        out.gradient = out.in_band ? 0.5 * (own.gradient - theirs.gradient) : Vec3(0.0);
      }
    }
    return out;
  }

  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    const double own = own_->value(p);
    double out = own;
    for (const FieldPtr& other : others_) out = std::max(out, 0.5 * (own - other->value(p)));
    return out;
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return own_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return domain_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }
  [[nodiscard]] FieldStructure structure() const noexcept override {
    return {FieldStructure::Kind::kFaces, faces_, {}};
  }

 private:
  FieldPtr own_;
  std::vector<FieldPtr> others_;
  std::vector<FieldPtr> faces_;
  double lipschitz_ = 1.0;
  double feature_ = 1.0;
  Box3 domain_;
};

bool haveCommon(const std::vector<int>& a, const std::vector<int>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

}  // namespace

SharedLabels shareLabels(const std::vector<LabelField>& layers) {
  SharedLabels out;
  const std::size_t count = layers.size();
  std::vector<FieldPtr> fields;
  for (const LabelField& layer : layers) fields.push_back(layer.field);
  std::vector<std::vector<FieldPtr>> others(count);
  std::vector<std::vector<FieldPtr>> faces(count);
  for (std::size_t i = 0; i < count; ++i) {
    pollStop();
    for (std::size_t j = i + 1; j < count; ++j) {
      if (haveCommon(layers[i].labels, layers[j].labels)) continue;
      // Labels whose boxes are apart cannot meet.
      const double reach = fields[i]->featureSize() + fields[j]->featureSize();
      const Box3 box =
          fields[i]->bounds().grownBy(reach).intersectedWith(fields[j]->bounds().grownBy(reach));
      if (box.isEmpty()) continue;
      // One leaf for both labels: where both are negative, its sign tells which label owns the
      // point. Elsewhere it has no meaning, so that the surface of either label is closed on both
      // sides of the line where the two meet.
      const auto wall = std::make_shared<LabelWall>(fields[i], fields[j], box);
      out.walls.push_back({wall, fields[i], fields[j]});
      others[i].push_back(fields[j]);
      others[j].push_back(fields[i]);
      faces[i].push_back(complement(intersect({fields[j], complement(wall)})));
      faces[j].push_back(complement(intersect({fields[i], wall})));
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (others[i].empty()) {
      out.fields.push_back(fields[i]);
      continue;
    }
    faces[i].insert(faces[i].begin(), fields[i]);
    out.fields.push_back(
        std::make_shared<LabelShare>(fields[i], std::move(others[i]), std::move(faces[i])));
  }
  return out;
}

}  // namespace palpate
