#pragma once
/// The cost saved by not making the parts of a scene that are not needed.

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

/// An estimate: the cost of a grid is taken as proportional to the surface of its
/// box. Nothing if no part was left out, or if no grid was made whose cost could be
/// scaled.
[[nodiscard]] std::optional<Saving> savingOf(const LoadedScene& loaded, const Scene& scene);

}  // namespace palpate::tools
