#include "need.h"

#include <algorithm>
#include <optional>

#include "globs.h"
#include "palpate/core/stop.h"
#include "palpate/scene/scene_file.h"
#include "reach.h"

namespace palpate {
namespace {

/// Boxes are grown by this share of their size, so that boxes that touch overlap.
constexpr double kMargin = 1e-3;
/// At the border of its workspace a hand still feels what lies within this share of the workspace
/// beyond it.
constexpr double kBeyond = 0.05;
/// The most evaluations of a field to prove that it contains a box.
constexpr int kMostLooks = 200'000;
constexpr int kMostHalvings = 12;

/// [m] How deep below a closed wall the scene can be felt through it.
double deepestFelt(const SceneDescription& scene) {
  double deepest = 0.0;
  for (const Material& material : scene.materials) {
    if (material.composite.radius > 0.0) deepest = std::max(deepest, material.composite.depth);
  }
  return deepest;
}

bool overlap(const Box3& a, const Box3& b) { return !a.intersectedWith(b).isEmpty(); }

/// Whether `box` lies inside `field`, proved cell by cell with the Lipschitz bound.
bool isInside(const Field& field, const Box3& box, int halvings, int& looks) {
  const Box3 domain = field.lipschitzDomain();
  if (--looks < 0 || !domain.contains(box.lo) || !domain.contains(box.hi)) return false;
  const double value = field.value(box.center());
  if (!(value < 0.0)) return false;
  if (value + field.lipschitz() * 0.5 * glm::length(box.size()) < 0.0) return true;
  if (halvings == 0) return false;
  // Halve the longest side.
  const Vec3 size = box.size();
  int axis = size.y > size.x ? 1 : 0;
  if (size.z > size[axis]) axis = 2;
  Box3 low = box;
  Box3 high = box;
  low.hi[axis] = high.lo[axis] = box.center()[axis];
  return isInside(field, low, halvings - 1, looks) && isInside(field, high, halvings - 1, looks);
}

class Needs {
 public:
  Needs(const SceneDescription& description, const Progress& progress)
      : scene_(description),
        progress_(progress),
        needed_(neededBox(description)),
        felt_(deepestFelt(description)),
        reasons_(description.layers.size()) {
    names_.emplace_back("outside");
    for (const LayerDescription& layer : scene_.layers) names_.push_back(layer.name);
    boxes_.resize(names_.size());
  }

  std::vector<std::string> reasons() {
    leaveOutBeyondWorkspace();
    follow();
    // Next the costly layers that nothing leads into; they are measured only if some layer may
    // enclose them.
    const auto shut = std::count(entered_.begin() + 1, entered_.end(), false);
    if (entered_[kOutside] && shut < 2) return std::move(reasons_);
    std::vector<std::size_t> order;
    for (std::size_t i = 1; i < names_.size(); ++i) {
      if (!entered_[i] && reasons_[i - 1].empty() && canBeLeftOut(i)) order.push_back(i);
    }
    // The largest first: layers that enclose others are handled before them.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return glm::length(boxOf(a)->size()) > glm::length(boxOf(b)->size());
    });
    for (const std::size_t i : order) reasons_[i - 1] = whyUntouchable(i);
    return std::move(reasons_);
  }

 private:
  /// [m] A box around a layer, a little larger than it; no value where only making the layer would
  /// tell. Measured once, as that may require reading a file.
  const std::optional<Box3>& boxOf(std::size_t region) {
    Measured& known = boxes_[region];
    if (!known.is_measured) {
      const FieldSourcePtr& source = scene_.layers[region - 1].inside;
      if (source) known.box = source->bounds(progress_);
      if (known.box && known.box->isBounded()) {
        known.box = known.box->grownBy(kMargin * glm::length(known.box->size()));
      }
      known.is_measured = true;
    }
    return known.box;
  }

  bool canBeLeftOut(std::size_t region) {
    const FieldSourcePtr& source = scene_.layers[region - 1].inside;
    return source && !source->isMade() && boxOf(region) && boxOf(region)->isBounded();
  }

  void leaveOutBeyondWorkspace() {
    if (!needed_.isBounded()) return;
    for (std::size_t i = 1; i < names_.size(); ++i) {
      if (canBeLeftOut(i) && names_[i] != scene_.start_region && !overlap(*boxOf(i), needed_)) {
        reasons_[i - 1] = "it lies outside the device's workspace";
      }
    }
  }

  [[nodiscard]] bool isAbsent(std::size_t a, std::size_t b) const {
    bool absent = scene_.layers[std::max(a, b) - 1].wall.absent;
    for (const WallOverride& wall : scene_.walls) {
      const bool forth = matchesAnyOf(wall.a, names_[a]) && matchesAnyOf(wall.b, names_[b]);
      const bool back = matchesAnyOf(wall.a, names_[b]) && matchesAnyOf(wall.b, names_[a]);
      if (!forth && !back) continue;
      if (wall.felt_from.empty() || matchesGlob(wall.felt_from, names_[a])) {
        absent = wall.wall.absent;
      }
    }
    return absent;
  }

