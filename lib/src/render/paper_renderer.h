#pragma once
/// The `paper` renderer: the source paper's states and ports, driven by the HIP, with Algorithms I
/// and II. Its Table I, for a container of a sphere A with an opening in a half-space B, is
/// generalized to layers and ports thus (tools/docs/paper.md says why). Of every layer, A are the
/// faces that are walls for a probe in the present state, and B those that a port leaves open for
/// it.
///
/// | the state | A   | B   | action | | a layer   | in  | in  | its content | | a layer   | in  |
/// out | nothing: the way out was missed                                          | | a layer   |
/// out | in  | A from within, reversed, and its content                                 | | a layer
/// | out | out | nothing, and the state is kept: the leak of the table                    | |
/// another   | in  | in  | A of the layer from outside, where a later layer was not entered |
///
/// A tick that takes the HIP from one side of a port's face to the other, on the layer's side of
/// its other faces before and after, passes the port, if the state is the region before it and the
/// port lets through.

#include <array>
#include <vector>

#include "palpate/contact/paper_contact.h"
#include "paper_faces.h"
#include "renderer_base.h"

namespace palpate {

class PaperRenderer final : public RendererBase {
 public:
  /// @throws Error (kInput) for ports with an opening force and for sheets, which the paper does
  /// not have.
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
    double beneath = 0.0;  ///< [m] so far below the contact point one is in the region behind it
  };

  void start(const HipState& hip) noexcept;

  // Ports: paper_ports.cpp
  void advance(const Vec3& hip, TickResult& out) noexcept;
  [[nodiscard]] bool tryPort(PortId id, const Vec3& hip, TickResult& out) noexcept;
  [[nodiscard]] bool tryAbsentWalls(const Vec3& hip) noexcept;
  /// Gives the leaves that changed since cell_ their present signs there, into turned_. False if
  /// none did.
  [[nodiscard]] bool turn(std::span<const LeafId> leaves) noexcept;
  /// The same for the faces between the present region and `to`. False if they do not lead there.
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
  std::vector<std::vector<RegionId>> free_ways_of_;  ///< by region: what no wall stands before

  // Of this tick.
  std::array<PortCrossing, TickResult::kMaxEvents> crossings_{};
  std::array<RegionEntry, TickResult::kMaxEvents> entries_{};
  std::size_t entry_count_ = 0;
  Signs now_;     ///< the cell of the HIP
  Signs cell_;    ///< the cell of the last tick, beyond the ports passed since
  Signs turned_;  ///< the same behind a port that is looked at
  Signs scratch_;
  LeafId turned_leaf_ = 0;  ///< one of those that differ in turned_
};

}  // namespace palpate
