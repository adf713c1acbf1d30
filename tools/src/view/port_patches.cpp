#include "view/port_patches.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"
#include "picture/section.h"

namespace palpate::tools {
namespace {

constexpr int kNoPort = -1;
constexpr int kCutsAtRim = 4;       // times that a triangle at a port's rim is cut into four
constexpr int kCutsToFind = 8;      // the same, to find a port within a triangle
constexpr double kThinnest = 0.01;  // least width of an extent, as a share of its longest side
constexpr double kOff = 1e-6;       // distance to either side of a surface, as a share of size_

/// A point of a surface, and the port there.
struct Spot {
  Vec3 point{0.0};
  Vec3 normal{0.0};
  int port = kNoPort;
};
using Corners = std::array<Spot, 3>;

bool isOnePort(const Corners& t) { return t[0].port == t[1].port && t[1].port == t[2].port; }

}  // namespace

/// Cuts the triangles of one layer's surface.
class PortPatches::Cutter {
 public:
  Cutter(PortPatches& owner, const Field& field)
      : owner_(owner),
        scene_(*owner.scene_),
        field_(field),
        here_(scene_.partition().leaves().size()),
        there_(here_),
        off_(kOff * owner.size_),
        is_joined_(scene_.regions().size() * scene_.regions().size()) {
    const std::size_t count = scene_.regions().size();
    for (std::size_t a = 0; a < count; ++a) {
      for (const PortId port : scene_.passages().portsOf(static_cast<RegionId>(a))) {
        for (std::size_t b = 0; b < count; ++b) {
          if (!scene_.ports()[port].leads(static_cast<RegionId>(a), static_cast<RegionId>(b)))
            continue;
          is_joined_[a * count + b] = true;
          is_joined_[b * count + a] = true;
        }
      }
    }
  }

  /// The spot at `point`, which is on the surface, or in a triangle of cutAll().
  [[nodiscard]] Spot spot(const Vec3& point, const Vec3& normal) {
    return {point, normal, portAt(onSurface(field_, point, reach_), normal)};
  }

  void cutAll(const Corners& t) {
    // Small parts of a triangle may be as far off the surface as the triangle itself.
    reach_ = glm::distance(t[0].point, t[1].point);
    cut(t);
  }

 private:
  /// `finding` and `rim`: how often the triangle was cut so far, to find a port and along a rim.
  void cut(const Corners& t, int finding = 0, int rim = 0) {
    const bool is_one = isOnePort(t);
    if (is_one && t[0].port == kNoPort && finding < kCutsToFind && mayHide(t)) {
      cutUp(t, finding + 1, rim);
    } else if (!is_one && rim < kCutsAtRim) {
      cutUp(t, finding, rim + 1);
    } else {
      const int port = is_one ? t[0].port : middleOf(t).port;
      if (port != kNoPort) put(t, static_cast<std::size_t>(port));
    }
  }

  void cutUp(const Corners& t, int finding, int rim) {
    const Corners between = {middleOf(t[0], t[1]), middleOf(t[1], t[2]), middleOf(t[2], t[0])};
    cut(between, finding, rim);
    for (std::size_t i = 0; i < 3; ++i) {
      cut({t[i], between[i], between[(i + 2) % 3]}, finding, rim);
    }
  }

  /// The port at `p`, a point on the surface; kNoPort if there is only a wall, or no wall. `normal`
  /// is used where the field has no gradient.
  [[nodiscard]] int portAt(const Vec3& p, const Vec3& normal) {
    const Vec3 off = off_ * unitOr(field_.sample(p).gradient, normal);
    const Partition& partition = scene_.partition();
    partition.signsAt(p + off, here_);
    partition.signsAt(p - off, there_);
    const std::size_t a = partition.regionOf(here_);
    const std::size_t b = partition.regionOf(there_);
    if (a == b || !is_joined_[a * scene_.regions().size() + b]) return kNoPort;
    const Boundary boundary = classify(scene_, here_, there_);
    return boundary.isPort() ? static_cast<int>(boundary.port) : kNoPort;
  }

