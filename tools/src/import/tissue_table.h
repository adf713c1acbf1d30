#pragma once
/// The mechanical properties of tissues, each number with its source: data/materials/tissues.yaml,
/// or a file of the same form.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "import/border_table.h"

namespace palpate::tools {

enum class Basis { kMeasured, kDerived, kAssumed };
[[nodiscard]] const char* basisName(Basis basis);

/// A number in SI with its source. `text` is as it was written, with its unit.
struct SourcedNumber {
  double value = 0.0;
  std::string text = {};
  Basis basis = Basis::kAssumed;
  std::string source = {};
};

/// Stiffness as a function of a voxel's CT number: [Hounsfield units], [N/m], by rising CT number.
struct SourcedTransfer {
  std::vector<std::pair<double, double>> points;
  std::string text = {};  ///< in the form that a scene has: [[-100, 65 N/m], [50, 156 N/m]]
  Basis basis = Basis::kAssumed;
  std::string source = {};
};

struct Tissue {
  std::string name;
  TissueClass kind = TissueClass::kSolid;
  bool parcels_joined = false;      ///< two regions of it have no wall between them
  bool is_spared = false;           ///< a planned way keeps clear of it
  std::string lining;               ///< for a fluid or a gas: a membrane of the table; or empty
  std::vector<std::string> labels;  ///< patterns of label names
  std::optional<SourcedNumber> stiffness;  ///< [N/m]
  std::optional<SourcedNumber> young;      ///< [Pa]
  std::optional<SourcedNumber> shear;      ///< [Pa]
  std::optional<SourcedNumber> poisson;
  std::optional<SourcedNumber> damping;    ///< [N s/m]
  std::optional<SourcedNumber> friction;   ///< static; sliding is the same
  std::optional<SourcedNumber> viscosity;  ///< [N s/m]
  std::optional<SourcedNumber> opens_at;   ///< [N]
  std::optional<SourcedNumber> back;       ///< [N] out of it, where there is no hole
  std::optional<SourcedNumber> reopens;    ///< [N] through an existing hole
  // For a needle in the tissue.
  std::optional<SourcedNumber> cutting;  ///< [N]
  std::optional<SourcedNumber> shaft;    ///< [N/m] friction per length of the shaft while it slides
  std::optional<SourcedNumber> shaft_static;  ///< [N/m] the same while it sticks; at least `shaft`
  std::optional<SourcedTransfer> stiffness_of_ct;  ///< used where there is a CT image

  /// Whether the tissue is felt inside it, not only at its wall.
  [[nodiscard]] bool hasContent() const { return viscosity || cutting || shaft; }
  /// A fluid or a gas has no elastic wall.
  [[nodiscard]] bool hasWall() const { return stiffness || young || shear; }
};

struct TissueTable {
  std::string file;
  SourcedNumber tip_radius;  ///< [m]
  SourcedNumber stiffest;    ///< [N/m]
  std::optional<SourcedNumber>
      shaft_spring;  ///< [N/m^2] of a shaft that sticks; required if a tissue has `shaft`
  std::optional<SourcedNumber> shaft_young;  ///< [Pa] of a needle's shaft, a solid rod
  std::string unknown;                       ///< tissue for labels that fit none; or empty
  std::vector<Tissue> tissues;

  /// The first tissue with a pattern that matches a label's name, or null.
  [[nodiscard]] const Tissue* of(const std::string& label) const;
  /// The tissue of this name, or null.
  [[nodiscard]] const Tissue* find(const std::string& name) const;
  /// The wall stiffness of a tissue that has a wall: measured, derived or assumed, and explained.
  [[nodiscard]] SourcedNumber wallStiffness(const Tissue& tissue) const;
  /// The sideways support of a needle's shaft by a tissue that can be cut, per length of the shaft.
  struct Lateral {
    SourcedNumber stiffness;  ///< [N/m^2]
    SourcedNumber strength;   ///< [N/m] the load that tears the tissue
  };
  /// Nothing if the tissue has no `cutting` or no `shaft`, or if the table lacks the shaft's
  /// modulus.
  [[nodiscard]] std::optional<Lateral> lateral(const Tissue& tissue) const;

 private:
  /// [Pa] Young's modulus of a tissue, given or derived from the wall's stiffness, with its
  /// explanation.
  [[nodiscard]] SourcedNumber modulus(const Tissue& tissue) const;
  [[nodiscard]] static double poissonOf(const Tissue& tissue);
};

/// @throws Error (kInput), with file, line and column, if the file has another form.
[[nodiscard]] TissueTable readTissueTable(const std::string& path);
/// The project's own table.
[[nodiscard]] TissueTable ownTissueTable();

}  // namespace palpate::tools
