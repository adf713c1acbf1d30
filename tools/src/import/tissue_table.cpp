#include "import/tissue_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "import/tissue_choice.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/text.h"
#include "text.h"

namespace palpate::tools {
namespace {

/// Poisson's ratio of a tissue that states none: nearly incompressible.
constexpr double kPoisson = 0.45;
/// Twice Vesic's 0.65: tissue is on both sides of the shaft, whereas a beam on the ground has it on
/// one side.
constexpr double kVesic = 1.3;

}  // namespace

const char* basisName(Basis basis) {
  switch (basis) {
    case Basis::kMeasured:
      return "measured";
    case Basis::kDerived:
      return "derived";
    case Basis::kAssumed:
      break;
  }
  return "assumed";
}

const Tissue* TissueTable::of(const std::string& label) const {
  const std::string name = simplified(label);
  for (const Tissue& tissue : tissues) {
    for (const std::string& pattern : tissue.labels) {
      if (matchesGlob(simplified(pattern), name)) return &tissue;
    }
  }
  return nullptr;
}

const Tissue* TissueTable::find(const std::string& name) const {
  const auto at = std::find_if(tissues.begin(), tissues.end(),
                               [&](const Tissue& tissue) { return tissue.name == name; });
  return at == tissues.end() ? nullptr : &*at;
}

SourcedNumber TissueTable::wallStiffness(const Tissue& tissue) const {
  SourcedNumber result;
  if (tissue.stiffness) {
    result = *tissue.stiffness;
  } else {
    const double nu = tissue.poisson->value;
    const double young =
        tissue.young ? tissue.young->value : 2.0 * tissue.shear->value * (1.0 + nu);
    const SourcedNumber& modulus = tissue.young ? *tissue.young : *tissue.shear;
    result.value = 2.0 * tip_radius.value * young / (1.0 - nu * nu);
    result.basis = Basis::kDerived;
    result.source =
        std::string("K = 2 a E / (1 - nu^2), a = ") + tip_radius.text + " (" +
        basisName(tip_radius.basis) + "), " + (tissue.young ? "E = " : "E = 2 G (1 + nu), G = ") +
        modulus.text + " (" + basisName(modulus.basis) + ": " + modulus.source +
        "), nu = " + tissue.poisson->text + " (" + basisName(tissue.poisson->basis) + ")";
  }
  if (result.value > stiffest.value) {
    result.source = "cut to " + stiffest.text + " (" + basisName(stiffest.basis) + ": " +
                    stiffest.source + ") from " + formatNumber(result.value, 3) +
                    " N/m: " + result.source;
    result.value = stiffest.value;
  }
  result.text = formatNumber(result.value) + " N/m";
  return result;
}

double TissueTable::poissonOf(const Tissue& tissue) {
  return tissue.poisson ? tissue.poisson->value : kPoisson;
}

SourcedNumber TissueTable::modulus(const Tissue& tissue) const {
  SourcedNumber result;
  const double nu = poissonOf(tissue);
  if (tissue.young) {
    result = *tissue.young;
    result.text = "E = " + result.text;
  } else if (tissue.shear) {
    result = *tissue.shear;
    result.value *= 2.0 * (1.0 + nu);
    result.text = "E = 2 G (1 + nu), G = " + result.text;
  } else {
    result = *tissue.stiffness;
    result.value *= (1.0 - nu * nu) / (2.0 * tip_radius.value);
    result.text = "E = K (1 - nu^2) / (2 a), K = " + result.text + ", a = " + tip_radius.text;
  }
  return result;
}

std::optional<TissueTable::Lateral> TissueTable::lateral(const Tissue& tissue) const {
  if (!tissue.cutting || !(tissue.cutting->value > 0.0) || !tissue.shaft || !shaft_spring ||
      !shaft_young) {
    return std::nullopt;
  }
  Lateral result;
  const double nu = poissonOf(tissue);
  const SourcedNumber young = modulus(tissue);
  SourcedNumber& stiffness = result.stiffness;
  // The second moment of area of a solid rod is pi d^4 / 64: its diameter cancels.
  stiffness.value =
      kVesic * std::pow(64.0 * young.value / (std::numbers::pi * shaft_young->value), 1.0 / 12.0) *
      young.value / (1.0 - nu * nu);
  stiffness.basis = Basis::kDerived;
  stiffness.source = "k = 1.3 (E d^4 / (E_n I))^(1/12) E / (1 - nu^2) (Vesic 1961, both sides), " +
                     young.text + " (" + basisName(young.basis) + "), nu = " + formatNumber(nu, 3) +
                     ", E_n = " + shaft_young->text + ", I = pi d^4 / 64";
  const double most = 3.0 * shaft_spring->value;
  if (stiffness.value > most) {
    stiffness.source =
        "cut to three times the spring while it sticks (as stiff at the tip, as far in) from " +
        formatNumber(stiffness.value, 3) + " N/m^2: " + stiffness.source;
    stiffness.value = most;
  }
  stiffness.text = formatNumber(stiffness.value, 3) + " N/m^2";
  SourcedNumber& strength = result.strength;
  strength.value = tissue.cutting->value / (2.0 * tip_radius.value);
  strength.basis = Basis::kDerived;
  strength.source = "cutting / (2 a), " + tissue.cutting->text + " and a = " + tip_radius.text +
                    ": across its width the tip cuts with that much; a shaft is blunter";
  strength.text = formatNumber(strength.value, 3) + " N/m";
  return result;
}

}  // namespace palpate::tools
