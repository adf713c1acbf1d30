#include "support/region_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpate::testing {
namespace {

constexpr std::size_t kMostLiterals = 32;
constexpr std::size_t kMostCells = 64;

/// Drops implied conjunctions: those that contain all conditions of another one, and more.
void absorb(std::vector<std::uint32_t>& cells) {
  std::vector<std::uint32_t> kept;
  for (const std::uint32_t cell : cells) {
    const bool implied = std::any_of(kept.begin(), kept.end(),
                                     [&](std::uint32_t other) { return (cell & other) == other; });
    if (implied) continue;
    kept.erase(std::remove_if(kept.begin(), kept.end(),
                              [&](std::uint32_t other) { return (cell & other) == cell; }),
               kept.end());
    kept.push_back(cell);
  }
  cells = std::move(kept);
}

}  // namespace

RegionTree::RegionTree(const Scene& scene, RegionId region) {
  Node all{Kind::kAll};
  const auto add = [&](const FieldPtr& field, double sign) {
    layers_.push_back({field, sign});
    all.operands.push_back(addField(field, sign, {}, false));
  };
  const auto regions = scene.regions();
  if (region != kOutside) add(regions[region].field, -1.0);
  for (std::size_t later = region + 1U; later < regions.size(); ++later) {
    if (regions[later].field) add(regions[later].field, 1.0);
  }
  root_ = static_cast<int>(nodes_.size());
  nodes_.push_back(std::move(all));
  state_.resize(literals_.size());
  for (const Literal& literal : literals_) {
    feature_ = std::min(feature_, literal.feature);
    largest_feature_ = std::max(largest_feature_, literal.feature);
  }
  for (const Literal& a : literals_) {
    for (const Literal& b : literals_) {
      has_both_sides_ |= a.field == b.field && a.sign != b.sign &&
                         a.pose.rotation == b.pose.rotation &&
                         a.pose.translation == b.pose.translation;
    }
  }
}

bool RegionTree::leaveNoRoom(const std::array<int, 3>& literals, const Vec3& center) const {
  const auto [known, is_new] = leaves_no_room_.try_emplace(literals, true);
  if (!is_new) return known->second;
  const std::size_t count = literals[1] == literals[2] ? 2 : 3;
  const double reach = 1e-4 * feature_;
  constexpr std::array<Vec3, 4> kLooks = {Vec3(0.31, -0.77, 0.52), Vec3(-0.63, 0.19, -0.84),
                                          Vec3(0.45, 0.88, 0.27), Vec3(0.71, -0.12, -0.36)};
  for (const Vec3& look : kLooks) {
    double sum = 0.0;
    double size = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const double value =
          literals_[static_cast<std::size_t>(literals[k])].value(center + reach * look);
      sum += value;
      size += std::fabs(value);
    }
    // Far above rounding (1e-12 of the reach), far below the effect of curvature on surfaces that
    // only touch (1e-4).
    if (std::fabs(sum) > 1e-8 * size) known->second = false;
  }
  return known->second;
}

void RegionTree::dropEmpty(const Vec3& center, Nearby& out) const {
  const auto is_empty = [&](std::uint32_t cell) {
    std::vector<int> own;
    for (std::size_t i = 0; i < out.literals.size(); ++i) {
      if (((cell >> i) & 1U) != 0) own.push_back(out.literals[i]);
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = i + 1; j < own.size(); ++j) {
        for (std::size_t k = j; k < own.size(); ++k) {
          if (leaveNoRoom({own[i], own[j], own[k]}, center)) return true;
        }
      }
    }
    return false;
  };
  out.cells.erase(std::remove_if(out.cells.begin(), out.cells.end(), is_empty), out.cells.end());
}

int RegionTree::addLiteral(Literal literal) {
  for (std::size_t i = 0; i < literals_.size(); ++i) {
    const Literal& known = literals_[i];
    if (known.field == literal.field && known.sign == literal.sign &&
        known.pose.rotation == literal.pose.rotation &&
        known.pose.translation == literal.pose.translation) {
      return static_cast<int>(i);
    }
  }
  literals_.push_back(std::move(literal));
  return static_cast<int>(literals_.size()) - 1;
}

int RegionTree::addField(const FieldPtr& field, double sign, const Pose& pose, bool is_moved) {
  const FieldStructure structure = field->structure();
  using Structure = FieldStructure::Kind;
  Node node;
  switch (structure.kind) {
    case Structure::kComplement:
      return addField(structure.operands[0], -sign, pose, is_moved);
    case Structure::kTransform:
      return addField(structure.operands[0], sign, pose.after(structure.pose), true);
    case Structure::kUnion:
    case Structure::kIntersection:
    case Structure::kFaces:
      // Outside a union means outside all its operands; inside it means inside any of them.
      node.kind = (structure.kind == Structure::kUnion) == (sign > 0.0) ? Kind::kAll : Kind::kAny;
      for (const FieldPtr& operand : structure.operands) {
        node.operands.push_back(addField(operand, sign, pose, is_moved));
      }
      break;
    case Structure::kLeaf:
      node.literal =
          addLiteral({field, sign, pose, is_moved, field->featureSize(), field->lipschitz()});
      break;
  }
  nodes_.push_back(std::move(node));
  return static_cast<int>(nodes_.size()) - 1;
}

double RegionTree::value(const Vec3& p) const noexcept {
  double out = kInfinity;
  for (const Layer& layer : layers_) out = std::min(out, layer.sign * layer.field->value(p));
  return out;
}

