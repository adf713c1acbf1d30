// .vdb files: written files are read back, other programs can read them, and damaged ones give
// named errors.

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "folders/folders.h"
#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/error_of.h"
#include "support/scan_folder.h"
#include "support/temp_file.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using palpate::testing::TempFolder;

LevelSet ball(const std::string& name, double radius = 6e-3) {
  BakeOptions options = voxels(0.5e-3, 3.0);
  options.name = name;
  options.metadata = {{"layer", "skin"}, {"frame", "RAS"}, {"tolerance", "0.1 mm"}};
  return bake(*sphere(Vec3(0.1e-3, 0.2e-3, 0.3e-3), radius), options);
}

void write(const std::string& path, const std::vector<LevelSet>& sets, bool overwrite = false) {
  writeVdb(path, sets, overwrite);
}

std::vector<std::string> namesIn(const TempFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

Error readError(const std::string& path, const std::string& name = "",
                const std::string& unit = "") {
  return errorOf([&] { static_cast<void>(readVdb(path, name, unit)); });
}

/// The output of a command on stdout; its status must be 0.
std::string outputOf(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot start " + command;
  std::string output;
  char chunk[4096];
  for (std::size_t got = 0; (got = fread(chunk, 1, sizeof chunk, pipe)) > 0;) {
    output.append(chunk, got);
  }
  EXPECT_EQ(pclose(pipe), 0) << command;
  return output;
}

TEST(VdbIo, ComesBackBitForBit) {
  const TempFolder folder;
  const std::string path = folder.path("a.vdb");
  const LevelSet first = ball("skin/surface"), second = ball("bone/surface", 4e-3);
  write(path, {first, second, first.named("copy", {{"note", "same voxels"}})});
  EXPECT_EQ(namesIn(folder), std::vector<std::string>{"a.vdb"});
  for (const LevelSet& written : {first, second}) {
    const LevelSet read = readVdb(path, written.info().name, "");
    const openvdb::FloatGrid& a = *written.impl().grid;
    const openvdb::FloatGrid& b = *read.impl().grid;
    EXPECT_TRUE(a.tree().hasSameTopology(b.tree()));
    EXPECT_EQ(a.background(), b.background());
    auto accessor = b.getConstAccessor();
    std::size_t different = 0;
    for (auto value = a.cbeginValueAll(); value; ++value) {
      different += accessor.getValue(value.getCoord()) != *value ? 1 : 0;
    }
    EXPECT_EQ(different, 0U);
    EXPECT_EQ(read.info().metadata, written.info().metadata);
    EXPECT_EQ(read.info().voxel_size, written.info().voxel_size);
    EXPECT_EQ(read.info().half_width, written.info().half_width);
    EXPECT_EQ(read.info().length_unit, "mm");
    EXPECT_EQ(read.info().active_voxels, written.info().active_voxels);
    EXPECT_EQ(read.info().bounds.lo, written.info().bounds.lo);
    EXPECT_EQ(b.transform(), a.transform());
  }
  EXPECT_EQ(readVdb(path, "copy", "").info().metadata.at("note"), "same voxels");
}

TEST(VdbIo, ListTellsWhatIsInAFile) {
  const TempFolder folder;
  const LevelSet skin = ball("skin/surface"), bone = ball("bone/surface", 4e-3);
  write(folder.path("a.vdb"), {skin, bone});
  const std::vector<VdbGridSummary> list = listVdb(folder.path("a.vdb"));
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1].name, "bone/surface");
  EXPECT_EQ(list[0].type, "FloatGrid");
  EXPECT_EQ(list[0].grid_class, "level set");
  EXPECT_EQ(list[0].info.active_voxels, skin.info().active_voxels);
  EXPECT_EQ(list[0].info.voxel_size, 0.5e-3);
  EXPECT_EQ(list[0].info.half_width, 3.0);
  EXPECT_EQ(list[0].info.bounds.hi, skin.info().bounds.hi);
  EXPECT_EQ(list[0].info.metadata.at("layer"), "skin");
  EXPECT_GT(list[0].info.memory, 0U);
}

