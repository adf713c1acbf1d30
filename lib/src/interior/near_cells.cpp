#include "palpate/interior/near_cells.h"

#include <algorithm>

namespace palpate {

NearCells::NearCells(const Partition& partition, const Passages& passages)
    : partition_(partition), passages_(passages), index_(partition.leaves().size(), -1) {
  later_.reserve(partition.regionCount());
}

/// Removes the cells that the new one contains, and drops the new one if another contains it.
void NearCells::List::add(const NearCell& added) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (cell[i].contains(added)) return;
    if (!added.contains(cell[i])) cell[kept++] = cell[i];
  }
  count = kept;
  if (count < kMaxCells) cell[count++] = added;
}

void NearCells::intersect(const List& a, const List& b, List& out) noexcept {
  out.count = 0;
  for (std::size_t i = 0; i < a.count; ++i) {
    for (std::size_t j = 0; j < b.count; ++j) {
      const NearCell both{a.cell[i].inside | b.cell[j].inside,
                          a.cell[i].outside | b.cell[j].outside};
      if ((both.inside & both.outside) == 0) out.add(both);
    }
  }
}

void NearCells::run(const SideStep& step, const Signs& signs, std::span<const NearSide> near,
                    List& out) const noexcept {
  // The cells choose the sides of the near leaves; the far leaves keep their sides and are only
  // counted.
  const bool is_any = step.op == SideStep::Op::kAnyOf;
  std::uint32_t members = 0;
  std::size_t far = step.count;
  std::size_t far_inside = 0;
  if (step.count == 1) {
    const std::int8_t index = index_[step.first];
    if (index >= 0) {
      members = std::uint32_t{1} << static_cast<unsigned>(index);
      far = 0;
    } else {
      far_inside = signs.inside(step.first) ? 1 : 0;
    }
  } else if (step.count > 1) {
    far_inside = signs.countInside(step.first, step.count);
    for (std::size_t i = 0; i < near.size(); ++i) {
      const LeafId leaf = near[i].leaf;
      if (leaf < step.first || leaf >= step.first + step.count) continue;
      members |= std::uint32_t{1} << i;
      --far;
      if (signs.inside(leaf)) --far_inside;
    }
  }
  const std::size_t far_true = step.inside ? far_inside : far - far_inside;
  out.count = 0;
  if (is_any ? far_true > 0 : far_true < far) {
    if (is_any) out.add({});
    return;
  }
  NearCell all;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const std::uint32_t bit = std::uint32_t{1} << i;
    if ((members & bit) == 0) continue;
    const bool may = step.inside ? near[i].may_be_inside : near[i].may_be_outside;
    if (is_any) {
      if (may) out.add(step.inside ? NearCell{bit, 0} : NearCell{0, bit});
      continue;
    }
    if (!may) return;
    (step.inside ? all.inside : all.outside) |= bit;
  }
  if (!is_any) out.add(all);
}

void NearCells::evaluate(std::span<const SideStep> steps, const Signs& signs,
                         std::span<const NearSide> near, List& out) noexcept {
  if (steps.size() == 1) {
    run(steps[0], signs, near, out);
    return;
  }
  std::size_t depth = 0;
  for (const SideStep& step : steps) {
    if (step.op == SideStep::Op::kAnyOf || step.op == SideStep::Op::kAllOf) {
      run(step, signs, near, stack_[depth++]);
      continue;
    }
    const List& second = stack_[--depth];
    List& first = stack_[depth - 1];
    if (step.op == SideStep::Op::kOr) {
      for (std::size_t i = 0; i < second.count; ++i) first.add(second.cell[i]);
    } else {
      intersect(first, second, product_);
      first = product_;
    }
  }
  out = stack_[0];
}

std::span<const NearCell> NearCells::find(RegionId region, const Signs& signs,
                                          std::span<const NearSide> near) noexcept {
  for (std::size_t i = 0; i < near.size(); ++i) {
    index_[near[i].leaf] = static_cast<std::int8_t>(i);
  }
  if (region == kOutside) {
    cells_.count = 0;
    cells_.add({});
  } else {
    evaluate(partition_.layerSides(region, true), signs, near, cells_);
  }
  // A later layer cuts its own part out of the region. A layer without a near leaf does not reach
  // here.
  later_.clear();
  for (const NearSide& side : near) {
    for (const RegionId other : partition_.regionsOf(side.leaf)) {
      if (other > region && std::find(later_.begin(), later_.end(), other) == later_.end()) {
        later_.push_back(other);
      }
    }
  }
  const auto keep = [&](const List& list) {
    intersect(cells_, list, product_);
    cells_ = product_;
  };
  for (const RegionId other : later_) {
    if (cells_.count == 0) break;
    evaluate(partition_.layerSides(other, false), signs, near, other_);
    keep(other_);
  }
  // Near a sheet the point may go where it does not cross the sheet: on its own side of the sheet's
  // solid, or beyond the sheet's edge.
  for (const Sheet& sheet : passages_.sheets()) {
    const bool is_near = std::any_of(sheet.leaves.begin(), sheet.leaves.end(),
                                     [&](LeafId leaf) { return index_[leaf] >= 0; });
    if (!is_near || cells_.count == 0) continue;
    const auto solid = static_cast<std::size_t>(sheet.solid);
    evaluate(partition_.maskSides(solid, partition_.maskHolds(solid, signs)), signs, near, other_);
    if (sheet.mask >= 0) {
      List& beyond = stack_[Partition::kMaxDepth - 1];
      evaluate(partition_.maskSides(static_cast<std::size_t>(sheet.mask), false), signs, near,
               beyond);
      for (std::size_t i = 0; i < beyond.count; ++i) other_.add(beyond.cell[i]);
    }
    keep(other_);
  }
  for (const NearSide& side : near) index_[side.leaf] = -1;
  return {cells_.cell.data(), cells_.count};
}

}  // namespace palpate
