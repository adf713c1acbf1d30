#pragma once
/// The distance to a surface net, for baking.

#include <array>
#include <cstdint>
#include <vector>

#include "palpate/fields/field.h"
#include "scan/lattice.h"
#include "scan/lattice_spline.h"
#include "scan/surface_net.h"

namespace palpate::vdb {

/// Distance to the triangles of a surface net, negative inside, cavities included, for points
/// nearer than `reach`; farther away the value is a lower bound of it, at least `reach`, with the
/// right sign.
///
/// Each lattice point within reach learns its closest triangle from its neighbours; a query walks
/// from those of the eight points around it to adjacent triangles while they are closer. Within a
/// cell's diagonal of the surface that finds the closest one; farther out, where the surface is
/// rough, a few points in a thousand get one that is up to 0.2 voxels farther away. Near the
/// surface the sign comes from the closest triangle; where several share the closest point (an
/// edge, a corner), from the one whose plane is seen most squarely. Farther away it is the
/// lattice's.
class NetField final : public Field {
 public:
  /// All must outlive the field. `reach` in [m]. With a spline the distance is to its surface, from where the
  /// net's closest point leads to; the net's own where that leads nowhere.
  NetField(const Mesh& net, const Lattice& lattice, const Image& image, double reach,
           const LatticeSpline* spline = nullptr);

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override;
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return sample(p).value; }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  /// Parts thinner than the voxels are no reason to refuse a scan; who bakes it counts them.
  [[nodiscard]] double featureSize() const noexcept override { return reach_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  /// A lattice point, or one of the margin around the lattice, and what it knows.
  struct Node {
    std::uint32_t triangle = kNone;
    float distance2 = 0.0F;  ///< [m^2] to it
  };
  struct Closest;
  class Spreader;

  void makeFans();
  void markBlocks();
  [[nodiscard]] std::size_t blockIndex(const std::array<int, 3>& block) const noexcept;
  /// From the closest point of a triangle to `p`.
  [[nodiscard]] Vec3 fromTriangle(std::uint32_t triangle, const Vec3& p) const noexcept;
  void lookAt(std::uint32_t triangle, const Vec3& p, Closest& best) const noexcept;
  /// Goes on to triangles that share a corner while they are closer.
  void walk(const Vec3& p, Closest& best) const noexcept;
  [[nodiscard]] bool touch(std::uint32_t a, std::uint32_t b) const noexcept;
  [[nodiscard]] FieldSample farSample(const Vec3& p) const noexcept;
  [[nodiscard]] bool latticeInside(const Vec3& p) const noexcept;

  const Mesh& net_;
  const Lattice& lattice_;
  const Image& image_;
  const LatticeSpline* spline_;
  double diagonal_;  ///< [m] of a lattice cell
  Mat3 to_index_;
  double reach_;  ///< [m] at least diagonal_, from where on the lattice gives the sign
  Box3 bounds_;

  std::vector<std::uint32_t>
      fan_begin_;  ///< place in fans_ of each vertex's triangles, and the end
  std::vector<std::uint32_t> fans_;

  std::array<int, 3> first_node_{};  ///< image index
  std::array<int, 3> node_count_{};
  std::vector<Node> nodes_;

  double block_;  ///< [m] edge of the cubes that tell how far the surface is at least
  std::array<int, 3> block_count_{};
  std::vector<std::uint8_t> empty_rings_;  ///< of blocks around each block; 255 at most
};

}  // namespace palpate::vdb