TEST(VdbIo, NothingIsOverwrittenUnasked) {
  const TempFolder folder;
  const std::string path = folder.file("a.vdb", "something else");
  const Error error = errorOf([&] { write(path, {ball("a")}); });
  EXPECT_EQ(error.kind(), ErrorKind::kOperation);
  EXPECT_EQ(error.problem().code, "file.exists");
  EXPECT_EQ(std::filesystem::file_size(path), 14U);
  write(path, {ball("a")}, /*overwrite=*/true);
  EXPECT_EQ(readVdb(path, "a", "").info().name, "a");
  EXPECT_EQ(namesIn(folder).size(), 1U);
}

TEST(VdbIo, FullDiskAndMissingFolderLeaveNothing) {
  const TempFolder folder;
  const std::string nowhere = folder.path("no/folder/a.vdb");
  EXPECT_EQ(errorOf([&] { write(nowhere, {ball("a")}); }).kind(), ErrorKind::kOperation);
  // A limit on the size of files acts like a full disk if its signal is ignored.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const LevelSet set = ball("a");
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{1000}, rlim_t{30000}}) {
    const rlimit tight{bytes, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
    const Error error = errorOf([&] { write(folder.path("a.vdb"), {set}); });
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_EQ(error.kind(), ErrorKind::kOperation);
    EXPECT_EQ(error.problem().code, "vdb.write");
    EXPECT_TRUE(namesIn(folder).empty());
  }
  std::signal(SIGXFSZ, handler);
}

TEST(VdbIo, PythonReadsIt) {
  const TempFolder folder;
  const std::string path = folder.path("a.vdb");
  const LevelSet set = ball("skin/surface");
  write(path, {set, ball("bone/surface", 4e-3)});
  // These voxels are in the band, outside, far outside, and deep inside.
  const std::vector<Coord> voxels_asked{
      {12, 0, 0}, {-3, 11, 2}, {20, 0, 0}, {300, 0, 0}, {0, 0, 0}};
  std::string command = "/usr/bin/python3 '" + palpate::test::sourceFolder() +
                        "/tests/vdb/vdb_oracle.py' '" + path + "' skin/surface";
  for (const Coord& at : voxels_asked) {
    command += " ' " + std::to_string(at.x()) + "," + std::to_string(at.y()) + "," +
               std::to_string(at.z()) + "'";
  }
  std::istringstream lines(outputOf(command));
  std::map<std::string, std::string> told;
  std::size_t asked = 0;
  auto accessor = set.impl().grid->getConstAccessor();
  for (std::string key, rest; lines >> key && std::getline(lines >> std::ws, rest);) {
    if (key != "voxel_value") {
      told[key] = rest;
      continue;
    }
    ASSERT_LT(asked, voxels_asked.size());
    float value = 0.0F;
    const bool active = accessor.probeValue(voxels_asked[asked++], value);
    EXPECT_EQ(std::stof(rest), value);
    EXPECT_EQ(rest.back() == '1', active);
  }
  EXPECT_EQ(asked, voxels_asked.size());
  // Sorted by name here, because their order is not defined
  EXPECT_EQ(told["names"], "bone/surface,skin/surface");
  EXPECT_EQ(told["class"], "level set");
  EXPECT_EQ(told["type"], "FloatGrid");
  EXPECT_EQ(told["active"], std::to_string(set.info().active_voxels));
  EXPECT_EQ(told["voxel"], "0.5");
  EXPECT_EQ(told["background"], "1.5");
  EXPECT_EQ(told["length_unit"], "mm");
  EXPECT_EQ(told["frame"], "RAS");
  EXPECT_EQ(told["layer"], "skin");
  EXPECT_EQ(told["palpate:version"], set.info().metadata.at("palpate:version"));
}

