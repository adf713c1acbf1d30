// The only file that includes CGAL, which takes long to compile.
#include "cgal/cgal_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace palpate::vdb::test {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

Point pointOf(const Vec3& p) { return {p.x, p.y, p.z}; }

}  // namespace

struct CgalDistance::Tree {
  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

CgalDistance::CgalDistance(const Mesh& mesh) : tree_(std::make_unique<Tree>()) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Kernel::Triangle_3 triangle(pointOf(mesh.vertices[a]), pointOf(mesh.vertices[b]),
                                      pointOf(mesh.vertices[c]));
    if (!triangle.is_degenerate()) tree_->triangles.push_back(triangle);
  }
  tree_->tree.insert(tree_->triangles.begin(), tree_->triangles.end());
  tree_->tree.build();
  tree_->tree.accelerate_distance_queries();
}

CgalDistance::~CgalDistance() = default;

double CgalDistance::to(const Vec3& p) const {
  return std::sqrt(tree_->tree.squared_distance(pointOf(p)));
}

bool CgalDistance::isInside(const Vec3& p) const {
  // Not in a plane of symmetry, so that the ray does not meet edges.
  const Kernel::Vector_3 along(0.4711, 0.1742, 0.8646);
  std::vector<Triangles::const_iterator> met;
  tree_->tree.all_intersected_primitives(Kernel::Ray_3(pointOf(p), along), std::back_inserter(met));
  int left = 0;
  for (const auto& triangle : met) {
    left += triangle->supporting_plane().orthogonal_vector() * along > 0.0 ? 1 : -1;
  }
  return left != 0;
}

double CgalDistance::volume(double spacing) const {
  const CGAL::Bbox_3 box = tree_->tree.bbox();
  const Kernel::Vector_3 up(0.0, 0.0, 1.0);
  double length = 0.0;
  std::vector<Triangles::const_iterator> met;
  std::vector<std::pair<double, int>> walls;  // sorted by height: number of walls entered
  for (double x = box.xmin() + 0.517 * spacing; x < box.xmax(); x += spacing) {
    for (double y = box.ymin() + 0.483 * spacing; y < box.ymax(); y += spacing) {
      met.clear();
      walls.clear();
      const Point begin(x, y, box.zmin() - spacing);
      tree_->tree.all_intersected_primitives(Kernel::Ray_3(begin, up), std::back_inserter(met));
      for (const auto& triangle : met) {
        const Kernel::Vector_3 normal = triangle->supporting_plane().orthogonal_vector();
        const double steep = normal * up;
        if (steep == 0.0) continue;
        walls.emplace_back(normal * (triangle->vertex(0) - begin) / steep, steep < 0.0 ? 1 : -1);
      }
      std::sort(walls.begin(), walls.end());
      int winding = 0;
      for (std::size_t n = 0; n < walls.size(); ++n) {
        if (winding != 0) length += walls[n].first - walls[n - 1].first;
        winding += walls[n].second;
      }
    }
  }
  return length * spacing * spacing;
}

}  // namespace palpate::vdb::test
