#include "import/crossings.h"

#include <algorithm>
#include <set>
#include <utility>

namespace palpate::tools {
namespace {

/// The regions of one tissue; the outside, and the unlabeled rest of a body, are one group each.
struct Group {
  const Tissue* tissue = nullptr;  ///< null: outside
  TissueClass kind = TissueClass::kOutside;
  bool is_gap = false;
  std::vector<std::size_t> regions;
};

/// The wall and the ports between two groups.
struct Meeting {
  const Tissue* wall = nullptr;  ///< null: absent
  bool opens = false;
  TissueForce in;
  TissueForce out;
  TissueForce reopens;
};

TissueForce given(const Tissue* tissue, const std::optional<SourcedNumber> Tissue::*force,
                  const char* what) {
  const std::optional<SourcedNumber>& number = tissue->*force;
  return number ? TissueForce{&*number, tissue, what} : TissueForce{};
}

TissueForce toEnter(const Tissue* tissue) { return given(tissue, &Tissue::opens_at, "opens_at"); }

TissueForce toLeave(const Tissue* tissue) {
  const TissueForce back = given(tissue, &Tissue::back, "back");
  return back.force != nullptr ? back : toEnter(tissue);
}

TissueForce toReopen(const Tissue* tissue) {
  const TissueForce reopens = given(tissue, &Tissue::reopens, "reopens");
  return reopens.force != nullptr ? reopens : given(tissue, &Tissue::back, "back");
}

bool isFlowing(const Group& group) {
  return group.kind == TissueClass::kFluid || group.kind == TissueClass::kGas;
}

class CrossingMaker {
 public:
  CrossingMaker(const ImportedScan& scan, const TissueTable& tissues)
      : scan_(scan), tissues_(tissues) {
    groups_.push_back({nullptr, TissueClass::kOutside, false, {scan.survey.outside()}});
    if (scan.has_body) {
      skin_ = &requireTissue(tissues, "skin");
      groups_.push_back(
          {&requireTissue(tissues, "fat"), TissueClass::kSolid, true, {scan.survey.gap()}});
    }
    for (std::size_t r = 0; r < scan.plan.regions.size(); ++r) {
      const Tissue* tissue = scan.plan.regions[r].tissue;
      if (groups_.back().tissue != tissue || groups_.back().is_gap) {
        groups_.push_back({tissue, tissue->kind, false, {}});
      }
      groups_.back().regions.push_back(r);
    }
  }

  Crossings make() {
    for (std::size_t inner = 1; inner < groups_.size(); ++inner) {
      for (std::size_t outer = 0; outer < inner; ++outer) meet(groups_[outer], groups_[inner]);
      meetItself(groups_[inner]);
    }
    nameThem();
    return std::move(made_);
  }

 private:
  [[nodiscard]] const Tissue* liningOf(const Group& group) const {
    const bool has = group.tissue != nullptr && !group.tissue->lining.empty();
    return has ? tissues_.find(group.tissue->lining) : nullptr;
  }

  [[nodiscard]] double stiffness(const Group& group) const {
    return tissues_.wallStiffness(*group.tissue).value;
  }

  /// `outer` comes before `inner` in the order of layers.
  [[nodiscard]] Meeting meeting(const Group& outer, const Group& inner) const {
    if (inner.is_gap) {
      // The skin is a wall here, without a layer of its own: leaving takes as much force as
      // entering.
      return {skin_, skin_->opens_at.has_value(), toEnter(skin_), toEnter(skin_), toReopen(skin_)};
    }
    const Border& border = BorderTable::own().between(outer.kind, inner.kind);
    Meeting result;
    const Tissue* lining = liningOf(inner) != nullptr ? liningOf(inner) : liningOf(outer);
    if (border.lining && lining != nullptr) {
      result = {lining, true, toEnter(lining), toLeave(lining), toReopen(lining)};
    } else if (border.wall != Border::Wall::kNone) {
      // The unlabeled rest of a body has no surface of its own except its skin.
      const bool is_first = border.wall == Border::Wall::kFirst ||
                            (border.wall == Border::Wall::kStiffer && !outer.is_gap &&
                             stiffness(outer) > stiffness(inner));
      result.wall = is_first ? outer.tissue : inner.tissue;
      if (border.ruptures) {
        rupture(is_first ? outer : inner, result);
        if (is_first) std::swap(result.in, result.out);
      }
    }
    // The body's own skin is the way in; a label that sticks out of the body counts as beneath the
    // skin too.
    const bool is_beneath = scan_.has_body && outer.kind == TissueClass::kOutside &&
                            inner.tissue->name != "skin" && inner.kind != TissueClass::kGas;
    if (is_beneath) {
      result.opens = false;
      if (isFlowing(inner)) result.wall = skin_;
    }
    return result;
  }