TEST(VdbIo, VdbPrintReadsIt) {
  const TempFolder folder;
  const std::string path = folder.path("a.vdb");
  const LevelSet set = ball("skin/surface");
  write(path, {set});
  const std::string told = outputOf("vdb_print -l '" + path + "'");
  EXPECT_NE(told.find("skin/surface"), std::string::npos) << told;
  EXPECT_NE(told.find("level set"), std::string::npos);
  EXPECT_NE(told.find("length_unit: mm"), std::string::npos);
  EXPECT_NE(told.find(std::to_string(set.info().active_voxels)), std::string::npos);
}

/// Writes grids with OpenVDB's own File.
std::string foreign(const TempFolder& folder, const openvdb::GridPtrVec& grids) {
  const std::string path = folder.path("foreign.vdb");
  openvdb::io::File(path).write(grids);
  return path;
}

openvdb::FloatGrid::Ptr foreignBall() {
  initializeOpenVdb();
  auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.0F, openvdb::Vec3f(0.0F),
                                                                       0.5F, 3.0F);
  grid->setName("ball");
  return grid;
}

TEST(VdbIo, FilesOfOthersNeedALengthUnit) {
  const TempFolder folder;
  const std::string path = foreign(folder, {foreignBall()});
  const Error error = readError(path);
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().code, "vdb.no_unit");
  EXPECT_EQ(error.problem().file, path);
  EXPECT_NE(error.problem().hint.find("length_unit"), std::string::npos);
  const LevelSet set = readVdb(path, "", "cm");
  EXPECT_DOUBLE_EQ(set.info().voxel_size, 5e-3);
  const FieldPtr field = gridField(set);
  // Tolerance: the trilinear error for a sphere of 12 voxels is voxel^2 / 8 / r, a hundredth of the
  // voxel.
  EXPECT_NEAR(field->value(Vec3(61e-3, 0.0, 0.0)), 1e-3, 0.06e-3);
  EXPECT_EQ(readError(path, "", "parsec").problem().code, "unit.unknown");
  // A unit in the file is not overridden.
  auto with_unit = foreignBall();
  with_unit->insertMeta("length_unit", openvdb::StringMetadata("m"));
  EXPECT_EQ(readVdb(foreign(folder, {with_unit}), "", "mm").info().voxel_size, 0.5);
}

TEST(VdbIo, MovedGridsKeepTheirPlace) {
  const TempFolder folder;
  auto grid = foreignBall();
  auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  transform->postTranslate(openvdb::Vec3d(100.0, -20.0, 3.3));
  grid->setTransform(transform);
  const FieldPtr field = gridField(readVdb(foreign(folder, {grid}), "ball", "mm"));
  EXPECT_LT(field->value(Vec3(100e-3, -20e-3, 3.3e-3)), 0.0);
  EXPECT_NEAR(field->value(Vec3(106e-3, -20e-3, 3.3e-3)), 0.0, 0.01e-3);
  EXPECT_GT(field->value(Vec3(0.0)), 80e-3);
}

