#include "bake/field_parts.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

using Kind = FieldStructure::Kind;

/// A field of one leaf, even if placed or turned inside out, is fastest when asked directly.
bool isSingle(const Field& field) {
  const FieldStructure structure = field.structure();
  switch (structure.kind) {
    case Kind::kUnion:
    case Kind::kIntersection:
      return false;
    case Kind::kComplement:
    case Kind::kTransform:
      return isSingle(*structure.operands.front());
    case Kind::kFaces:
    case Kind::kLeaf:
      break;
  }
  return true;
}

ValueRange negative(const ValueRange& range) { return {-range.hi, -range.lo}; }

/// What value() and sample() ask a leaf for, and how CSG combines the answers.
struct AskValue {
  using Answer = double;
  double operator()(const Field& leaf, const Vec3& p) const noexcept { return leaf.value(p); }
  static double valueOf(double value) noexcept { return value; }
  static double turnedAbout(double value) noexcept { return -value; }
  static double moved(double value, const Pose&) noexcept { return value; }
};
struct AskSample {
  using Answer = FieldSample;
  FieldSample operator()(const Field& leaf, const Vec3& p) const noexcept { return leaf.sample(p); }
  static double valueOf(const FieldSample& sample) noexcept { return sample.value; }
  static FieldSample turnedAbout(const FieldSample& sample) noexcept {
    return {-sample.value, -sample.gradient, sample.in_band};
  }
  static FieldSample moved(const FieldSample& sample, const Pose& pose) noexcept {
    return {sample.value, pose.rotate(sample.gradient), sample.in_band};
  }
};

}  // namespace

FieldParts::FieldParts(const Field& field) { take(field); }

void FieldParts::take(const Field& field) {
  const std::size_t at = items_.size();
  const FieldStructure structure = field.structure();
  const Kind kind = isSingle(field) ? Kind::kLeaf : structure.kind;
  const Box3 domain = field.lipschitzDomain();
  const Box3 everything = Box3::everything();
  items_.push_back({&field, kind, structure.pose, field.lipschitz(),
                    domain.lo == everything.lo && domain.hi == everything.hi, domain});
  whole_.nodes.push_back({static_cast<std::uint32_t>(at), 1});
  if (kind == Kind::kLeaf) return;
  for (const FieldPtr& operand : structure.operands) take(*operand);
  whole_.nodes[at].size = static_cast<std::uint32_t>(whole_.nodes.size() - at);
}

ValueRange FieldParts::narrow(const FieldPart& from, const Vec3& center, double radius,
                              double limit, FieldPart& to) const {
  to.nodes.clear();
  return narrowNode(from, 0, center, radius, limit, to);
}

ValueRange FieldParts::rangeOf(const Field& leaf, const Item& item, const Vec3& center,
                               double radius) const noexcept {
  if (!item.is_bounded_everywhere && !(item.lipschitz_domain.contains(center - Vec3(radius)) &&
                                       item.lipschitz_domain.contains(center + Vec3(radius)))) {
    return {-kInfinity, kInfinity};
  }
  // The margins cover the rounding of values and positions.
  const double size = std::max({std::fabs(center.x), std::fabs(center.y), std::fabs(center.z)});
  const double most = item.lipschitz * (radius * (1.0 + 1e-9) + 1e-14 * size);
  const double value = leaf.value(center);
  if (std::isnan(value)) return {-kInfinity, kInfinity};
  return {value - most, value + most};
}

