#pragma once
/// What tissues feel like, each number with where it is from: data/materials/tissues.yaml, or a
/// file like it.

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

/// Stiffness by the CT number of a voxel: [Hounsfield units], [N/m], by rising CT number.
struct SourcedTransfer {
  std::vector<std::pair<double, double>> points;
  std::string text = {};  ///< as a scene has it: [[-100, 65 N/m], [50, 156 N/m]]
  Basis basis = Basis::kAssumed;
  std::string source = {};
};

struct Tissue {
  std::string name;
  TissueClass kind = TissueClass::kSolid;
  bool parcels_joined = false;      ///< two regions of it have no wall between them
  bool is_spared = false;           ///< a planned way keeps clear of it
  std::string lining;               ///< of a fluid or a gas: a membrane of the table; or empty
  std::vector<std::string> labels;  ///< patterns of label names
  std::optional<SourcedNumber> stiffness;  ///< [N/m]
  std::optional<SourcedNumber> young;      ///< [Pa]
  std::optional<SourcedNumber> shear;      ///< [Pa]
  std::optional<SourcedNumber> poisson;
  std::optional<SourcedNumber> damping;    ///< [N s/m]
  std::optional<SourcedNumber> friction;   ///< static; sliding is the same
  std::optional<SourcedNumber> viscosity;  ///< [N s/m]
  std::optional<SourcedNumber> opens_at;   ///< [N]
  std::optional<SourcedNumber> back;       ///< [N] out of it, where no hole is
  std::optional<SourcedNumber> reopens;    ///< [N] in a hole that is there
  // Of a needle in it.
  std::optional<SourcedNumber> cutting;  ///< [N]
  std::optional<SourcedNumber> shaft;    ///< [N/m] friction on each length of the shaft that slides
  std::optional<SourcedNumber> shaft_static;       ///< [N/m] and that sticks; no less than `shaft`
  std::optional<SourcedTransfer> stiffness_of_ct;  ///< where there is a CT image

  /// Whether something is felt inside of it.
  [[nodiscard]] bool hasContent() const { return viscosity || cutting || shaft; }
  /// A fluid or a gas has no elastic wall.
  [[nodiscard]] bool hasWall() const { return stiffness || young || shear; }
};

struct TissueTable {
  std::string file;
  SourcedNumber tip_radius;  ///< [m]
  SourcedNumber stiffest;    ///< [N/m]
  std::optional<SourcedNumber>
      shaft_spring;  ///< [N/m^2] of a shaft that sticks; given if a tissue has `shaft`
  std::optional<SourcedNumber> shaft_young;  ///< [Pa] of a needle's shaft, a solid rod
  std::string unknown;                       ///< the tissue of what nothing fits; or empty
  std::vector<Tissue> tissues;

  /// The first tissue with a pattern that fits a label's name, or null.
  [[nodiscard]] const Tissue* of(const std::string& label) const;
  /// By its own name, or null.
  [[nodiscard]] const Tissue* find(const std::string& name) const;
  /// Of a tissue that has a wall: measured, derived or assumed, and how it came about.
  [[nodiscard]] SourcedNumber wallStiffness(const Tissue& tissue) const;
  /// What holds a needle's shaft sideways in a tissue that can be cut, on each length of it.
  struct Lateral {
    SourcedNumber stiffness;  ///< [N/m^2]
    SourcedNumber strength;   ///< [N/m] the load that tears the tissue
  };
  /// None where the tissue has no `cutting` or no `shaft`, or the table says nothing of the shaft's
  /// modulus.
  [[nodiscard]] std::optional<Lateral> lateral(const Tissue& tissue) const;

 private:
  /// [Pa] E of a tissue, or what its wall's stiffness says of it; and the words for it.
  [[nodiscard]] SourcedNumber modulus(const Tissue& tissue) const;
  [[nodiscard]] static double poissonOf(const Tissue& tissue);
};

/// @throws Error (kInput), with file, line and column, for anything but such a table.
[[nodiscard]] TissueTable readTissueTable(const std::string& path);
/// The project's own.
[[nodiscard]] TissueTable ownTissueTable();

}  // namespace palpate::tools
