#include "mesh/builder.h"

#include <algorithm>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

/// Twice the area of a, b, c seen against `normal`; positive if they are counterclockwise.
double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return glm::dot(glm::cross(b - a, c - a), normal);
}

/// Whether `n` corners form a strictly convex polygon that goes round once: then a fan of triangles
/// does, without a search for ears.
template <typename At>
bool isFan(const At& at, std::size_t n, const Vec3& normal) {
  for (std::size_t i = 0; i < n; ++i) {
    if (!(turn(at(i + n - 1), at(i), at(i + 1), normal) > 0.0)) return false;
    if (i + 2 < n && !(turn(at(n - 1), at(i), at(i + 1), normal) > 0.0)) return false;
  }
  return true;
}

bool holdsPoint(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Vec3& normal) {
  return turn(a, b, p, normal) >= 0.0 && turn(b, c, p, normal) >= 0.0 &&
         turn(c, a, p, normal) >= 0.0;
}

}  // namespace

void refuseIndex(const std::string& file, std::size_t face, long long index, std::size_t count,
                 int line) {
  throw Error(ErrorKind::kInput,
              {"mesh.index",
               "face " + std::to_string(face) + " (from 0) names vertex " + std::to_string(index) +
                   ", but the mesh has " + std::to_string(count) + " vertices",
               "the file is damaged or was written wrongly; export the mesh again", file, line});
}

void MeshBuilder::refuseVertex(const Vec3& p, const std::string& where, int line) const {
  throw Error(ErrorKind::kInput, {"mesh.not_finite",
                                  where + " lies at (" + std::to_string(p.x) + ", " +
                                      std::to_string(p.y) + ", " + std::to_string(p.z) + ")",
                                  "repair or export the mesh again", mesh_.source, line});
}

std::uint32_t MeshBuilder::weld(const Vec3& p) {
  // Adding zero turns -0 into +0, so that both count as one position.
  const std::array<std::uint64_t, 3> key{std::bit_cast<std::uint64_t>(p.x + 0.0),
                                         std::bit_cast<std::uint64_t>(p.y + 0.0),
                                         std::bit_cast<std::uint64_t>(p.z + 0.0)};
  const auto [entry, is_new] =
      numbers_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
  if (is_new) mesh_.vertices.push_back(p);
  return entry->second;
}

/// A triangle with two corners at one point has no area, and its other two sides cancel, so that it
/// is dropped. One with three corners in a line has no area either, but without it its neighbors
/// would not meet.
void MeshBuilder::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a == b || b == c || c == a) {
    ++mesh_.dropped_triangles;
  } else {
    mesh_.triangles.push_back({a, b, c});
  }
}

/// The time of the search for ears grows with the square of a face's corners as a rule, and with
/// their cube in the worst case.
void MeshBuilder::spend(std::size_t tests, std::size_t corners) {
  constexpr std::uint64_t kMost =
      200'000'000;  // some seconds; enough for hundreds of faces of a thousand corners
  constexpr std::uint64_t kPoll = 1U << 20U;
  const std::uint64_t before = spent_;
  spent_ += tests;
  if (before / kPoll != spent_ / kPoll) pollStop();
  if (spent_ <= kMost) return;
  throw inputError("mesh.polygon",
                   "faces of too many corners (one of " + std::to_string(corners) +
                       ") take too long to cut into triangles",
                   "export the mesh with triangles", mesh_.source);
}

void MeshBuilder::addPolygon(std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) return;
  if (++polygons_ % 1024 == 0) pollStop();
  std::vector<std::uint32_t> rest(corners.begin(), corners.end());
  const auto at = [&](std::size_t i) -> const Vec3& {
    return mesh_.vertices[rest[i % rest.size()]];
  };
  Vec3 normal(0.0);
  for (std::size_t i = 1; rest.size() > 3 && i + 1 < rest.size(); ++i) {
    normal += glm::cross(at(i) - at(0), at(i + 1) - at(0));
  }
  if (rest.size() > 3 && isFan(at, rest.size(), normal)) {
    for (std::size_t i = 0; i + 2 < rest.size(); ++i) {
      addTriangle(rest.back(), rest[i], rest[i + 1]);
    }
    return;
  }
  for (std::size_t n = rest.size(); n > 3; n = rest.size()) {
    std::size_t ear = n;
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      const std::size_t before = i + n - 1;
      bool is_ear = turn(at(before), at(i), at(i + 1), normal) > 0.0;
      spend(is_ear ? n : 1, corners.size());
      for (std::size_t k = i + 2; is_ear && k < before; ++k) {
        is_ear = !holdsPoint(at(before), at(i), at(i + 1), at(k), normal);
      }
      if (is_ear) ear = i;
    }
    if (ear == n) ear = 0;  // no area, or it crosses itself: any cut will do
    addTriangle(rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  addTriangle(rest[0], rest[1], rest[2]);
}

Mesh MeshBuilder::take() {
  if (mesh_.triangles.empty()) {
    throw inputError("mesh.no_faces",
                     mesh_.dropped_triangles > 0
                         ? "every triangle of the mesh has two corners in one point"
                         : "the mesh has no faces",
                     "a surface of triangles is needed, not points or lines", mesh_.source);
  }
  numbers_.clear();
  return std::move(mesh_);
}

}  // namespace palpate::vdb
