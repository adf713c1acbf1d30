// For each damaged file that once did harm: the answer of its reader now.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "fuzz/readers.h"
#include "fuzz/seeds.h"
#include "palpate/core/stop.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/mesh.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/dicom_writer.h"

namespace palpate::fuzz {
namespace {

using palpate::testing::TempFolder;

const std::vector<Find>& allFinds() {
  static const std::vector<Find> all = finds();
  return all;
}

const Find& findNamed(const std::string& name) {
  const auto found = std::find_if(allFinds().begin(), allFinds().end(),
                                  [&](const Find& find) { return find.name == name; });
  if (found == allFinds().end()) throw std::out_of_range(name);
  return *found;
}

/// The error of the reader for a find.
Problem answerTo(const std::string& name) {
  const Find& find = findNamed(name);
  const TempFolder folder;
  const Reader& reader = readerNamed(find.reader);
  const std::string path = folder.file(std::string("find") + reader.extension, find.bytes);
  const Error error = errorOf([&] { reader.read(path); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput) << error.what();
  EXPECT_FALSE(error.problem().hint.empty() && error.problem().message.empty());
  return error.problem();
}

TEST(Finds, AVdbChunkWhoseLengthIsOnesDoesNotOverwriteTheHeap) {
  const auto isOneOfThem = [](const Find& find) {
    return find.name.starts_with("vdb_blosc_length_ones");
  };
  EXPECT_EQ(std::count_if(allFinds().begin(), allFinds().end(), isOneOfThem), 7);
  for (const Find& find : allFinds()) {
    if (!isOneOfThem(find)) continue;
    EXPECT_EQ(answerTo(find.name).code, "vdb.unreadable") << find.name;
  }
  EXPECT_EQ(answerTo("vdb_blosc_length_all_ones").code, "vdb.unreadable");
  EXPECT_EQ(answerTo("vdb_blosc_length_below_zero").code, "vdb.unreadable");
  EXPECT_EQ(answerTo("vdb_blosc_head_beyond_its_chunk").code, "vdb.unreadable");
}

/// [bytes] The largest memory of this process so far.
std::int64_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

TEST(Finds, ATextOfGigabytesInAVdbFileTakesNoMemory) {
  const std::int64_t before = peakMemory();
  EXPECT_EQ(answerTo("vdb_text_of_gigabytes").code, "vdb.unreadable");
  EXPECT_EQ(answerTo("vdb_name_of_gigabytes").code, "vdb.unreadable");
  EXPECT_EQ(answerTo("vdb_blosc_length_of_gigabytes").code, "vdb.unreadable");
  // The file asks for three texts of 3 GB; finding the seeds alone takes some megabytes.
  EXPECT_LT(peakMemory() - before, std::int64_t{256} << 20U);
}

TEST(Finds, NoByteOfTheMetaInformationOfADicomFileEndsTheProcess) {
  int refused = 0;
  int met = 0;
  for (const Find& find : allFinds()) {
    if (!find.name.starts_with("dicom_meta_byte")) continue;
    ++met;
    refused += readBytes(readerNamed("dicom"), find.bytes) == Outcome::kRefused ? 1 : 0;
  }
  EXPECT_GE(met, 300);
  EXPECT_GT(refused, 10) << "some of these bytes are lengths and kinds";
}

TEST(Finds, AValueRepresentationThatIsNoneIsDamage) {
  const Problem problem = answerTo("dicom_vr_es");
  EXPECT_EQ(problem.code, "dicom.damaged");
  EXPECT_NE(problem.message.find("at byte"), std::string::npos);
}

TEST(Finds, BracketsWithoutEndInGltfAreCountedBeforeAnybodyFollowsThem) {
  EXPECT_EQ(answerTo("gltf_deep_brackets").code, "mesh.unreadable");
  EXPECT_NE(answerTo("gltf_deep_braces").message.find("deeper"), std::string::npos);
}

TEST(Finds, NoPromisedLengthOfAGlbFileHidesItsPartsFromTheGuard) {
  for (const char* name :
       {"glb_promises_1", "glb_promises_12", "glb_promises_19", "glb_promises_its_first_part"}) {
    EXPECT_EQ(answerTo(name).code, "mesh.truncated") << name;
  }
}

TEST(Finds, PackedDataThatUnpackToFarMoreThanTheHeaderSaysAreRefused) {
  EXPECT_EQ(answerTo("gz_that_unpacks_to_far_more").code, "nifti.size");
}

TEST(Finds, AHundredThousandLayersAreRefusedByTheirNumber) {
  EXPECT_EQ(answerTo("yaml_100000_layers").code, "document.size");
  // Few enough layers to be read as YAML, too many for the data kept for each pair of regions.
  const Problem problem = answerTo("yaml_5000_layers");
  EXPECT_EQ(problem.code, "scene.length");
  EXPECT_NE(problem.message.find("5000"), std::string::npos) << problem.message;
  EXPECT_NE(problem.message.find("4096"), std::string::npos) << problem.message;
  EXPECT_EQ(answerTo("yaml_four_million_numbers").code, "document.size");
}

std::string polygon(int corners) {
  std::string vertices;
  std::string face = "f";
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * 3.14159265358979323846 * i / corners;
    char line[80];
    std::snprintf(line, sizeof line, "v %.17g %.17g 0\n", std::cos(angle), std::sin(angle));
    vertices += line;
    face += " " + std::to_string(i + 1);
  }
  return vertices + face + "\n";
}

TEST(Finds, AConvexFaceOfManyCornersIsCutAtOnceAndAnyOtherWithinBounds) {
  // The time to find ears grows with the square of the corners for a convex face, and with the cube
  // for the worst one. Beyond some ten thousand corners the turns of a regular polygon vanish in
  // rounding.
  const TempFolder folder;
  const vdb::Mesh mesh = vdb::readMesh(folder.file("disc.obj", polygon(9000)), 1.0);
  EXPECT_EQ(mesh.triangles.size(), 8998U);
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 *
            glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]).z;
  }
  EXPECT_NEAR(area, 3.14159265358979323846, 1e-6);  // pi minus 2 pi^3 / (3 n^2)
  EXPECT_EQ(answerTo("obj_comb_of_60000_corners").code, "mesh.polygon");
}