Slope RegionTree::slopeAt(const Literal& literal, const Vec3& p, double widest) const noexcept {
  Slope best;
  best.gap = literal.value(p);
  best.doubt = kInfinity;
  // Differences of order 4 over h, and of order 2 over h / 4; both have errors near 1e-9 on a
  // smooth surface. A seam or an apex within reach makes them differ, and calls for a smaller h.
  for (double h = std::min(1e-3 * literal.feature, widest); best.doubt > 1e-8 && h > 5e-10;
       h *= 0.1) {
    Vec3 fine(0.0);
    Vec3 check(0.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 step(0.0);
      step[i] = h;
      const double near = literal.value(p + step) - literal.value(p - step);
      const double far = literal.value(p + 2.0 * step) - literal.value(p - 2.0 * step);
      fine[i] = (8.0 * near - far) / (12.0 * h);
      step[i] = h / 32.0;
      check[i] = (literal.value(p + step) - literal.value(p - step)) / (h / 16.0);
    }
    const double steepness = glm::length(fine);
    const double doubt = glm::length(fine - check) / std::max(steepness, 1e-300);
    if (doubt >= best.doubt || !(steepness > 0.0)) continue;
    best.doubt = doubt;
    best.normal = fine / steepness;
    best.steepness = steepness;
  }
  best.gap /= best.steepness;
  // If the two agree to the rounding of the shorter one, neither has an error that large.
  if (best.doubt < 3e-7) best.doubt = 1e-9;
  return best;
}

bool RegionTree::isOnCrease(const Literal& literal, const Vec3& p,
                            const Slope& slope) const noexcept {
  if (slope.steepness >= 0.999 * literal.lipschitz) return false;
  const double h = 1e-6 * literal.feature;
  const double center = literal.value(p);
  double turn = 0.0;
  for (int i = 0; i < 3; ++i) {
    Vec3 step(0.0);
    step[i] = h;
    turn += std::fabs(literal.value(p + step) + literal.value(p - step) - 2.0 * center);
  }
  // Over that distance the normal of a smooth surface turns by only some millionths.
  return turn > 0.02 * slope.steepness * h;
}

Mat3 RegionTree::hessianAt(const Literal& literal, const Vec3& p, double steepness) const noexcept {
  const double h = 1e-3 * literal.feature;
  const double center = literal.value(p);
  Mat3 out(0.0);
  for (int i = 0; i < 3; ++i) {
    Vec3 a(0.0);
    a[i] = h;
    out[i][i] = (literal.value(p + a) + literal.value(p - a) - 2.0 * center) / (h * h);
    for (int j = 0; j < i; ++j) {
      Vec3 b(0.0);
      b[j] = h;
      out[i][j] = out[j][i] = (literal.value(p + a + b) + literal.value(p - a - b) -
                               literal.value(p + a - b) - literal.value(p - a + b)) /
                              (4.0 * h * h);
    }
  }
  return out / steepness;
}

RegionTree::State RegionTree::reduce(int index, std::vector<std::uint32_t>& cells,
                                     Nearby& out) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.kind == Kind::kLiteral) {
    const int state = state_[static_cast<std::size_t>(node.literal)];
    if (state == 1) return State::kAllowed;
    if (state == -1) return State::kForbidden;
    cells.push_back(std::uint32_t{1} << static_cast<unsigned>(state - 2));
    return State::kOpen;
  }
  const bool is_all = node.kind == Kind::kAll;
  bool is_open = false;
  for (const int operand : node.operands) {
    std::vector<std::uint32_t> more;
    const State state = reduce(operand, more, out);
    if (state == (is_all ? State::kForbidden : State::kAllowed)) {
      cells.clear();
      return state;
    }
    if (state != State::kOpen) continue;
    if (!is_open) {
      cells = std::move(more);
      is_open = true;
      continue;
    }
    if (!is_all) {
      cells.insert(cells.end(), more.begin(), more.end());
    } else {
      std::vector<std::uint32_t> product;
      for (const std::uint32_t a : cells) {
        for (const std::uint32_t b : more) product.push_back(a | b);
      }
      cells = std::move(product);
    }
    absorb(cells);
    if (cells.size() > kMostCells) {
      out.is_too_much = true;
      cells.resize(kMostCells);
    }
  }
  if (is_open) return State::kOpen;
  return is_all ? State::kAllowed : State::kForbidden;
}

void RegionTree::nearby(const Vec3& center, double radius, Nearby& out) const {
  out.literals.clear();
  out.cells.clear();
  out.is_too_much = false;
  for (std::size_t i = 0; i < literals_.size(); ++i) {
    const double value = literals_[i].value(center);
    const double reach = 1.25 * literals_[i].lipschitz * radius;
    if (value > reach) {
      state_[i] = 1;
    } else if (value < -reach) {
      state_[i] = -1;
    } else if (out.literals.size() == kMostLiterals) {
      out.is_too_much = true;
      state_[i] = -1;
    } else {
      state_[i] = 2 + static_cast<int>(out.literals.size());
      out.literals.push_back(static_cast<int>(i));
    }
  }
  const State state = reduce(root_, out.cells, out);
  if (has_both_sides_) dropEmpty(center, out);
  if (state == State::kAllowed) out.cells = {0};
  if (state == State::kForbidden) out.cells.clear();
}

}  // namespace palpate::testing
