#pragma once
/// Inside or outside of a solid, by counting its walls along lines of voxels.

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
/// The walls crossed, each with its direction, add up to the winding number of each part; a point
/// is in a part where that is not zero. A part that lies in another and is turned the other way is
/// a cavity, whatever way the outer one is turned; all others are solid, and those that overlap,
/// one. That is the winding number's vote. The flood's: what cannot be reached from outside is
/// inside, cavities excepted. With MeshSign::kFlood they are not, and the flood decides.
class Columns {
 public:
  /// Parts of which nothing tells whether they are cavities or inside out.
  struct Doubt {
    Vec3 place;  ///< [voxels]
    std::string why;
  };
  /// Enclosed and yet not inside: what the two votes differ about.
  struct Pocket {
    Box3 box;                ///< [voxels]
    std::size_t voxels = 0;  ///< in it
  };

  Columns(const Solid& solid, MeshSign sign, const Progress& progress);

  [[nodiscard]] bool isInside(int x, int y, int z) const noexcept;

  /// The same for the voxels from y and z on, eight along each: a byte for each y, a bit for each
  /// z.
  [[nodiscard]] std::array<std::uint8_t, 8> areInside(int x, int y, int z) const noexcept;

  [[nodiscard]] const std::optional<Doubt>& doubt() const noexcept { return doubt_; }
  [[nodiscard]] const std::vector<Pocket>& pockets() const noexcept { return pockets_; }
  /// Whether walls were crossed that have the solid, or nothing, on both sides.
  [[nodiscard]] bool hasIdleWalls() const noexcept { return has_idle_walls_; }
  /// Whether the flood decided, and filled something.
  [[nodiscard]] bool isFilled() const noexcept { return is_filled_; }
  /// +1 for a solid, -1 for a cavity, by part.
  [[nodiscard]] const std::vector<int>& roles() const noexcept { return roles_; }

 private:
  struct Crossing {
    int x, y;
    double z;
    int entered;  ///< walls entered, less walls left
    std::uint32_t part;
  };
  /// A stretch of a column within the solid.
  struct Span {
    double begin, end;
    bool after_cavity;  ///< the gap before it lies in one
  };
  struct Column {
    int y;
    std::size_t first;  ///< of its spans
  };

  static void sortCrossings(std::vector<Crossing>& crossings);
  void findRoles(const Solid& solid, const std::vector<Crossing>& crossings, MeshSign sign);
  void makeSpans(const std::vector<Crossing>& crossings);
  void flood(MeshSign sign);
  void fill(const std::vector<bool>& enclosed);
  /// The first column of row x from y on, and the row's end.
  [[nodiscard]] std::pair<std::size_t, std::size_t> findFrom(int x, int y) const noexcept;
  /// Number of the column; columns_.size() - 1 if it never meets the solid.
  [[nodiscard]] std::size_t find(int x, int y) const noexcept;

  std::vector<Span> spans_;        ///< by x, y, z
  std::vector<Column> columns_;    ///< those with spans, and one more
  std::vector<std::size_t> rows_;  ///< of columns, by x - first_x_, and one more
  int first_x_ = 0;
  std::vector<int> roles_;
  std::optional<Doubt> doubt_;
  std::vector<Pocket> pockets_;
  bool has_idle_walls_ = false;
  bool is_filled_ = false;
};

}  // namespace palpate::vdb
