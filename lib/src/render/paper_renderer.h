#pragma once
/// The `paper` renderer: Table I driven by the HIP, generalised from one container to a list of layers.
/// Per layer, A is its field without the faces that ports are on, and B those faces:
///
///   | A   | B   | action                                                                            |
///   | in  | in  | came from (in, out) by an open port: ENTER. Entered: content. Else: A from outside |
///   | in  | out | came from (in, in): EXIT                                                          |
///   | out | in  | entered: A from within. Else nothing                                              |
///   | out | out | nothing (and ENTER is kept: the leak that the constraint renderer does not have)   |
///
/// A port that lies on no face is an opening of A itself: crossing A there is ENTER or EXIT.

#include <vector>

#include "palpate/contact/paper_contact.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {

class PaperRenderer final : public HapticRenderer {
 public:
  /// @throws Error (kInput) for ports with an opening force, which the paper does not have.
  PaperRenderer(ScenePtr scene, const RendererSettings& settings);

 private:
  [[nodiscard]] TickResult step(const HipState& hip) noexcept override;
  void forget() noexcept override;
  [[nodiscard]] std::span<const PortCrossing> details() const noexcept override {
    return crossings_;
  }

  /// Table I's view of one layer.
  struct Table {
    FieldPtr wall;                   ///< A
    std::vector<FieldPtr> openings;  ///< B of every port that is on a face
    std::vector<PortId> on_face;     ///< ports of those faces
    std::vector<PortId> on_wall;     ///< ports in A itself
    PaperSurface surface;            ///< of A, from outside
    bool in_wall = false;            ///< the row of the last tick
    bool in_openings = false;
    bool entered = false;
  };

  void observe(const Vec3& hip) noexcept;
  [[nodiscard]] bool pass(std::size_t layer, bool inward, const std::vector<PortId>& ports,
                          const Vec3& from, const Vec3& to, TickResult& out) noexcept;
  void advance(std::size_t layer, const Vec3& hip, TickResult& out) noexcept;
  [[nodiscard]] RegionId state() const noexcept;
  void feel(const HipState& hip, TickResult& out) noexcept;
  void touch(std::size_t layer, double side, const HipState& hip, TickResult& out) noexcept;

  ScenePtr scene_;
  std::vector<Table> tables_;  ///< by layer, outermost first
  Signs scratch_;
  PassedPorts passed_;
  std::array<PortCrossing, TickResult::kMaxEvents> crossings_{};
  bool started_ = false;
  Vec3 last_{0.0, 0.0, 0.0};  ///< [m] the HIP of the last tick
  bool in_contact_ = false;
  std::size_t contact_layer_ = 0;
  double contact_side_ = 1.0;
  PaperContact contact_;
};

}  // namespace palpate