  /// Finds the regions that ports and walls let the probe into, judged by their names alone, as if
  /// all regions touched.
  void follow() {
    const auto matches = [&](const std::string& globs) {
      std::vector<bool> out;
      for (const std::string& name : names_) out.push_back(matchesAnyOf(globs, name));
      return out;
    };
    ReachTable table;
    table.regions = names_.size();
    table.keeps_memory = scene_.keep_memory;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == scene_.start_region) table.start = static_cast<RegionId>(i);
      for (std::size_t j = 0; j < names_.size(); ++j) {
        if (i != j && isAbsent(i, j)) addWay(table, i, j, -1, false);
      }
    }
    for (std::size_t id = 0; id < scene_.ports.size(); ++id) {
      const PortDescription& port = scene_.ports[id];
      table.after.push_back(before(port));
      if (!port.sheet.empty()) {
        for (std::size_t i = 0; i < names_.size(); ++i) {
          for (const bool inward : {true, false}) addWay(table, i, i, static_cast<int>(id), inward);
        }
        continue;
      }
      const std::vector<bool> from = matches(port.from);
      const std::vector<bool> to = matches(port.to);
      for (std::size_t a = 0; a < names_.size(); ++a) {
        for (std::size_t b = 0; b < names_.size(); ++b) {
          const bool forth = from[a] && to[b];
          const bool back = to[a] && from[b];
          if (a == b || !((forth && port.direction != PortDirection::kOut) ||
                          (back && port.direction != PortDirection::kIn))) {
            continue;
          }
          addWay(table, a, b, static_cast<int>(id),
                 forth && (a < b || !back) && port.direction != PortDirection::kOut);
        }
      }
    }
    const Reached reached = reach(table);
    entered_.clear();
    // Undecided regions count as entered: only certain cases are left out.
    for (const Reach answer : reached.regions) entered_.push_back(answer != Reach::kNo);
  }

  static void addWay(ReachTable& table, std::size_t from, std::size_t to, int port, bool inward) {
    table.ways.push_back(
        {static_cast<RegionId>(from), static_cast<RegionId>(to), port, inward, false});
  }

  /// Unknown names are skipped here; they are refused later.
  [[nodiscard]] std::vector<PassedBefore> before(const PortDescription& port) const {
    std::vector<PassedBefore> out;
    for (const AfterDescription& given : port.after) {
      for (std::size_t i = 0; i < scene_.ports.size(); ++i) {
        if (scene_.ports[i].name == given.port) {
          out.emplace_back(static_cast<PortId>(i), std::max(given.times, 1));
        }
      }
    }
    return out;
  }

  /// The reason why the region cannot be touched; empty if it may be.
  std::string whyUntouchable(std::size_t region) {
    pollStop();
    // The layer may be felt through a wall, from as far away as this.
    const Box3 box = boxOf(region)->grownBy(felt_).intersectedWith(needed_);
    for (std::size_t other = 1; other < names_.size(); ++other) {
      if (other == region || !entered_[other]) continue;
      if (!boxOf(other) || overlap(box, *boxOf(other))) return {};
    }
    if (!entered_[kOutside]) return "nothing that the probe can enter comes near it";
    for (std::size_t other = 1; other < names_.size(); ++other) {
      if (other == region || entered_[other] || !reasons_[other - 1].empty()) continue;
      const std::optional<Box3>& around = boxOf(other);
      if (!around || !around->contains(box.lo) || !around->contains(box.hi)) continue;
      const FieldPtr& field = scene_.layers[other - 1].inside->get(needed_, progress_);
      int looks = kMostLooks;
      if (isInside(*field, box, 3 * kMostHalvings, looks)) {
        return "it lies within " + names_[other] + ", which cannot be entered";
      }
    }
    return {};
  }

  const SceneDescription& scene_;
  const Progress& progress_;
  const Box3 needed_;               // [m]
  const double felt_;               // [m]
  std::vector<std::string> names_;  // by region: outside, then the layers
  struct Measured {
    std::optional<Box3> box = {};
    bool is_measured = false;
  };
  std::vector<Measured> boxes_;       // by region
  std::vector<bool> entered_;         // by region
  std::vector<std::string> reasons_;  // by layer
};

}  // namespace

Box3 neededBox(const SceneDescription& description) {
  const Box3 reach = description.device.reach();
  if (!reach.isBounded() || description.renderer == RendererKind::kPaper) {
    return Box3::everything();
  }
  return reach.grownBy(kBeyond * glm::length(reach.size()) + deepestFelt(description));
}

std::vector<std::string> reasonsToLeaveOut(const SceneDescription& description,
                                           const Progress& progress) {
  return Needs(description, progress).reasons();
}

}  // namespace palpate
