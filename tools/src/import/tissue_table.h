#pragma once
/// What tissues feel like, each number with where it is from: data/materials/tissues.yaml, or a file like it.

#include <optional>
#include <string>
#include <vector>

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

struct Tissue {
  std::string name;
  std::vector<std::string> labels;         ///< patterns of label names
  std::optional<SourcedNumber> stiffness;  ///< [N/m]
  std::optional<SourcedNumber> young;      ///< [Pa]
  std::optional<SourcedNumber> shear;      ///< [Pa]
  std::optional<SourcedNumber> poisson;
  std::optional<SourcedNumber> damping;    ///< [N s/m]
  std::optional<SourcedNumber> friction;   ///< static; sliding is the same
  std::optional<SourcedNumber> viscosity;  ///< [N s/m]
  std::optional<SourcedNumber> opens_at;   ///< [N]
  std::optional<SourcedNumber> back;       ///< [N]
};

struct TissueTable {
  std::string file;
  SourcedNumber tip_radius;  ///< [m]
  SourcedNumber stiffest;    ///< [N/m]
  std::vector<Tissue> tissues;

  /// The first tissue that fits a label's name, or null.
  [[nodiscard]] const Tissue* of(const std::string& label) const;
  /// By its own name, or null.
  [[nodiscard]] const Tissue* find(const std::string& name) const;
  /// Of a tissue's wall: measured, derived or assumed, and how it came about.
  [[nodiscard]] SourcedNumber wallStiffness(const Tissue& tissue) const;
};

/// @throws Error (kInput), with file, line and column, for what is no such table.
[[nodiscard]] TissueTable readTissueTable(const std::string& path);
/// The project's own.
[[nodiscard]] TissueTable ownTissueTable();

}  // namespace palpate::tools
