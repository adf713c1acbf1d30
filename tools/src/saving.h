#pragma once
/// What it saves not to make what a scene does not need.

#include <cstdint>
#include <optional>

#include "loaded_scene.h"

namespace palpate::tools {

struct Saving {
  std::uint64_t bytes = 0;
  double seconds = 0.0;
};

/// What a scene costs, measured: its file is read anew and compiled for `purpose`. Bytes are those
/// that the loop reads grids from. @throws Error.
[[nodiscard]] Saving costOf(const std::string& file, Purpose purpose, Console& console);

/// An estimate: bands cost by their surface, and that of a box stands for it. None if nothing was
/// left out, or no grid was made that would tell what one costs.
[[nodiscard]] std::optional<Saving> savingOf(const LoadedScene& loaded, const Scene& scene);

}  // namespace palpate::tools
