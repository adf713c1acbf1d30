#pragma once
/// The `paper` renderer: the source paper's states and ports, driven by the HIP, with Algorithms I
/// and II. Its Table I describes a container made of a sphere A with an opening in a half-space B.
/// Here it is generalized to layers and ports (tools/docs/paper.md says why): for every layer, A
/// are the faces that are walls for a probe in the present state, and B those that a port leaves
/// open for it. The action depends on the state and on the side of A and B that the HIP is on:
///
/// - State is the layer, in A, in B: its content.
/// - State is the layer, in A, out of B: nothing; the way out was missed.
/// - State is the layer, out of A, in B: A from within, reversed, and its content.
/// - State is the layer, out of both: nothing, and the state is kept; this is the leak of the
///   table.
/// - State is another region, in both: A of the layer from outside, unless a later layer was
///   entered.
///
/// A tick passes a port if it takes the HIP from one side of the port's face to the other, the HIP
/// is on the layer's side of its other faces before and after, the state is the region before the
/// face, and the port lets the probe through.

#include <array>
#include <vector>

#include "palpate/contact/paper_contact.h"
#include "paper_faces.h"
#include "renderer_base.h"

namespace palpate {

class PaperRenderer final : public RendererBase {
 public:
  /// @throws Error (kInput) for ports with an opening force and for sheets, which are not in the
  /// paper.
  PaperRenderer(ScenePtr scene, const RendererSettings& settings);

 private:
  [[nodiscard]] TickResult step(const HipState& hip) noexcept override;
  void resume() noexcept override;
  [[nodiscard]] std::span<const PortCrossing> details() const noexcept override {
    return crossings_;
  }
  [[nodiscard]] std::span<const RegionEntry> entered() const noexcept override {
    return {entries_.data(), entry_count_};
  }

  struct Layer {
    PaperWall wall;
    PaperSurface surface;  ///< of its walls, from outside
    double beneath = 0.0;  ///< [m] how far below the contact point to look up the region
  };

  void start(const HipState& hip) noexcept;

  // Ports: paper_ports.cpp
  void advance(const Vec3& hip, TickResult& out) noexcept;
  [[nodiscard]] bool tryPort(PortId id, const Vec3& hip, TickResult& out) noexcept;
  [[nodiscard]] bool tryAbsentWalls(const Vec3& hip) noexcept;
  /// Copies cell_ into turned_ and gives those of the `leaves` that changed their present sides.
  /// False if none changed.
  [[nodiscard]] bool turn(std::span<const LeafId> leaves) noexcept;
  /// The same for the faces between the present region and `to`. False if they do not lead to `to`.
  [[nodiscard]] bool turnTo(RegionId to, const Vec3& hip) noexcept;
  [[nodiscard]] Vec3 crossingPoint(LeafId leaf, const Vec3& hip) const noexcept;
  void enter(const RegionEntry& entry) noexcept;
  void openFaces() noexcept;

  // Forces: paper_renderer.cpp
  void feel(const HipState& hip, TickResult& out) noexcept;
  void feelContent(const HipState& hip, TickResult& out) noexcept;
  void touch(std::size_t layer, double side, const HipState& hip, TickResult& out) noexcept;
  [[nodiscard]] RegionId regionBehind(std::size_t layer, double side) noexcept;

  PaperParameters parameters_;
  std::vector<Layer> layers_;                        ///< by layer, outermost first
  std::vector<std::vector<RegionId>> free_ways_of_;  ///< by region: reached without a wall

  // Values of this tick.
  std::array<PortCrossing, TickResult::kMaxEvents> crossings_{};
  std::array<RegionEntry, TickResult::kMaxEvents> entries_{};
  std::size_t entry_count_ = 0;
  Signs now_;     ///< cell of the HIP
  Signs cell_;    ///< cell of the last tick, updated by the ports passed since
  Signs turned_;  ///< the same, behind a port that is being tried
  Signs scratch_;
  LeafId turned_leaf_ = 0;  ///< one of the leaves that differ in turned_
};

}  // namespace palpate
