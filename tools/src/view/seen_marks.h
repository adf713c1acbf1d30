#pragma once
/// SeenMarks: the marks that the probe leaves on its way: holes, and the path of its shaft.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/interior/punctures.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"

namespace palpate::tools {

/// A place where a wall gave way, and is open from then on.
struct SeenHole {
  PortId port = 0;
  Vec3 point{0.0, 0.0, 0.0};   ///< [m]
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] of the wall; zero where it has none
  double radius = 0.0;         ///< [m]
};

/// Built from the entries into regions that a renderer reports, so that a page never reads the
/// loop's own memory.
class SeenMarks {
 public:
  explicit SeenMarks(const Scene& scene) : keeps_(scene.keepsMemory()) {
    for (const Region& region : scene.regions()) {
      const auto content = static_cast<std::size_t>(region.content);
      const Material* material = region.content < 0 ? nullptr : &scene.materials()[content];
      holds_.push_back(material != nullptr &&
                       (material->shaft.stiffness > 0.0 || material->cutting.range().most > 0.0));
    }
  }

  /// Takes the marks of `before`, made in `from`, by the names of ports and regions in `to`. Drops
  /// holes of missing ports, and the shaft's path from the first missing region on.
  SeenMarks(const SeenMarks& before, const Scene& from, const Scene& to) : SeenMarks(to) {
    const auto named = [](const auto& all, const std::string& name) {
      const auto at =
          std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name == name; });
      return at == all.end() ? -1 : static_cast<int>(at - all.begin());
    };
    for (SeenHole hole : before.holes_) {
      const int port = named(to.ports(), from.ports()[hole.port].name);
      if (port < 0) continue;
      hole.port = static_cast<PortId>(port);
      holes_.push_back(hole);
    }
    for (RegionEntry step : before.way_) {
      const int outer = named(to.regions(), from.regions()[step.from].name);
      const int inner = named(to.regions(), from.regions()[step.to].name);
      if (outer < 0 || inner < 0) break;
      step.from = static_cast<RegionId>(outer);
      step.to = static_cast<RegionId>(inner);
      way_.push_back(step);
    }
  }

  void add(const RegionEntry& entry) {
    if (entry.port >= 0 && entry.hole_radius > 0.0 && entry.force > 0.0) addHole(entry);
    if (entry.to == kOutside && !keeps_) holes_.clear();
    for (std::size_t i = way_.size(); i > 0; --i) {
      const RegionEntry& step = way_[i - 1];
      // If the needle comes out on the far side instead, it is held all the more.
      if (step.from != entry.to || glm::dot(step.normal, entry.normal) > 0.0) continue;
      way_.resize(i - 1);
      return;
    }
    if (way_.empty() && !holds_[entry.to]) return;
    if (way_.size() < kMostSteps) way_.push_back(entry);
  }

  [[nodiscard]] const std::vector<SeenHole>& holes() const noexcept { return holes_; }
  /// [m] Where the shaft first entered a region that holds it; nothing: it is free.
  [[nodiscard]] std::optional<Vec3> fulcrum() const {
    return way_.empty() ? std::nullopt : std::optional(way_.front().point);
  }

 private:
  static constexpr std::size_t kMostSteps = 64;

  void addHole(const RegionEntry& entry) {
    const auto port = static_cast<PortId>(entry.port);
    const auto is_same = [&](const SeenHole& hole) {
      return hole.port == port && glm::distance(hole.point, entry.point) <= hole.radius;
    };
    if (std::any_of(holes_.begin(), holes_.end(), is_same)) return;
    // Keeps only as many as the loop remembers.
    if (holes_.size() == Punctures::kMaxHoles) holes_.erase(holes_.begin());
    holes_.push_back({port, entry.point, entry.normal, entry.hole_radius});
  }

  bool keeps_;
  std::vector<bool> holds_;  ///< by region: whether its content holds a needle
  std::vector<SeenHole> holes_;
  std::vector<RegionEntry> way_;  ///< path of the shaft, from where it was first held
};

}  // namespace palpate::tools
