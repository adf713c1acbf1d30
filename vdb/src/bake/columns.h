#pragma once
/// Inside or outside of a solid, found by counting the walls along lines of voxels.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/solid.h"
#include "palpate/core/progress.h"

namespace palpate::vdb {

/// Where the lines along z through voxel centers enter and leave a solid.
///
/// The crossed walls, each counted with its direction, add up to the winding number of each part; a
/// point is in a part where that number is not zero. A part that lies in another one and is turned
/// against it is a cavity, whichever way the outer one is turned; all others are solid, and
/// overlapping ones form one solid. This is the vote of the winding number. The vote of the flood
/// fill: everything that cannot be reached from outside is inside, except cavities. With
/// MeshSign::kFlood cavities are filled as well, and the flood fill alone decides.
class Columns {
 public:
  /// A part that may be a cavity or inside out: the mesh does not tell which.
  struct Doubt {
    Vec3 place;  ///< [voxels]
    std::string why;
  };
  /// A space that is enclosed and yet not inside: the two votes differ about it.
  struct Pocket {
    Box3 box;                ///< [voxels]
    std::size_t voxels = 0;  ///< number of voxels in it
  };

  Columns(const Solid& solid, MeshSign sign, const Progress& progress);

  [[nodiscard]] bool isInside(int x, int y, int z) const noexcept;

  /// The same for eight by eight voxels from y and z on: a byte for each y, a bit for each z.
  [[nodiscard]] std::array<std::uint8_t, 8> areInside(int x, int y, int z) const noexcept;

  [[nodiscard]] const std::optional<Doubt>& doubt() const noexcept { return doubt_; }
  [[nodiscard]] const std::vector<Pocket>& pockets() const noexcept { return pockets_; }
  /// Whether some crossed wall has solid on both sides, or on neither.
  [[nodiscard]] bool hasIdleWalls() const noexcept { return has_idle_walls_; }
  /// Whether the flood fill decided, and filled something.
  [[nodiscard]] bool isFilled() const noexcept { return is_filled_; }
  /// +1 for a solid, -1 for a cavity, by part.
  [[nodiscard]] const std::vector<int>& roles() const noexcept { return roles_; }

 private:
  struct Crossing {
    int x, y;
    double z;
    int entered;  ///< walls entered minus walls left
    std::uint32_t part;
  };
  /// An interval of a column within the solid.
  struct Span {
    double begin, end;
    bool after_cavity;  ///< the gap before it lies in a cavity
  };
  struct Column {
    int y;
    std::size_t first;  ///< index of the first of its spans
  };

  static void sortCrossings(std::vector<Crossing>& crossings);
  void findRoles(const Solid& solid, const std::vector<Crossing>& crossings, MeshSign sign);
  void makeSpans(const std::vector<Crossing>& crossings);
  void flood(MeshSign sign);
  void fill(const std::vector<bool>& enclosed);
  /// The first column of row x at or after y, and the row's end.
  [[nodiscard]] std::pair<std::size_t, std::size_t> findFrom(int x, int y) const noexcept;
  /// Number of the column; columns_.size() - 1 if it never meets the solid.
  [[nodiscard]] std::size_t find(int x, int y) const noexcept;

  std::vector<Span> spans_;        ///< sorted by x, y, z
  std::vector<Column> columns_;    ///< those with spans, and an empty one at the end
  std::vector<std::size_t> rows_;  ///< first column of each x - first_x_, and an end
  int first_x_ = 0;
  std::vector<int> roles_;
  std::optional<Doubt> doubt_;
  std::vector<Pocket> pockets_;
  bool has_idle_walls_ = false;
  bool is_filled_ = false;
};

}  // namespace palpate::vdb