TEST(Finds, AnElementOfNothingIsPassedOverHoweverManyThereAre) {
  const TempFolder folder;
  const Find& find = findNamed("ply_elements_of_nothing");
  EXPECT_EQ(vdb::readMesh(folder.file("a.ply", find.bytes), 1.0).triangles.size(), 1U);
}

TEST(Finds, NamesInLatin1BecomeUtf8) {
  const TempFolder folder;
  const vdb::LabelTable table =
      vdb::readLabelTable(folder.file("a.txt", findNamed("labels_in_latin_1").bytes));
  EXPECT_EQ(table.names.at(1), "l\xC3\xA9sion");
  EXPECT_EQ(table.names.at(2), "k\xC3\xB6rper");
  // UTF-8 text stays as it is, including parts of it that look like Latin-1.
  EXPECT_EQ(vdb::readLabelTable(folder.file("b.txt", "1 l\xC3\xA9sion 1 2 3 4\n")).names.at(1),
            "l\xC3\xA9sion");
  // Overlong and truncated forms are not UTF-8.
  EXPECT_EQ(vdb::readLabelTable(folder.file("c.txt", "1 a\xC0\xAF\n")).names.at(1),
            "a\xC3\x80\xC2\xAF");
}

TEST(Finds, PipesAreNotWaitedFor) {
  const TempFolder folder;
  for (const char* name : {"a.nii", "a.nrrd", "a.mha", "a.dcm", "a.stl", "a.obj", "a.ply", "a.vtk",
                           "a.glb", "a.vdb", "a.txt"}) {
    const std::string path = folder.path(name);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const std::string extension = std::filesystem::path(name).extension();
    for (const Reader& reader : readers()) {
      if (reader.extension != extension) continue;
      EXPECT_EQ(errorOf([&] { reader.read(path); }).kind(), ErrorKind::kInput) << name;
    }
  }
}

/// A mesh with one vertex many times, and one face.
std::string many(std::string_view kind, int vertices) {
  std::string points;
  for (int i = 0; i < vertices; ++i) points += std::to_string(i) + " 0 0\n";
  const std::string count = std::to_string(vertices);
  if (kind == "vtk") {
    return "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS " + count + " float\n" +
           points + "POLYGONS 1 4\n3 0 1 2\n";
  }
  if (kind == "ply") {
    return "ply\nformat ascii 1.0\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n" +
           points + "3 0 1 2\n";
  }
  std::string facets;
  for (int i = 0; i < vertices; ++i) {
    facets += "facet normal 0 0 1\nouter loop\nvertex 0 0 " + std::to_string(i) +
              "\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  }
  return "solid a\n" + facets + "endsolid a\n";
}

/// The user asks to stop before the work begins: a reader that polls within the first bytes of the
/// file ends there.
TEST(Finds, EveryReaderStopsWhenItIsAskedTo) {
  const std::atomic<bool> stop{true};
  struct Watch {
    explicit Watch(const std::atomic<bool>* flag) { watchStopFlag(flag); }
    ~Watch() { watchStopFlag(nullptr); }
  };
  const TempFolder folder;
  for (const char* name : {"nifti_gz", "nrrd", "metaimage", "dicom", "obj", "stl", "ply", "vtk",
                           "gltf", "vdb", "labels"}) {
    const Reader& reader = readerNamed(name);
    // Readers poll every thousand items, so the file must have as many.
    std::string bytes = seedsOf(name).front();
    if (std::string_view(name) == "obj") bytes = polygon(3000);
    if (std::string_view(name) == "stl" || std::string_view(name) == "ply" ||
        std::string_view(name) == "vtk") {
      bytes = many(name, 3000);
    }
    const std::string path = folder.file(std::string(name) + reader.extension, bytes);
    const Watch watch(&stop);
    EXPECT_EQ(errorOf([&] { reader.read(path); }).kind(), ErrorKind::kCancelled) << name;
  }
}

}  // namespace
}  // namespace palpate::fuzz
