// The checks that run before OpenVDB accept sound files, and follow them byte by byte.

#include "grid/vdb_walk.h"

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "fuzz/seeds.h"
#include "grid/vdb_archive.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/scan_folder.h"
#include "support/temp_file.h"

namespace palpate::vdb {
namespace {

void expectPasses(const std::string& bytes, const std::string& what) {
  SCOPED_TRACE(what);
  initializeOpenVdb();
  std::istringstream stream(bytes);
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  VdbArchive archive;
  ASSERT_NO_THROW(archive.open(stream));
  ASSERT_FALSE(archive.entries().empty());
  for (const VdbArchive::Entry& entry : archive.entries()) {
    if (entry.descriptor.isInstance()) continue;
    SCOPED_TRACE(entry.name());
    const std::string type = entry.descriptor.gridType();
    ASSERT_TRUE(VdbWalk::canWalk(type)) << type;
    // If the stream is read in order, open() has checked the trees too.
    if (entry.has_tree) continue;
    EXPECT_NO_THROW(VdbWalk(stream).checkTree(entry.descriptor.getGridPos(), type,
                                              entry.descriptor.saveFloatAsHalf(), true));
    EXPECT_NO_THROW((void)archive.readGridOf(stream, entry));
  }
}

TEST(VdbWalk, LetsEveryKindOfGridPassPackedInEveryWay) {
  int number = 0;
  for (const std::string& seed : fuzz::vdbSeeds()) {
    expectPasses(seed, "seed " + std::to_string(number++));
  }
}

TEST(VdbWalk, LetsAStreamWithoutOffsetsPass) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(1.0F);
  grid->setName("a");
  grid->fill(openvdb::CoordBBox(openvdb::Coord(-20), openvdb::Coord(20)), 0.5F);
  std::ostringstream out;
  openvdb::io::Stream(out).write(openvdb::GridCPtrVec{grid});
  expectPasses(out.str(), "stream");
}

TEST(VdbWalk, EveryShortenedFileIsRefusedBeforeOpenVdbReadsIt) {
  const std::string seed = fuzz::vdbSeeds().front();
  for (std::size_t size = 0; size < seed.size(); size += 1 + seed.size() / 97) {
    std::istringstream stream(seed.substr(0, size));
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    EXPECT_ANY_THROW(VdbWalk(stream).checkHeads()) << size;
  }
}

TEST(VdbWalk, AFileOfAnotherProgramPasses) {
  const std::string path = palpate::testing::scanPath("vdb/sphere.vdb");
  PALPATE_NEEDS_SCAN(path);
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  expectPasses(bytes.str(), path);
}

}  // namespace
}  // namespace palpate::vdb
