#include "import/tissue_table.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "palpate/scene/scene_file.h"
#include "text.h"

namespace palpate::tools {
namespace {

/// Blanks and hyphens as underscores, capitals small.
std::string simplified(std::string_view name) {
  std::string result(name);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) {
    return c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return result;
}

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

}  // namespace palpate::tools
