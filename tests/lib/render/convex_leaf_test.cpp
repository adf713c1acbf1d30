// Which leaves are convex everywhere: all principal minors of the Hessian are checked, not only the
// determinant.

#include "render/convex_leaf.h"

#include <gtest/gtest.h>

#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

// Off the centers of the shapes below, so that every sampled place has a normal.
const Box3 kBox{Vec3(-0.031, -0.029, -0.033), Vec3(0.027, 0.031, 0.03)};
const Vec3 kTilted = glm::normalize(Vec3(0.3, -0.5, 0.8));

TEST(ConvexLeaf, BallsCylindersAndConesAre) {
  EXPECT_TRUE(isConvex(*sphere(Vec3(0.0), 0.02), kBox));
  EXPECT_TRUE(isConvex(*cylinder(Vec3(0.0), kTilted, 0.01, 1.0), kBox));
  EXPECT_TRUE(isConvex(*halfSpace(Vec3(0.0), kTilted), kBox));
}

// Signs of the curvatures (-, -, 0), (-, 0, 0) and (-, -, +): the determinants are possible for a
// convex leaf.
TEST(ConvexLeaf, WhatBendsInwardOneWayOrTwoIsNot) {
  EXPECT_FALSE(isConvex(*complement(sphere(Vec3(0.0), 0.02)), kBox));
  EXPECT_FALSE(isConvex(*complement(cylinder(Vec3(0.0), kTilted, 0.01, 1.0)), kBox));
  const auto is_quadric_convex = [](double xx, double yy, double zz, double xy, double yz,
                                    double xz) {
    return isConvex(
        *quadric(Vec3(0.0),
                 {.xx = xx, .yy = yy, .zz = zz, .xy = xy, .xz = xz, .yz = yz, .constant = -0.01}),
        kBox);
  };
  EXPECT_TRUE(is_quadric_convex(1, 2, 3, 0, 0, 0));
  EXPECT_FALSE(is_quadric_convex(1, -1, -1, 0, 0, 0));
  EXPECT_FALSE(is_quadric_convex(-1, 1, -1, 0, 0, 0));
  EXPECT_FALSE(is_quadric_convex(-1, -1, 1, 0, 0, 0));
  EXPECT_FALSE(is_quadric_convex(-1, 1, 1, 0, 0, 0));
  // No diagonal element is negative, but one minor is; the determinant is zero.
  EXPECT_FALSE(is_quadric_convex(1, 1, 0, 4, 0, 0));
  EXPECT_FALSE(is_quadric_convex(0, 1, 1, 0, 4, 0));
  EXPECT_FALSE(is_quadric_convex(1, 0, 1, 0, 0, 4));
  EXPECT_FALSE(isConvex(*torus(Vec3(0.0), kTilted, 0.02, 0.005), kBox));
}

}  // namespace
}  // namespace palpate
