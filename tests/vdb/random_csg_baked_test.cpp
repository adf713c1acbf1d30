// Random constructive solid geometry in which some leaves are grids: at every tick the proxy is
// where an oracle that reads the same fields comes to rest.
//
// One scene by its number: PALPATE_CSG_FIRST=14 PALPATE_CSG_SCENES=1; more ticks:
// PALPATE_CSG_CONTACTS=300000.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/csg_run.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/vdb/bake.h"

namespace palpate::vdb {
namespace {

using palpate::test::CsgCounts;
using palpate::test::CsgFault;
using palpate::test::CsgRun;
using palpate::test::Random;
using palpate::test::RandomScene;
using palpate::test::randomScene;
using palpate::test::RandomSceneOptions;
using testing::Fault;

constexpr double kVoxel = 0.5e-3;  // [m]
constexpr double kBand = 12.0;     // [voxels] twice the distance of the hand from the proxy

long numberFrom(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : otherwise;
}

/// Replaces leaves of a tree by grids.
class LeafBaker {
 public:
  explicit LeafBaker(std::uint64_t seed) : random_(seed * 2 + 5) {}

  FieldPtr baked(const FieldPtr& field) {
    const FieldStructure structure = field->structure();
    using Kind = FieldStructure::Kind;
    std::vector<FieldPtr> operands;
    if (structure.kind != Kind::kLeaf && structure.kind != Kind::kFaces) {
      for (const FieldPtr& operand : structure.operands) operands.push_back(baked(operand));
    }
    switch (structure.kind) {
      case Kind::kUnion:
        return unite(std::move(operands));
      case Kind::kIntersection:
        return intersect(std::move(operands));
      case Kind::kComplement:
        return complement(operands.front());
      case Kind::kTransform:
        return place(operands.front(), structure.pose);
      case Kind::kFaces:
        return field;  // a leaf with edges stays as it is
      case Kind::kLeaf:
        break;
    }
    return random_.uniform(0.0, 1.0) < 0.7 ? grid(field) : field;
  }

  [[nodiscard]] int grids() const { return grids_; }

 private:
  /// A leaf that is unbounded, or that a grid cannot hold, stays analytic.
  FieldPtr grid(const FieldPtr& leaf) {
    const Box3 bounds = leaf->bounds();
    if (!isFinite(bounds.lo) || !isFinite(bounds.hi)) return leaf;
    BakeOptions options;
    options.voxel_size = kVoxel;
    options.half_width = kBand;
    try {
      FieldPtr out = gridField(bake(*leaf, options));
      ++grids_;
      return out;
    } catch (const Error&) {
      return leaf;
    }
  }

  Random random_;
  int grids_ = 0;
};

TEST(RandomCsgBaked, TheProxyIsWhereTheOracleIsThatReadsTheSameGrids) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const long wanted = numberFrom("PALPATE_CSG_CONTACTS", slow ? 1'000'000 : 4'000);
  const auto first = static_cast<std::uint64_t>(numberFrom("PALPATE_CSG_FIRST", 1));
  const long most_scenes = numberFrom("PALPATE_CSG_SCENES", 1'000'000);
  const int in_each = slow ? 1500 : 150;
  RandomSceneOptions options;
  options.deepest = 4;
  options.black_box_creases = false;  // a kink within a leaf differs between the leaf and its grid
  CsgCounts counts;
  int grids = 0;
  for (std::uint64_t number = first; counts.contacts < wanted && counts.scenes < most_scenes;
       ++number) {
    const RandomScene scene = randomScene(number, options);
    SceneDescription description = scene.description();
    LeafBaker baker(number);
    for (LayerDescription& layer : description.layers) {
      layer.inside = std::make_shared<FieldSource>(baker.baked(layer.inside->get()));
    }
    if (baker.grids() == 0) continue;
    grids += baker.grids();
    CsgRun(counts, in_each, 8 * in_each).run(scene, compile(description));
  }
  std::printf("%d grids; %s", grids, counts.text().c_str());
  for (const CsgFault& fault : counts.list) {
    std::printf("  scene %llu tick %d: %s, by %.3g, depth %.3g mm, %s\n",
                static_cast<unsigned long long>(fault.scene), fault.tick, nameOf(fault.fault),
                fault.off, 1e3 * fault.depth, fault.cause.c_str());
  }
  EXPECT_GE(counts.contacts, most_scenes < 1'000'000 ? 0 : wanted);
  EXPECT_GE(grids, counts.scenes);
  for (const Fault never : {Fault::kNotFinite, Fault::kRegion, Fault::kInside, Fault::kForce,
                            Fault::kContact, Fault::kStep, Fault::kFrozen}) {
    EXPECT_EQ(counts.of(never), 0) << nameOf(never);
  }
  // As for the trees without grids: 99.99 % at the minimum, and few ticks that cannot be judged.
  EXPECT_LE(counts.of(Fault::kPlace), 1 + counts.contacts / 10'000);
  EXPECT_LE(counts.ambiguous, 5 + counts.contacts / 1'000);
  EXPECT_LE(counts.unjudged, 5 + counts.contacts / 1'000);
}

}  // namespace
}  // namespace palpate::vdb
