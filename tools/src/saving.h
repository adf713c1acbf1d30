#pragma once
/// The cost saved by not making parts that a scene does not need.

#include <cstdint>
#include <optional>

#include "loaded_scene.h"

namespace palpate::tools {

struct Saving {
  std::uint64_t bytes = 0;
  double seconds = 0.0;
};

/// Measured cost of a scene: its file is read anew and compiled for `purpose`. The bytes are those
/// of the grids that the loop reads. @throws Error.
[[nodiscard]] Saving costOf(const std::string& file, Purpose purpose, Console& console);

/// An estimate: the cost of a band is proportional to its surface, for which the surface of its box
/// is used. Nothing if no part was left out, or if no grid was made from which the cost of one
/// would follow.
[[nodiscard]] std::optional<Saving> savingOf(const LoadedScene& loaded, const Scene& scene);

}  // namespace palpate::tools