TEST(VdbIo, WhatIsNoSurfaceIsRefusedWithAReason) {
  const TempFolder folder;
  const auto refusal = [&](const openvdb::GridBase::Ptr& grid) {
    return readError(foreign(folder, {grid}), "", "mm").problem();
  };
  auto fog = foreignBall();
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(refusal(fog).code, "vdb.class");
  EXPECT_NE(refusal(fog).message.find("fog volume"), std::string::npos);
  EXPECT_FALSE(refusal(fog).hint.empty());
  auto unknown = foreignBall();
  unknown->setGridClass(openvdb::GRID_UNKNOWN);
  EXPECT_EQ(refusal(unknown).code, "vdb.class");
  const auto integers = openvdb::Int32Grid::create(0);
  integers->setName("labels");
  EXPECT_EQ(refusal(integers).code, "vdb.type");
  EXPECT_NE(refusal(integers).message.find("Int32Grid"), std::string::npos);
  EXPECT_EQ(refusal(openvdb::DoubleGrid::create(1.0)).code, "vdb.type");
  auto stretched = foreignBall();
  auto transform = openvdb::math::Transform::createLinearTransform();
  transform->preScale(openvdb::Vec3d(0.5, 0.5, 0.7));
  stretched->setTransform(transform);
  EXPECT_EQ(refusal(stretched).code, "vdb.transform");
  auto rotated = foreignBall();
  transform = openvdb::math::Transform::createLinearTransform(0.5);
  transform->postRotate(0.3, openvdb::math::Z_AXIS);
  rotated->setTransform(transform);
  EXPECT_EQ(refusal(rotated).code, "vdb.transform");
  auto narrow = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.0F, openvdb::Vec3f(0.0F),
                                                                         0.5F, 1.5F);
  EXPECT_EQ(refusal(narrow).code, "vdb.narrow");
  auto broken = foreignBall();
  broken->tree().setValue(Coord(12, 0, 0), std::nanf(""));
  EXPECT_EQ(refusal(broken).code, "vdb.not_finite");
  auto empty = openvdb::FloatGrid::create(3.0F);
  empty->setGridClass(openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(refusal(empty).code, "vdb.empty");
  for (const Problem& problem : {refusal(fog), refusal(narrow), refusal(empty), refusal(rotated)}) {
    EXPECT_EQ(problem.file, folder.path("foreign.vdb"));
  }
}

TEST(VdbIo, NamesChooseTheGrid) {
  const TempFolder folder;
  const std::string path = folder.path("a.vdb");
  write(path, {ball("a"), ball("b")});
  EXPECT_EQ(readError(path).problem().code, "vdb.which_grid");
  EXPECT_NE(readError(path).problem().hint.find("'a', 'b'"), std::string::npos);
  EXPECT_EQ(readError(path, "c").problem().code, "vdb.no_grid");
  EXPECT_EQ(readVdb(path, "b", "").info().name, "b");
}

TEST(VdbIo, HalfFloatsStreamsAndInstancesAreRead) {
  const TempFolder folder;
  auto half = foreignBall();
  half->setSaveFloatAsHalf(true);
  // Half floats keep 11 bits: 2^-11 of 1.5.
  EXPECT_NEAR(gridField(readVdb(foreign(folder, {half}), "", "mm"))->value(Vec3(7e-3, 0, 0)), 1e-3,
              1e-6);
  auto instance = foreignBall();
  auto copy = openvdb::gridPtrCast<openvdb::FloatGrid>(instance->copyGrid());
  copy->setName("copy");
  const LevelSet shared = readVdb(foreign(folder, {instance, copy}), "copy", "mm");
  EXPECT_EQ(shared.info().active_voxels, instance->activeVoxelCount());
  const std::string path = folder.path("stream.vdb");
  {
    std::ofstream out(path, std::ios::binary);
    openvdb::io::Stream(out).write({foreignBall()});
  }
  EXPECT_EQ(readVdb(path, "ball", "mm").info().active_voxels, instance->activeVoxelCount());
  EXPECT_EQ(listVdb(path).at(0).info.half_width, 3.0);
}

TEST(VdbIo, ListTellsOfOtherGridsToo) {
  const TempFolder folder;
  const auto labels = openvdb::Int32Grid::create(0);
  labels->setName("labels");
  labels->tree().setValue(Coord(1, 2, 3), 7);
  auto fog = foreignBall();
  fog->setName("density");
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  const auto list = listVdb(foreign(folder, {labels, fog, openvdb::Vec3SGrid::create()}));
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].type, "Int32Grid");
  EXPECT_EQ(list[0].grid_class, "unknown");
  EXPECT_EQ(list[0].info.active_voxels, 1U);
  EXPECT_EQ(list[1].grid_class, "fog volume");
  EXPECT_EQ(list[1].info.length_unit, "");
  EXPECT_EQ(list[2].type, "Vec3SGrid");
}

