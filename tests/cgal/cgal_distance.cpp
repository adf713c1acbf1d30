// The only file that includes CGAL, which takes long to compile.
#include "cgal/cgal_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
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
  // Along no plane of symmetry, so that edges are not met.
  const Kernel::Ray_3 ray(pointOf(p), Kernel::Vector_3(0.4711, 0.1742, 0.8646));
  return tree_->tree.number_of_intersected_primitives(ray) % 2 == 1;
}

double cgalVolume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += CGAL::volume(Point(CGAL::ORIGIN), pointOf(mesh.vertices[a]), pointOf(mesh.vertices[b]),
                        pointOf(mesh.vertices[c]));
  }
  return sum;
}

}  // namespace palpate::vdb::test