ValueRange FieldParts::narrowNode(const FieldPart& from, std::size_t at, const Vec3& center,
                                  double radius, double limit, FieldPart& to) const {
  const FieldPart::Node node = from.nodes[at];
  const Item& item = items_[node.which];
  const std::size_t begin = to.nodes.size();
  if (item.kind == Kind::kLeaf) {
    to.nodes.push_back(node);
    return rangeOf(*item.field, item, center, radius);
  }
  to.nodes.push_back({node.which, 1});
  const auto finish = [&] {
    to.nodes[begin].size = static_cast<std::uint32_t>(to.nodes.size() - begin);
  };
  if (item.kind == Kind::kComplement) {
    const ValueRange range = narrowNode(from, at + 1, center, radius, limit, to);
    finish();
    return negative(range);
  }
  if (item.kind == Kind::kTransform) {
    const ValueRange range =
        narrowNode(from, at + 1, item.pose.applyInverse(center), radius, limit, to);
    finish();
    return range;
  }
  // A maximum is the negative of the minimum of the negatives.
  const bool is_minimum = item.kind == Kind::kUnion;
  const std::size_t scratch = to.least.size();
  ValueRange all{kInfinity, kInfinity};
  for (std::size_t child = at + 1; child < at + node.size; child += from.nodes[child].size) {
    ValueRange range = narrowNode(from, child, center, radius, limit, to);
    if (!is_minimum) range = negative(range);
    to.least.push_back(range.lo);
    all.lo = std::min(all.lo, range.lo);
    all.hi = std::min(all.hi, range.hi);
  }
  // Operands beyond the limit may be dropped. One is kept in any case: the one with the least
  // values.
  const double most = std::min(all.hi, limit);
  std::size_t kept = 0;
  std::size_t end = begin + 1;
  for (std::size_t operand = begin + 1, n = scratch; n < to.least.size(); ++n) {
    const std::size_t size = to.nodes[operand].size;
    const double least = to.least[n];
    if (!(least > most) || (kept == 0 && least == all.lo)) {
      std::copy_n(to.nodes.begin() + static_cast<std::ptrdiff_t>(operand), size,
                  to.nodes.begin() + static_cast<std::ptrdiff_t>(end));
      end += size;
      ++kept;
    }
    operand += size;
  }
  to.least.resize(scratch);
  to.nodes.resize(end);
  if (kept == 1) {
    to.nodes.erase(to.nodes.begin() + static_cast<std::ptrdiff_t>(begin));
  } else {
    finish();
  }
  return is_minimum ? all : negative(all);
}

template <class Ask>
typename Ask::Answer FieldParts::askNode(const FieldPart& part, std::size_t at, const Vec3& p,
                                         const Ask& ask) const noexcept {
  const FieldPart::Node node = part.nodes[at];
  const Item& item = items_[node.which];
  if (item.kind == Kind::kLeaf) return ask(*item.field, p);
  if (item.kind == Kind::kTransform) {
    return Ask::moved(askNode(part, at + 1, item.pose.applyInverse(p), ask), item.pose);
  }
  typename Ask::Answer best = askNode(part, at + 1, p, ask);
  if (item.kind == Kind::kComplement) return Ask::turnedAbout(best);
  const double sign = item.kind == Kind::kUnion ? 1.0 : -1.0;
  for (std::size_t child = at + 1 + part.nodes[at + 1].size; child < at + node.size;
       child += part.nodes[child].size) {
    const typename Ask::Answer next = askNode(part, child, p, ask);
    if (sign * Ask::valueOf(next) < sign * Ask::valueOf(best)) best = next;
  }
  return best;
}

double FieldParts::value(const FieldPart& part, const Vec3& p) const noexcept {
  return askNode(part, 0, p, AskValue{});
}

FieldSample FieldParts::sample(const FieldPart& part, const Vec3& p) const noexcept {
  return askNode(part, 0, p, AskSample{});
}

void FieldParts::values(const FieldPart& part, const PointBatch& points,
                        ValueBatch& out) const noexcept {
  valuesOfNode(part, 0, points, out);
}

void FieldParts::valuesOfNode(const FieldPart& part, std::size_t at, const PointBatch& points,
                              ValueBatch& out) const noexcept {
  const FieldPart::Node node = part.nodes[at];
  const Item& item = items_[node.which];
  if (item.kind == Kind::kLeaf) return item.field->values(points, out);
  if (item.kind == Kind::kTransform) {
    PointBatch moved;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const Vec3 p = item.pose.applyInverse(points[n]);
      moved.x[n] = p.x;
      moved.y[n] = p.y;
      moved.z[n] = p.z;
    }
    return valuesOfNode(part, at + 1, moved, out);
  }
  valuesOfNode(part, at + 1, points, out);
  if (item.kind == Kind::kComplement) {
    for (double& value : out) value = -value;
    return;
  }
  const bool is_minimum = item.kind == Kind::kUnion;
  ValueBatch next;
  for (std::size_t child = at + 1 + part.nodes[at + 1].size; child < at + node.size;
       child += part.nodes[child].size) {
    valuesOfNode(part, child, points, next);
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const double lesser = next[n] < out[n] ? next[n] : out[n];
      const double greater = next[n] > out[n] ? next[n] : out[n];
      out[n] = is_minimum ? lesser : greater;
    }
  }
}

}  // namespace palpate::vdb
