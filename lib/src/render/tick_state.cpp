#include "palpate/render/tick_state.h"

#include <cstring>

namespace palpate {

RendererState::RendererState() noexcept : RendererState(TickState{}) {}

RendererState::RendererState(const TickState& state) noexcept {
  static_assert(sizeof(TickState) <= kBytes && alignof(TickState) <= 8);
  std::memcpy(bytes_.data(), &state, sizeof state);
}

std::uint64_t RendererState::layout() noexcept {
  // Most changes of the layout that keep the total size change the size of some part.
  std::uint64_t out = 0;
  for (const std::size_t size :
       {sizeof(TickState), sizeof(PlaceState), sizeof(FrictionState), sizeof(RelaxationState),
        sizeof(Insertion), sizeof(PaperTouch), sizeof(ForceGuard), sizeof(SourceState)}) {
    out = (out ^ size) * 0x100000001b3U;  // as FNV-1a does
  }
  return out;
}

RendererState TickState::sealed() const noexcept { return RendererState(*this); }

TickState TickState::of(const RendererState& sealed) noexcept {
  TickState out;
  std::memcpy(&out, sealed.bytes_.data(), sizeof out);
  return out;
}

}  // namespace palpate