  /// Sets the forces that open a wall into its owner and out of it. They are the owner's, as the
  /// wall's stiffness is.
  static void rupture(const Group& owner, Meeting& result) {
    if (owner.tissue == nullptr) return;  // the outside has no wall
    result.in = toEnter(owner.tissue);
    result.out = toLeave(owner.tissue);
    result.reopens = toReopen(owner.tissue);
    result.opens = result.in.force != nullptr || owner.is_gap;
    // The unlabeled rest of a body has no tough surface: getting in is as easy as getting out.
    if (owner.is_gap) result.in = result.out;
  }

  /// The wall of a later layer where no border is stated.
  [[nodiscard]] const Tissue* ownWall(const Group& group) const {
    return group.is_gap ? skin_ : isFlowing(group) ? nullptr : group.tissue;
  }

  /// The regions of `inner` that touch any of `outer`. The image's border is closed.
  [[nodiscard]] std::vector<std::size_t> touching(const Group& outer, const Group& inner) const {
    std::vector<std::size_t> found;
    for (const std::size_t region : inner.regions) {
      const vdb::LabelSurvey::Region& of = scan_.survey.regions[region];
      for (const vdb::LabelSurvey::Contact& contact : of.contacts) {
        const bool is_outside = contact.other == scan_.survey.outside();
        const double area = contact.area - (is_outside ? of.border : 0.0);
        if (area <= 1e-9 * contact.area || std::find(outer.regions.begin(), outer.regions.end(),
                                                     contact.other) == outer.regions.end()) {
          continue;
        }
        found.push_back(region);
        break;
      }
    }
    return found;
  }

  void addWall(const std::vector<std::size_t>& outer, const std::vector<std::size_t>& inner,
               const Tissue* wall) {
    for (WallBetween& entry : made_.walls) {
      if (entry.inner != inner || entry.wall != wall) continue;
      entry.outer.insert(entry.outer.end(), outer.begin(), outer.end());
      return;
    }
    made_.walls.push_back({outer, inner, wall});
  }

  void addPort(const std::vector<std::size_t>& outer, const std::vector<std::size_t>& inner,
               const Meeting& met) {
    for (Passage& port : made_.ports) {
      if (port.inner != inner || !(port.in == met.in) || !(port.out == met.out) ||
          !(port.reopens == met.reopens)) {
        continue;
      }
      port.outer.insert(port.outer.end(), outer.begin(), outer.end());
      return;
    }
    made_.ports.push_back({"", outer, inner, met.in, met.out, met.reopens});
  }

  void meet(const Group& outer, const Group& inner) {
    const Meeting met = meeting(outer, inner);
    if (met.wall != ownWall(inner)) addWall(outer.regions, inner.regions, met.wall);
    if (!met.opens) return;
    const std::vector<std::size_t> touch = touching(outer, inner);
    if (touch.empty()) return;
    // A port between two tissues is open on the whole wall: smoothed walls may meet where voxels
    // did not.
    addPort(outer.regions, outer.kind == TissueClass::kOutside ? touch : inner.regions, met);
  }

  /// Adds the wall or the ports between regions of one tissue.
  void meetItself(const Group& group) {
    if (group.regions.size() < 2 || group.kind == TissueClass::kRigid || isFlowing(group)) return;
    if (group.tissue->parcels_joined) {
      addWall(group.regions, group.regions, nullptr);
      return;
    }
    if (!group.tissue->opens_at || touching(group, group).empty()) return;
    Meeting met;
    rupture(group, met);
    if (met.out.force->value == met.in.force->value) {
      addPort(group.regions, group.regions, met);
      return;
    }
    // If the two forces differ, entering means moving into the later region.
    for (std::size_t n = 1; n < group.regions.size(); ++n) {
      Group one = group;
      Group before = group;
      one.regions = {group.regions[n]};
      before.regions.resize(n);
      if (!touching(before, one).empty()) addPort(before.regions, one.regions, met);
    }
  }

  [[nodiscard]] std::string nameOf(const std::vector<std::size_t>& regions) const {
    const std::size_t first = regions.front();
    if (regions.size() == 1 || first >= scan_.survey.gap()) return scan_.nameOf(first);
    const Tissue* tissue = scan_.plan.regions[first].tissue;
    const bool is_one = std::all_of(regions.begin(), regions.end(), [&](std::size_t r) {
      return r < scan_.survey.gap() && scan_.plan.regions[r].tissue == tissue;
    });
    return is_one ? tissue->name : "several tissues";
  }

  void nameThem() {
    std::set<std::string> taken;
    for (Passage& port : made_.ports) {
      std::string name = "into " + nameOf(port.inner);
      if (taken.contains(name)) name += " from " + nameOf(port.outer);
      const std::string base = name;
      for (int n = 2; taken.contains(name); ++n) name = base + " " + std::to_string(n);
      taken.insert(name);
      port.name = name;
    }
  }

  const ImportedScan& scan_;
  const TissueTable& tissues_;
  const Tissue* skin_ = nullptr;
  std::vector<Group> groups_;  ///< in the order of the layers
  Crossings made_;
};

}  // namespace

Crossings crossings(const ImportedScan& scan, const TissueTable& tissues) {
  return CrossingMaker(scan, tissues).make();
}

}  // namespace palpate::tools
