#include "palpate/contact/lattice_force.h"

#include <cmath>

namespace palpate {

LatticePush latticePush(const Lattice& lattice, const MaterialMap::Sample& amplitude,
                        const Vec3& p) noexcept {
  LatticePush out;
  if (!(amplitude.value > 0.0)) return out;
  double lengths = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (!(lattice.wavelength[i] > 0.0)) continue;
    const double k = 2.0 * std::numbers::pi / lattice.wavelength[i];
    const double phase = k * (p[i] - lattice.origin[i]);
    out.force[i] = -amplitude.value * std::sin(phase);
    // 1 - cos(phase), written so that small values keep their digits.
    const double half = std::sin(0.5 * phase);
    lengths += 2.0 * half * half / k;
  }
  out.energy = amplitude.value * lengths;
  out.force -= lengths * amplitude.gradient;
  return out;
}

}  // namespace palpate