  [[nodiscard]] Spot middleOf(const Spot& a, const Spot& b) {
    return spot(0.5 * (a.point + b.point), unitOr(a.normal + b.normal, a.normal));
  }
  [[nodiscard]] Spot middleOf(const Corners& t) {
    return spot((t[0].point + t[1].point + t[2].point) / 3.0,
                unitOr(t[0].normal + t[1].normal + t[2].normal, t[0].normal));
  }

  /// Whether a port may lie within the triangle, with none of the corners in it.
  [[nodiscard]] bool mayHide(const Corners& t) const {
    Box3 box;
    for (const Spot& corner : t) box.include(corner.point);
    const double length = glm::length(box.size());
    return std::any_of(owner_.extents_.begin(), owner_.extents_.end(), [&](const Extent& extent) {
      // Half the width, so that only a small part of a port can lie between the corners.
      return length > 0.5 * extent.width && !extent.box.intersectedWith(box).isEmpty();
    });
  }

  void put(const Corners& t, std::size_t port) {
    SurfaceNet& patch = owner_.patches_[port];
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = t[i].point;
      const auto [at, is_new] = known_.try_emplace({port, p.x, p.y, p.z},
                                                   static_cast<std::uint32_t>(patch.points.size()));
      if (is_new) {
        patch.points.push_back(p);
        patch.normals.push_back(t[i].normal);
      }
      triangle[i] = at->second;
    }
    patch.triangles.push_back(triangle);
  }

  PortPatches& owner_;
  const Scene& scene_;
  const Field& field_;
  Signs here_;
  Signs there_;
  double off_;                   ///< [m]
  double reach_ = 0.0;           ///< [m] from a point to the surface, at most
  std::vector<bool> is_joined_;  ///< by two regions: whether some port leads from one to the other
  std::map<std::tuple<std::size_t, double, double, double>, std::uint32_t> known_;
};

PortPatches::Extent PortPatches::extentOf(const Scene& scene, const Port& port) {
  Extent extent;
  double width = kInfinity;
  for (const SideStep& step :
       scene.partition().maskSides(static_cast<std::size_t>(port.mask), true)) {
    if (!step.inside) continue;
    for (std::size_t i = 0; i < step.count; ++i) {
      const Leaf& leaf = scene.partition().leaves()[step.first + i];
      if (!leaf.field->bounds().isBounded()) continue;
      extent.box = extent.box.unitedWith(leaf.field->bounds());
      width = std::min(width, leaf.feature);
    }
  }
  if (extent.box.isEmpty()) return extent;
  const Vec3 size = extent.box.size();
  extent.width = std::max(width, kThinnest * std::max({size.x, size.y, size.z}));
  return extent;
}

PortPatches::PortPatches(ScenePtr scene, double size)
    : scene_(std::move(scene)), size_(size), patches_(scene_->ports().size()) {
  for (const Port& port : scene_->ports()) {
    if (port.mask < 0) continue;
    const Extent extent = extentOf(*scene_, port);
    if (!extent.box.isEmpty()) extents_.push_back(extent);
  }
}

void PortPatches::add(RegionId region, const SurfaceNet& net,
                      const std::function<bool()>& is_wanted) {
  if (patches_.empty()) return;
  Cutter cutter(*this, *scene_->regions()[region].field);
  std::vector<Spot> spots;
  spots.reserve(net.points.size());
  for (std::size_t i = 0; i < net.points.size(); ++i) {
    if (!is_wanted()) return;
    spots.push_back(cutter.spot(net.points[i], net.normals[i]));
  }
  for (const auto& t : net.triangles) {
    if (!is_wanted()) return;
    cutter.cutAll({spots[t[0]], spots[t[1]], spots[t[2]]});
  }
}

}  // namespace palpate::tools
