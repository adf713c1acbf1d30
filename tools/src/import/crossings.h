#pragma once
/// The walls between regions, and the ports that lead through them: by the classes of their
/// tissues.

#include <cstddef>
#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/tissue_table.h"

namespace palpate::tools {

/// A force, and the tissue whose it is; none: 0 N.
struct TissueForce {
  const SourcedNumber* force = nullptr;
  const Tissue* of = nullptr;
  const char* what = "";  ///< the key of the tissue that it is

  [[nodiscard]] std::string text() const { return force != nullptr ? force->text : "0 N"; }
  friend bool operator==(const TissueForce& a, const TissueForce& b) { return a.force == b.force; }
};

/// A port of all of `outer` into all of `inner`.
struct Passage {
  std::string name;
  std::vector<std::size_t> outer;
  std::vector<std::size_t> inner;
  TissueForce in;
  TissueForce out;
  TissueForce reopens;  ///< no force: it leaves no hole
};

/// A wall that is not the own of the later of its two layers.
struct WallBetween {
  std::vector<std::size_t> outer;
  std::vector<std::size_t> inner;
  const Tissue* wall = nullptr;  ///< null: absent
};

struct Crossings {
  std::vector<WallBetween> walls;
  std::vector<Passage> ports;  ///< first that of the skin
};

/// @throws Error (kInput) as requireTissue().
[[nodiscard]] Crossings crossings(const ImportedScan& scan, const TissueTable& tissues);

}  // namespace palpate::tools