TEST(VdbIo, DamagedFilesAreErrorsNotCrashes) {
  const TempFolder folder;
  EXPECT_EQ(readError(folder.path("no.vdb")).problem().code, "vdb.missing");
  EXPECT_EQ(readError(folder.path()).problem().code, "vdb.unreadable");
  EXPECT_EQ(readError(folder.file("empty.vdb", "")).problem().code, "vdb.unreadable");
  EXPECT_EQ(readError(folder.file("text.vdb", "This is not a grid at all.")).problem().code,
            "vdb.unreadable");
  const std::string path = folder.path("a.vdb");
  BakeOptions options = voxels(1e-3, 2.0);
  write(path, {bake(*sphere(Vec3(0.0), 4e-3), options)});
  std::ifstream stream(path, std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_GT(good.size(), 500U);
  for (std::size_t size = 1; size < good.size(); size += 1 + good.size() / 60) {
    const std::string cut = folder.file("cut.vdb", std::string_view(good).substr(0, size));
    const Error error = readError(cut, "", "mm");
    EXPECT_EQ(error.problem().code, "vdb.unreadable") << size;
    EXPECT_EQ(error.problem().file, cut);
    EXPECT_THROW(static_cast<void>(listVdb(cut)), Error);
  }
  // A flipped bit in the origin of a node of the tree; origins are multiples of 4096.
  const std::string at_minus_4096("\x00\xF0\xFF\xFF", 4);
  int misplaced = 0;
  for (std::size_t at = 0; (at = good.find(at_minus_4096, at)) != std::string::npos; ++at) {
    std::string bad = good;
    bad[at + 1] = '\xF8';
    try {
      static_cast<void>(gridField(readVdb(folder.file("bad.vdb", bad), "", "mm")));
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::kInput) << error.what();
      const std::string& told = error.problem().message;
      misplaced += told.find("at a place where none can be") != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_GT(misplaced, 0);
  // Flipped bits in a voxel's value may go unnoticed, but may neither crash the reader nor change
  // the type.
  std::mt19937 random(3);
  // A damaged size can take a second and a gigabyte before it is refused, so that only a few are
  // tried by default.
#if defined(__SANITIZE_ADDRESS__)
  // OpenVDB then asks for terabytes. This test relies on operator new throwing; the sanitizer's
  // would end the process.
  const int damages = 0;
#else
  const int damages = std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 1500 : 150;
#endif
  int refused = 0;
  for (int i = 0; i < damages; ++i) {
    std::string bad = good;
    char& byte = bad[random() % (i % 2 == 0 ? bad.size() : std::size_t{700})];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << random() % 8));
    const std::string file = folder.file("bad.vdb", bad);
    try {
      static_cast<void>(gridField(readVdb(file, "", "mm")));
    } catch (const Error& error) {
      ++refused;
      ASSERT_EQ(error.kind(), ErrorKind::kInput) << error.what();
    }
  }
  if (damages > 0) {
    EXPECT_GT(refused, damages / 5);
  }
}

TEST(VdbIo, SampleOfOpenVdbReads) {
  const std::string path = palpate::testing::scanPath("vdb/sphere.vdb");
  PALPATE_NEEDS_SCAN(path);
  const LevelSet set = readVdb(path, "ls_sphere", "mm");
  EXPECT_NEAR(set.info().voxel_size, 0.05e-3, 1e-9);
  EXPECT_NEAR(set.info().half_width, 3.0, 0.01);
  // 125 voxels across with the band.
  EXPECT_NEAR(set.info().bounds.size().x, 124 * 0.05e-3, 1e-9);
  const FieldPtr field = gridField(set, Sampler::kAccessor);
  const double radius = 0.5 * set.info().bounds.size().x - 3.0 * 0.05e-3;
  const Vec3 center = set.info().bounds.center();
  for (const Vec3& u : {Vec3(1, 0, 0), Vec3(0, -0.6, 0.8), Vec3(0.48, 0.6, 0.64)}) {
    EXPECT_NEAR(field->value(center + u * radius), 0.0, 0.05e-3);
    EXPECT_NEAR(glm::dot(field->sample(center + u * radius).gradient, u), 1.0, 0.01);
  }
  EXPECT_LT(field->value(center), 0.0);
}

}  // namespace
}  // namespace palpate::vdb
