#pragma once
/// Puts a mesh together from the contents of a file: checks, welds, cuts polygons.

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "palpate/core/stop.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

class MeshBuilder {
 public:
  MeshBuilder(std::string source, double meters_per_unit) : meters_per_unit_(meters_per_unit) {
    mesh_.source = std::move(source);
  }

  /// Number of the welded vertex at `p` [units of the file]. `where` names the vertex for messages
  /// ("vertex 7 (from 0)"), `line` is its line in the file.
  /// @throws Error (kInput, mesh.not_finite)
  template <typename Where>
  std::uint32_t addVertex(const Vec3& p, const Where& where, int line = 0) {
    if (!isFinite(p)) refuseVertex(p, where(), line);
    if (++vertices_ % 1024 == 0) pollStop();
    return weld(p * meters_per_unit_);
  }

  /// Corners are numbers from addVertex(); polygons are triangulated by cutting off ears.
  /// @throws Error (kInput, mesh.polygon) if that takes too long, kCancelled if the user asked to
  /// stop.
  void addPolygon(std::span<const std::uint32_t> corners);

  /// @throws Error (kInput, mesh.no_faces)
  [[nodiscard]] Mesh take();

 private:
  struct BitsHash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& key) const noexcept {
      std::uint64_t hash = 0;
      for (const std::uint64_t word : key) {
        hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32;
      }
      return hash;
    }
  };

  [[noreturn]] void refuseVertex(const Vec3& p, const std::string& where, int line) const;
  std::uint32_t weld(const Vec3& p);
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void spend(std::size_t tests, std::size_t corners);

  std::uint64_t spent_ = 0;  ///< tests of ears so far
  std::uint64_t polygons_ = 0;
  std::uint64_t vertices_ = 0;
  double meters_per_unit_;
  Mesh mesh_;
  std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, BitsHash> numbers_;
};

/// @throws Error (kInput, mesh.index): a face names vertex `index`, but there are only `count`.
[[noreturn]] void refuseIndex(const std::string& file, std::size_t face, long long index,
                              std::size_t count, int line = 0);

/// STL, ASCII and binary; told apart by the length of the file, not by its first word.
[[nodiscard]] Mesh readStl(const std::string& path, double meters_per_unit);

/// Wavefront OBJ: vertices and faces; normals, groups and materials are ignored.
[[nodiscard]] Mesh readObj(const std::string& path, double meters_per_unit);

/// PLY, ASCII and binary of either byte order.
[[nodiscard]] Mesh readPly(const std::string& path, double meters_per_unit);

/// Legacy VTK polydata, ASCII and binary: polygons and triangle strips; points and lines are
/// ignored.
[[nodiscard]] Mesh readVtk(const std::string& path, double meters_per_unit);

/// The space that the first lines of a file state; kStated if they state none.
[[nodiscard]] Space statedSpace(const std::string& path);

/// The whole file. @throws Error (kInput)
[[nodiscard]] std::string readBytes(const std::string& path);

}  // namespace palpate::vdb
