#include "palpate/interior/partition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

constexpr std::size_t kMaxLeaves = Signs::kMaxLeaves;
constexpr std::size_t kMaxLayers = std::numeric_limits<RegionId>::max() - 1;

bool isIdentity(const Pose& pose) {
  return pose.rotation == Mat3(1.0) && pose.translation == Vec3(0.0);
}

/// True if f(word, mask) is true for one of the words that hold the `count` bits from `first` on;
/// `mask` selects those bits within the word.
template <typename F>
bool anyWord(std::span<const std::uint64_t> words, std::size_t first, std::size_t count,
             const F& f) noexcept {
  for (std::size_t i = first; i < first + count;) {
    const std::size_t bit = i & 63U;
    const std::size_t taken = std::min(64 - bit, first + count - i);
    const std::uint64_t ones = taken == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << taken) - 1;
    if (f(words[i >> 6U], ones << bit)) return true;
    i += taken;
  }
  return false;
}

/// A leaf's identity: the same field object in the same pose is the same leaf.
struct Placed {
  const Field* field;
  Pose pose;

  [[nodiscard]] bool operator<(const Placed& other) const {
    if (field != other.field) return field < other.field;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        const double a = pose.rotation[c][r];
        const double b = other.pose.rotation[c][r];
        if (a != b) return a < b;
      }
      if (pose.translation[c] != other.pose.translation[c]) {
        return pose.translation[c] < other.pose.translation[c];
      }
    }
    return false;
  }
};

}  // namespace

struct Partition::Builder {
  explicit Builder(Partition& target) : partition(target) {}

  Program build(const FieldPtr& root) {
    Program program;
    if (!root) {
      program.steps.push_back({Step::Op::kAnyOf, 0, 0});  // the union of nothing
      return program;
    }
    append(program, root, Pose{}, 1, kInfinity);
    std::sort(program.leaves.begin(), program.leaves.end());
    program.leaves.erase(std::unique(program.leaves.begin(), program.leaves.end()),
                         program.leaves.end());
    return program;
  }

  /// `size` [m]: the smallest of the enclosing solids that the field is a face of.
  void append(Program& program, const FieldPtr& field, const Pose& pose, std::size_t depth,
              double size) {
    if (depth >= kMaxDepth) {
      throw inputError("scene.csg_depth", "a field's CSG tree is nested deeper than 62 levels",
                       "flatten nested unions and intersections into one list");
    }
    const std::size_t first = program.leaves.size();
    const FieldStructure structure = field->structure();
    switch (structure.kind) {
      case FieldStructure::Kind::kLeaf:
        program.leaves.push_back(leaf(field, pose, size));
        program.steps.push_back({Step::Op::kLeaf, program.leaves.back(), 0});
        break;
      case FieldStructure::Kind::kTransform:
        append(program, structure.operands.front(), pose.after(structure.pose), depth, size);
        break;
      case FieldStructure::Kind::kComplement:
        append(program, structure.operands.front(), pose, depth, size);
        program.steps.push_back({Step::Op::kNot, 0, 0});
        break;
      case FieldStructure::Kind::kUnion:
      case FieldStructure::Kind::kIntersection:
      case FieldStructure::Kind::kFaces: {
        // Each operand is folded in as soon as it is added, so that the stack is as deep as the
        // tree, not as wide.
        const auto op =
            structure.kind == FieldStructure::Kind::kUnion ? Step::Op::kOr : Step::Op::kAnd;
        const bool is_solid = structure.kind == FieldStructure::Kind::kFaces;
        const double inner = is_solid ? std::min(size, field->featureSize()) : size;
        bool is_first = true;
        for (const FieldPtr& operand : structure.operands) {
          append(program, operand, pose, depth + (is_first ? 0 : 1), inner);
          if (!is_first) fold(program, op);
          is_first = false;
        }
        break;
      }
    }
    remember(field.get(), program.leaves.begin() + static_cast<std::ptrdiff_t>(first),
             program.leaves.end());
  }

  /// Combines the two topmost operands; a run of leaves followed by one more leaf stays one step.
  static void fold(Program& program, Step::Op op) {
    const Step::Op run = op == Step::Op::kOr ? Step::Op::kAnyOf : Step::Op::kAllOf;
    std::vector<Step>& steps = program.steps;
    if (steps.size() >= 2 && steps.back().op == Step::Op::kLeaf) {
      Step& before = steps[steps.size() - 2];
      const auto next = static_cast<LeafId>(before.leaf + std::max<std::size_t>(before.count, 1));
      if ((before.op == Step::Op::kLeaf || before.op == run) && steps.back().leaf == next) {
        before.count = static_cast<std::uint16_t>(std::max<int>(before.count, 1) + 1);
        before.op = run;
        steps.pop_back();
        return;
      }
    }
    steps.push_back({op, 0, 0});
  }

