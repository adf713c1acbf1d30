// Every bad input gives one clear error and exit 3, and leaves no file behind.

#include <cstring>

#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

using vdb::test::Bytes;
using vdb::test::NiftiFile;

std::string asText(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string truncated(const Bytes& bytes) {
  const std::string text = asText(bytes);
  return text.substr(0, text.size() - 20);
}

NiftiFile fourDimensional() {
  NiftiFile file;
  file.dim = {4, 5, 6, 3};
  return file;
}

std::string binaryStl(float first_coordinate) {
  std::string text(84 + 50, '\0');
  text[80] = 1;
  std::memcpy(text.data() + 84 + 12, &first_coordinate, sizeof first_coordinate);
  const float one = 1.0F;
  std::memcpy(text.data() + 84 + 24, &one, sizeof one);
  std::memcpy(text.data() + 84 + 40, &one, sizeof one);
  return text;
}

std::string scene(const std::string& layers, const std::string& ports) {
  return "palpate: 1\nlength: mm\nfields:\n"
         "  a: {sphere: {center: [0, 0, 0], radius: 10}}\n"
         "  b: {sphere: {center: [50, 0, 0], radius: 10}}\n"
         "materials:\n  m: {stiffness: 100 N/m}\nlayers:\n" +
         layers + (ports.empty() ? "" : "ports:\n" + ports);
}

struct Bad {
  std::string name;
  std::string file;
  std::string content;                 // "" with no file: the file is missing
  std::vector<std::string> arguments;  // FILE stands for the path
  std::vector<std::string> says;       // parts of the message
};

const std::string kLayers =
    "  - {name: first, inside: a, wall: m}\n  - {name: second, inside: b, wall: m}\n";

std::vector<Bad> badInputs() {
  const std::vector<std::string> threshold = {"bake", "FILE", "-o", "out.vdb", "--above", "1"};
  const std::vector<std::string> bake = {"bake", "FILE", "-o", "out.vdb", "--voxel", "0.1"};
  const std::vector<std::string> touch = {"touch",  "FILE",    "--press",
                                          "0,0,10", "--trace", "out.csv"};
  const std::vector<std::string> mesh = {"bake", "FILE", "-o", "out.vdb", "--units", "mm"};
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  return {
      {"NiftiMissing", "missing.nii.gz", "", threshold, {"missing.nii.gz"}},
      {"NiftiTruncated", "cut.nii", truncated(bytesOf(NiftiFile{})), threshold, {"cut.nii"}},
      {"NiftiGzTruncated",
       "cut.nii.gz",
       truncated(vdb::test::gzipped(bytesOf(NiftiFile{}))),
       threshold,
       {"cut.nii.gz"}},
      {"NiftiFourDimensional",
       "four.nii",
       asText(bytesOf(fourDimensional())),
       threshold,
       {"four.nii"}},
      {"NiftiIsText", "note.nii", "this is not an image at all", threshold, {"note.nii"}},
      {"MeshMissing", "missing.stl", "", mesh, {"missing.stl"}},
      {"MeshWithoutFaces", "points.obj", vertices, mesh, {"points.obj"}},
      {"MeshOpen",
       "open.obj",
       vertices + "f 1 2 3\nf 1 2 4\n",
       mesh,
       {"open.obj", "1 hole", "mm across at (", "--sign winding", "--shell"}},
      {"MeshNan", "nan.stl", binaryStl(std::numeric_limits<float>::quiet_NaN()), mesh, {"nan.stl"}},
      {"MeshIndex", "index.obj", vertices + "f 1 2 99\n", mesh, {"index.obj"}},
      {"SceneMissing", "missing.yaml", "", touch, {"missing.yaml"}},
      {"SceneIsNotYaml", "bad.yaml", "palpate: [1\n", touch, {"bad.yaml"}},
      {"SceneUnknownUnit",
       "unit.yaml",
       "palpate: 1\nlength: furlong\nlayers: []\n",
       touch,
       {"unit.yaml:2:", "furlong"}},
      {"SceneQuantityWithoutUnit",
       "plain.yaml",
       "palpate: 1\nlength: mm\nmaterials:\n  m: {stiffness: 100}\nlayers: []\n",
       touch,
       {"plain.yaml:4:", "100"}},
      {"SceneUnknownLayer",
       "layer.yaml",
       scene(kLayers, "  - {name: p, between: [outside, frist]}\n"),
       touch,
       {"layer.yaml:12:", "frist", "first"}},
      {"SceneUnknownPort",
       "port.yaml",
       scene(kLayers, "  - {name: p, between: [outside, first], after: [q]}\n"),
       touch,
       {"port.yaml:12:", "q"}},
      {"ScenePortWithoutContact",
       "apart.yaml",
       scene(kLayers, "  - {name: p, between: [first, second]}\n"),
       touch,
       {"apart.yaml:12:", "do not touch"}},
      {"SceneImageMissing",
       "image.yaml",
       "palpate: 1\nlength: mm\nimages:\n  i: {file: nothing.nii}\nlayers:\n"
       "  - {name: l, threshold: {image: i, above: 1}}\n",
       touch,
       {"image.yaml", "nothing.nii"}},
      {"UnboundedLayer",
       "endless.yaml",
       "palpate: 1\nlength: mm\nfields:\n  h: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}\n"
       "layers:\n  - {name: ground, inside: h}\n",
       bake,
       {"endless.yaml", "reaches to infinity"}},
      {"PathWithoutHeader",
       "path.csv",
       "0,0,0,0\n",
       {"touch", scenePath("container.yaml"), "--path", "FILE", "--trace", "out.csv"},
       {"path.csv:1"}},
      {"PathRunsBackwards",
       "path.csv",
       "t,x,y,z\n0,0,0,0\n0.002,0,0,0\n0.001,0,0,0\n",
       {"touch", scenePath("container.yaml"), "--path", "FILE", "--trace", "out.csv"},
       {"path.csv:4"}},
      {"TraceIsNone",
       "trace.csv",
       "t,x,y,z\n0,0,0,0\n",
       {"render", scenePath("container.yaml"), "-o", "out.png", "--trace", "FILE"},
       {"trace.csv:1"}},
      {"PointsWithAWord",
       "points.csv",
       "x,y,z\n1,2,three\n",
       {"query", scenePath("container.yaml"), "--points", "FILE"},
       {"points.csv:2", "three"}},
      {"VdbIsText", "grid.vdb", "not a grid", {"info", "FILE"}, {"grid.vdb"}},
      {"UnknownKind", "file.xyz", "?", {"info", "FILE"}, {"file.xyz", ".nii.gz"}},
      {"UnknownField",
       "field.yaml",
       scene(kLayers, ""),
       {"query", "FILE", "--at", "0,0,0", "--field", "secnod"},
       {"secnod", "second"}},
  };
}

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadInput : public ::testing::TestWithParam<Bad> {};

TEST_P(BadInput, OneClearErrorExitThreeNothingLeft) {
  const Bad& bad = GetParam();
  const TempFolder folder;
  if (!bad.content.empty()) (void)folder.file(bad.file, bad.content);
  const auto before = filesIn(folder.path());
  std::vector<std::string> arguments = bad.arguments;
  for (std::string& argument : arguments) {
    if (argument == "FILE") argument = bad.file;
  }
  const CommandResult text = runPalpate(arguments, folder.path());
  EXPECT_EQ(text.exit_code, 3) << text.out << text.err;
  EXPECT_EQ(text.out, "");
  const auto lines = linesOf(text.err);
  EXPECT_EQ(
      std::count_if(lines.begin(), lines.end(),
                    [](const std::string& l) { return l.find("error: ") != std::string::npos; }),
      1)
      << text.err;
  for (const std::string& part : bad.says) {
    EXPECT_NE(text.err.find(part), std::string::npos) << "'" << part << "' in\n" << text.err;
  }
  EXPECT_EQ(filesIn(folder.path()), before);

  arguments.emplace_back("--json");
  const CommandResult result = runPalpate(arguments, folder.path());
  EXPECT_EQ(result.exit_code, 3);
  Json json = parseOnly(result);
  EXPECT_EQ(json["schema"], "palpate.error/1");
  EXPECT_FALSE(json["error"]["message"].get<std::string>().empty());
  EXPECT_EQ(filesIn(folder.path()), before);
}

INSTANTIATE_TEST_SUITE_P(All, BadInput, ::testing::ValuesIn(badInputs()),
                         [](const auto& test) { return test.param.name; });

TEST(BadInputJson, PlacesAreNumbers) {
  const TempFolder folder;
  const std::string file = folder.file("u.yaml", "palpate: 1\nlength: furlong\nlayers: []\n");
  Json json = parseOnly(runPalpate({"explain", file, "--json"}));
  EXPECT_EQ(json["error"]["file"], file);
  EXPECT_EQ(json["error"]["line"], 2);
  EXPECT_EQ(json["error"]["column"], 9);
}

}  // namespace
}  // namespace palpate::testing
