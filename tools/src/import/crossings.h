#pragma once
/// The walls between regions and the ports through them, from the classes of their tissues.

#include <cstddef>
#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/tissue_table.h"

namespace palpate::tools {

/// A force, and the tissue that it comes from; null: 0 N.
struct TissueForce {
  const SourcedNumber* force = nullptr;
  const Tissue* of = nullptr;
  const char* what = "";  ///< the tissue's key for this force

  [[nodiscard]] std::string text() const { return force != nullptr ? force->text : "0 N"; }
  friend bool operator==(const TissueForce& a, const TissueForce& b) { return a.force == b.force; }
};

/// A port from all regions of `outer` into all regions of `inner`.
struct Passage {
  std::string name;
  std::vector<std::size_t> outer;
  std::vector<std::size_t> inner;
  TissueForce in;
  TissueForce out;
  TissueForce reopens;  ///< no force: the port leaves no hole
};

/// A wall between two layers that is not the later layer's own.
struct WallBetween {
  std::vector<std::size_t> outer;
  std::vector<std::size_t> inner;
  const Tissue* wall = nullptr;  ///< null: absent
};

struct Crossings {
  std::vector<WallBetween> walls;
  std::vector<Passage> ports;  ///< the skin's port comes first
};

/// @throws Error (kInput) as requireTissue().
[[nodiscard]] Crossings crossings(const ImportedScan& scan, const TissueTable& tissues);

}  // namespace palpate::tools