  LeafId leaf(const FieldPtr& field, const Pose& pose, double size) {
    const auto known = ids.find({field.get(), pose});
    if (known != ids.end()) {
      Leaf& again = partition.leaves_[known->second];
      if (again.is_flat) again.feature = std::min(again.feature, size);
      return known->second;
    }
    if (partition.leaves_.size() >= kMaxLeaves) {
      throw inputError("scene.too_many_leaves", "the scene has more than 65535 smooth leaf fields",
                       "combine some into one grid with `palpate bake`");
    }
    Leaf made;
    made.field = isIdentity(pose) ? field : place(field, pose);
    made.lipschitz = field->lipschitz();
    made.is_flat = field->isFlat();
    made.feature = made.is_flat ? size : field->featureSize();
    const auto id = static_cast<LeafId>(partition.leaves_.size());
    partition.leaves_.push_back(std::move(made));
    ids.emplace(Placed{field.get(), pose}, id);
    return id;
  }

  /// Planes that are not faces of a solid take the scale of the scene, so that a scene behaves the
  /// same when all its lengths are in micrometers.
  void sizePlanes() {
    double largest = 0.0;
    for (const Leaf& leaf : partition.leaves_) {
      if (std::isfinite(leaf.feature)) largest = std::max(largest, leaf.feature);
    }
    for (Leaf& leaf : partition.leaves_) {
      if (std::isfinite(leaf.feature)) continue;
      leaf.feature = largest > 0.0 ? largest : leaf.field->featureSize();
    }
  }

  template <typename Iterator>
  void remember(const Field* part, Iterator begin, Iterator end) {
    std::vector<LeafId>& leaves = parts[part];
    for (auto it = begin; it != end; ++it) {
      if (std::find(leaves.begin(), leaves.end(), *it) == leaves.end()) leaves.push_back(*it);
    }
  }

  Partition& partition;
  std::map<Placed, LeafId> ids;
  std::map<const Field*, std::vector<LeafId>> parts;
};

Partition::Partition(std::span<const FieldPtr> layers, std::span<const FieldPtr> masks,
                     std::span<const LeafBetween> between)
    : layer_count_(layers.size()) {
  if (layers.size() > kMaxLayers) {
    throw inputError("scene.too_many_layers", "the scene has more than 65534 layers");
  }
  Builder builder(*this);
  for (const FieldPtr& layer : layers) programs_.push_back(builder.build(layer));
  for (const FieldPtr& mask : masks) programs_.push_back(builder.build(mask));
  for (const Program& program : programs_) sides_.push_back(sidesOf(program));
  builder.sizePlanes();
  parts_.assign(builder.parts.begin(), builder.parts.end());

  regions_of_leaf_.resize(leaves_.size());
  const Signs nowhere(leaves_.size());
  for (std::size_t i = 0; i < layer_count_; ++i) {
    const auto region = static_cast<RegionId>(i + 1);
    for (const LeafId leaf : programs_[i].leaves) regions_of_leaf_[leaf].push_back(region);
    if (evaluate(programs_[i], nowhere)) hold_empty_.push_back(region);
  }
  between_.resize(leaves_.size());
  for (const LeafBetween& each : between) {
    const std::vector<LeafId> wall = leavesOf(each.wall.get());
    const std::vector<LeafId> first = leavesOf(each.first.get());
    const std::vector<LeafId> second = leavesOf(each.second.get());
    if (wall.size() != 1 || first.size() != 1 || second.size() != 1) continue;
    leaves_[wall[0]].is_between = true;
    leaves_[wall[0]].ends = {first[0], second[0]};
    between_[first[0]].push_back(wall[0]);
    between_[second[0]].push_back(wall[0]);
  }
  std::vector<Box3> boxes;
  for (const Leaf& leaf : leaves_) boxes.push_back(leaf.field->bounds());
  tree_ = BoundsTree(boxes);
}

