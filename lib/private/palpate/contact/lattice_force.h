#pragma once
/// The periodic force of a content (materials/material.h, Lattice).

#include "palpate/materials/material.h"

namespace palpate {

struct LatticePush {
  /// [N] minus the gradient of `energy`, including that of its amplitude
  Vec3 force{0.0, 0.0, 0.0};
  double energy = 0.0;  ///< [J] 0 or more; 0 at the origin
};

/// Push at `p` [m, world]; `amplitude` is the lattice's force parameter there, or a replacement.
[[nodiscard]] LatticePush latticePush(const Lattice& lattice, const MaterialMap::Sample& amplitude,
                                      const Vec3& p) noexcept;

}  // namespace palpate