/// De Morgan's laws push each complement down to the leaves.
Partition::Sides Partition::sidesOf(const Program& program) {
  std::vector<Sides> stack;
  const auto run = [&](const Step& step, bool is_any, std::uint16_t count) {
    Sides both;
    both[1] = {{is_any ? SideStep::Op::kAnyOf : SideStep::Op::kAllOf, true, step.leaf, count}};
    both[0] = {{is_any ? SideStep::Op::kAllOf : SideStep::Op::kAnyOf, false, step.leaf, count}};
    stack.push_back(std::move(both));
  };
  for (const Step& step : program.steps) {
    switch (step.op) {
      case Step::Op::kLeaf:
        run(step, true, 1);
        break;
      case Step::Op::kAnyOf:
        run(step, true, step.count);
        break;
      case Step::Op::kAllOf:
        run(step, false, step.count);
        break;
      case Step::Op::kNot:
        std::swap(stack.back()[0], stack.back()[1]);
        break;
      case Step::Op::kAnd:
      case Step::Op::kOr: {
        const Sides second = std::move(stack.back());
        stack.pop_back();
        Sides& first = stack.back();
        for (const std::size_t holds : {0, 1}) {
          const bool is_and = (step.op == Step::Op::kAnd) == (holds == 1);
          first[holds].insert(first[holds].end(), second[holds].begin(), second[holds].end());
          first[holds].push_back({is_and ? SideStep::Op::kAnd : SideStep::Op::kOr, true, 0, 0});
        }
      }
    }
  }
  return std::move(stack.front());
}

bool Signs::isOf(std::size_t leaves) const noexcept {
  if (leaves_ != leaves || leaves > kMaxLeaves || used_ != (leaves + 63) / 64) return false;
  // The unused bits after the last leaf.
  const std::size_t rest = leaves % 64;
  return rest == 0 || words_[used_ - 1] >> rest == 0;
}

std::size_t Signs::countInside(LeafId first, std::size_t count) const noexcept {
  std::size_t inside = 0;
  (void)anyWord(words_, first, count, [&](std::uint64_t word, std::uint64_t mask) {
    inside += static_cast<std::size_t>(std::popcount(word & mask));
    return false;
  });
  return inside;
}

bool Signs::anyInside(LeafId first, std::size_t count) const noexcept {
  return anyWord(words_, first, count,
                 [](std::uint64_t word, std::uint64_t mask) { return (word & mask) != 0; });
}

bool Signs::allInside(LeafId first, std::size_t count) const noexcept {
  return !anyWord(words_, first, count,
                  [](std::uint64_t word, std::uint64_t mask) { return (word & mask) != mask; });
}

std::vector<LeafId> Partition::leavesOf(const Field* part) const {
  for (const auto& [field, leaves] : parts_) {
    if (field == part) return leaves;
  }
  return {};
}

std::span<const LeafId> Partition::leavesOfRegion(RegionId region) const noexcept {
  if (region == kOutside) return {};
  return programs_[region - 1U].leaves;
}

bool Partition::evaluate(const Program& program, const Signs& signs) noexcept {
  // One bit for each stack entry: kMaxDepth of them fit a word.
  std::uint64_t stack = 0;
  for (const Step& step : program.steps) {
    switch (step.op) {
      case Step::Op::kLeaf:
        stack = (stack << 1U) | (signs.inside(step.leaf) ? 1U : 0U);
        break;
      case Step::Op::kAnyOf:
        stack = (stack << 1U) | (signs.anyInside(step.leaf, step.count) ? 1U : 0U);
        break;
      case Step::Op::kAllOf:
        stack = (stack << 1U) | (signs.allInside(step.leaf, step.count) ? 1U : 0U);
        break;
      case Step::Op::kNot:
        stack ^= 1U;
        break;
      case Step::Op::kAnd:
        stack = (stack >> 1U) & (stack | ~std::uint64_t{1});
        break;
      case Step::Op::kOr:
        stack = (stack >> 1U) | (stack & 1U);
        break;
    }
  }
  return (stack & 1U) != 0;
}

bool Partition::layerHolds(RegionId region, const Signs& signs) const noexcept {
  return region == kOutside || evaluate(programs_[region - 1U], signs);
}

bool Partition::maskHolds(std::size_t index, const Signs& signs) const noexcept {
  return evaluate(programs_[layer_count_ + index], signs);
}

RegionId Partition::regionOf(const Signs& signs) const noexcept {
  if (layer_count_ <= 8) {
    for (std::size_t i = layer_count_; i > 0; --i) {
      if (evaluate(programs_[i - 1], signs)) return static_cast<RegionId>(i);
    }
    return kOutside;
  }
  // A layer can hold the cell only if it uses an inside leaf, or holds even without one.
  RegionId best = kOutside;
  const auto consider = [&](RegionId region) {
    if (region > best && evaluate(programs_[region - 1U], signs)) best = region;
  };
  for (const RegionId region : hold_empty_) consider(region);
  signs.forInside([&](LeafId leaf) {
    for (const RegionId region : regions_of_leaf_[leaf]) consider(region);
  });
  return best;
}

void Partition::signsAt(const Vec3& p, Signs& out) const noexcept {
  out.clear();
  tree_.visit(p, 0.0, [&](std::uint32_t item) {
    if (leaves_[item].field->value(p) < 0.0) out.set(static_cast<LeafId>(item), true);
  });
}

}  // namespace palpate
