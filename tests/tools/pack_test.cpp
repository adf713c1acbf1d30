// palpate pack: a scene with its grids in one folder, which feels the same at another place and
// without its scan.

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

#include "tools/kept_felt.h"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

/// Every file below a folder, by its name relative to it.
std::vector<std::string> allFiles(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      names.push_back(entry.path().lexically_relative(folder).string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

CommandResult pack(const TempFolder& folder, std::vector<std::string> more) {
  more.insert(more.begin(), "pack");
  return runPalpate(more, folder.path());
}

TEST(PackedScenes, AreFeltTheSameElsewhereAndWithoutTheirScan) {
  const TempFolder folder;
  importLimb(folder);
  // Absolute names, as import writes them for a scan elsewhere; also in a comment.
  std::string text = textOf(folder.path("limb.yaml"));
  const std::string name = "limb.nii.gz";
  text.replace(text.rfind(name), name.size(), folder.path(name));
  (void)folder.file("limb.yaml", "# From " + folder.path(name) + ", by hand.\n" + text);
  const Felt before = feltIn(folder, "limb.yaml", "a.csv");
  ASSERT_GT(before.ticks.size(), 100U) << before.result.err << before.result.out;

  const CommandResult packed = pack(folder, {"limb.yaml", "-o", "limb.bundle", "--json"});
  ASSERT_EQ(packed.exit_code, 0) << packed.err << packed.out;
  const Json json = parseOnly(packed);
  EXPECT_EQ(json.at("schema"), "palpate.pack/1");
  EXPECT_EQ(json.at("grids").size(), 3U);
  const std::vector<std::string> files = allFiles(folder.path("limb.bundle"));
  for (const char* there :
       {"scene.yaml", "pack.json", "files/names.csv", "files/scan_1.scan.yaml"}) {
    EXPECT_NE(std::find(files.begin(), files.end(), there), files.end()) << there;
  }
  for (const std::string& file : files) {
    EXPECT_FALSE(file.ends_with("nii.gz")) << file;
    // No file in the bundle contains the path where it was made.
    const std::string bytes = textOf(folder.path("limb.bundle/" + file));
    EXPECT_EQ(bytes.find(folder.path()), std::string::npos) << file;
  }
  // Remarks of the import on the origin of numbers are kept.
  EXPECT_NE(textOf(folder.path("limb.bundle/scene.yaml")).find("assumed"), std::string::npos);

  // Another place, with all original files gone.
  const TempFolder elsewhere;
  fs::rename(folder.path("limb.bundle"), elsewhere.path("moved"));
  for (const char* gone : {"limb.yaml", "limb.nii.gz", "names.csv"}) fs::remove(folder.path(gone));
  for (const char* scene : {"moved", "moved/scene.yaml", "moved/"}) {
    const Felt after = feltIn(elsewhere, scene, "b.csv", {"--no-cache"});
    ASSERT_EQ(after.result.exit_code, 0) << scene << after.result.err << after.result.out;
    EXPECT_EQ(after.made, 0U) << scene;
    EXPECT_EQ(after.kept, 3U) << scene;
    EXPECT_EQ(after.ticks, before.ticks) << scene;
  }
  // Every other verb that takes a scene.
  const std::vector<std::vector<std::string>> verbs = {
      {"query", "moved", "--at", "12,-7,30"},
      {"explain", "moved"},
      {"render", "moved", "-o", "moved.png"},
      {"check", "moved"},
      {"info", "moved"},
      {"report", "moved", "-o", "moved.html"},
      {"bake", "moved", "-o", "moved.vdb"},
      {"accuracy", "moved", "--field", "femur", "--voxel", "3", "--points", "100"},
      {"touch", "moved", "--press", "34,-7,30", "--normal", "1,0,0", "--record", "moved.npy",
       "--image", "touch.png"},
      {"replay", "moved.npy"}};
  for (const std::vector<std::string>& arguments : verbs) {
    const CommandResult result = runPalpate(arguments, elsewhere.path());
    EXPECT_EQ(result.exit_code, 0) << arguments[0] << ": " << result.err << result.out;
  }
  // A bundle cannot be packed again, because its scene has lost the scan.
  EXPECT_EQ(pack(elsewhere, {"moved", "-o", "again"}).exit_code, 3);
}

TEST(PackedScenes, TakeMeshesGridsTablesAndScansOfMaterialsAlong) {
  const TempFolder folder;
  const vdb::test::Limb limb;
  fs::create_directories(folder.path("in/deep"));
  (void)vdb::test::writeNrrd(limb.scan(vdb::test::obliqueAxes(Vec3(2.0), 0.3)), folder,
                             "in/ct.nrrd");
  (void)vdb::test::writeNifti(limb.labels(vdb::test::obliqueAxes(Vec3(1.5))), folder,
                              "in/deep/limb.nii.gz");
  (void)folder.file("in/deep/names.csv", "value,name\n1,femur\n2,muscle\n3,fat\n");
  const std::string octahedron =
      "v 3 0 0\nv -3 0 0\nv 0 3 0\nv 0 -3 0\nv 0 0 3\nv 0 0 -3\n"
      "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
  (void)folder.file("stone.obj", octahedron);
  (void)folder.file("in/stone.obj", octahedron);  // the same name as the other file
  (void)folder.file("ball.yaml", kContainer);
  (void)run(folder, {"bake", "ball.yaml", "-o", "ball.vdb", "--voxel", "2", "--json"});
  (void)folder.file("all.yaml", R"(palpate: 1
length: mm
images:
  seg: {file: in/deep/limb.nii.gz, names: 'in/deep/names.csv'}   # labels
  ct: {file: "in/ct.nrrd"}
materials:
  flesh: {stiffness: {image: ct, transfer: [[-100, 100 N/m], [1000, 900 N/m]]}}
  plain: {stiffness: 500 N/m}
layers:
  - {name: skin, threshold: {image: ct, above: -500}, wall: flesh}
  - {name: bone, labels: {image: seg, match: [femur]}, wall: plain}
  - {name: one, inside: {transform: {field: {mesh: {file: stone.obj, voxel: 0.5}}, translate: [60, 0, 0]}}, wall: plain}
  - {name: two, inside: {transform: {field: {mesh: {file: in/stone.obj}}, translate: [80, 0, 0]}}, wall: plain}
  - {name: three, inside: {transform: {field: {grid: {file: ball.vdb}}, translate: [200, 0, 0]}}, wall: plain}
ports:
  - {name: in, between: [outside, skin], opens_at: 0.5 N}
)");
  const Felt before = feltIn(folder, "all.yaml", "a.csv");
  ASSERT_GT(before.ticks.size(), 100U) << before.result.err << before.result.out;
  const CommandResult packed = pack(folder, {"all.yaml", "-o", "all"});
  ASSERT_EQ(packed.exit_code, 0) << packed.err << packed.out;
  EXPECT_NE(packed.out.find("ct.nrrd: copied, as a material reads it"), std::string::npos);
  EXPECT_NE(packed.out.find("limb.nii.gz: not in it"), std::string::npos);
  EXPECT_NE(textOf(folder.path("all/scene.yaml")).find("# labels"), std::string::npos);
  const TempFolder elsewhere;
  fs::rename(folder.path("all"), elsewhere.path("all"));
  for (const char* gone : {"in", "stone.obj", "ball.vdb"}) fs::remove_all(folder.path(gone));
  const Felt after = feltIn(elsewhere, "all", "a.csv");
  ASSERT_EQ(after.result.exit_code, 0) << after.result.err << after.result.out;
  EXPECT_EQ(after.ticks, before.ticks);
}

/// The answers of a query at some points: in both meshes, in bone and flesh, and far from all.
std::string answersOf(const TempFolder& folder, const std::string& scene) {
  const CommandResult result =
      runPalpate({"query", scene, "--at", "60,0,0", "61.9,0,0", "80,1,0", "12,-7,30", "20,-7,30",
                  "200,0,0", "--quiet", "--no-cache"},
                 folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  for (const char* region : {"bone", "flesh", "one", "two", "outside"}) {
    EXPECT_NE(result.out.find(region), std::string::npos) << region << ": " << result.out;
  }
  return result.out;
}

TEST(PackedScenes, TakeBuffersOfMeshesAndFoldersOfMasksAlong) {
  const TempFolder folder;
  const vdb::test::Limb limb;
  fs::create_directories(folder.path("masks"));
  fs::create_directories(folder.path("in/buffers"));
  const vdb::Image labels = limb.labels(vdb::test::obliqueAxes(Vec3(2.0)));
  for (const auto& [label, name] :
       {std::pair(1.0F, "bone"), std::pair(2.0F, "muscle"), std::pair(3.0F, "fat")}) {
    vdb::Image mask = labels;
    for (float& value : mask.values) value = value == label ? 1.0F : 0.0F;
    (void)vdb::test::writeNifti(mask, folder, std::string("masks/") + name + ".nii.gz");
  }
  // A mesh whose numbers lie in a file of their own, and one that names a file of colors.
  const std::array<std::uint16_t, 24> faces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                               2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const std::array<float, 18> corners = {0.003F,  0, 0, -0.003F, 0,      0, 0, 0.003F, 0, 0,
                                         -0.003F, 0, 0, 0,       0.003F, 0, 0, -0.003F};
  std::string bytes(sizeof faces + sizeof corners, '\0');
  std::memcpy(bytes.data(), faces.data(), sizeof faces);
  std::memcpy(bytes.data() + sizeof faces, corners.data(), sizeof corners);
  (void)folder.file("in/buffers/stone.bin", bytes);
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)"
      R"("buffers":[{"byteLength":120,"uri":"buffers/stone.bin"}],)"
      R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
      R"({"buffer":0,"byteOffset":48,"byteLength":72}],"accessors":[)"
      R"({"bufferView":0,"componentType":5123,"count":24,"type":"SCALAR"},)"
      R"({"bufferView":1,"componentType":5126,"count":6,"type":"VEC3",)"
      R"("min":[-0.003,-0.003,-0.003],"max":[0.003,0.003,0.003]}]})";
  (void)folder.file("in/stone.gltf", gltf);
  (void)folder.file("in/colored.obj",
                    "mtllib colored.mtl\nv 3 0 0\nv -3 0 0\nv 0 3 0\nv 0 -3 0\nv 0 0 3\nv 0 0 -3\n"
                    "usemtl red\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\n"
                    "f 1 4 6\n");
  (void)folder.file("in/colored.mtl", "newmtl red\nKd 1 0 0\n");
  (void)folder.file("all.yaml", R"(palpate: 1
length: mm
images:
  seg: {file: masks/}
materials:
  plain: {stiffness: 500 N/m}
layers:
  - {name: bone, labels: {image: seg, match: [bone]}, wall: plain}
  - {name: flesh, labels: {image: seg, match: [muscle, fat]}, wall: plain}
  - {name: one, inside: {transform: {field: {mesh: {file: in/stone.gltf, voxel: 0.5}}, translate: [60, 0, 0]}}, wall: plain}
  - {name: two, inside: {transform: {field: {mesh: {file: in/colored.obj, voxel: 0.5}}, translate: [80, 0, 0]}}, wall: plain}
)");
  const std::string before = answersOf(folder, "all.yaml");
  const CommandResult packed = pack(folder, {"all.yaml", "-o", "all"});
  ASSERT_EQ(packed.exit_code, 0) << packed.err << packed.out;
  EXPECT_NE(packed.out.find("masks: not in it"), std::string::npos) << packed.out;
  const TempFolder elsewhere;
  fs::rename(folder.path("all"), elsewhere.path("all"));
  for (const char* gone : {"in", "masks"}) fs::remove_all(folder.path(gone));
  EXPECT_EQ(answersOf(elsewhere, "all"), before);
  const std::vector<std::string> files = allFiles(elsewhere.path("all/files"));
  EXPECT_NE(std::find(files.begin(), files.end(), "mesh_1/buffers/stone.bin"), files.end());

  // A mesh that names a file outside of its own folder cannot be packed.
  fs::create_directories(folder.path("in"));
  (void)folder.file("stone.bin", bytes);
  std::string other = gltf;
  other.replace(other.find("buffers/stone.bin"), 17, "../stone.bin");
  (void)folder.file("in/stone.gltf", other);
  (void)folder.file("one.yaml",
                    "palpate: 1\nlength: mm\nlayers:\n"
                    "  - {name: one, inside: {mesh: {file: in/stone.gltf, voxel: 0.5}}}\n");
  const CommandResult refused = pack(folder, {"one.yaml", "-o", "one"});
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_NE(refused.err.find("another folder than its own"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(folder.path("one")));
}

TEST(PackedScenes, SayWhatTheyDoNotHold) {
  const TempFolder folder;
  importLimb(folder, 2.5);
  ASSERT_EQ(pack(folder, {"limb.yaml", "-o", "limb"}).exit_code, 0);
  fs::remove(folder.path("limb.nii.gz"));
  // A layer that was added after packing has no grid in the bundle.
  std::string text = textOf(folder.path("limb/scene.yaml"));
  const std::size_t layers = text.find("\nlayers:");
  ASSERT_NE(layers, std::string::npos);
  const std::size_t image = text.find("labels: {image: ", layers);
  const std::string name = text.substr(image + 16, text.find(',', image) - image - 16);
  (void)folder.file("limb/scene.yaml", text + "\n");
  text.insert(text.find('\n', layers + 1),
              "\n  - {name: more, labels: {image: " + name + ", match: [2, 3]}}");
  (void)folder.file("limb/edited.yaml", text);
  const CommandResult edited = runPalpate({"explain", "limb/edited.yaml"}, folder.path());
  EXPECT_EQ(edited.exit_code, 3) << edited.err << edited.out;
  EXPECT_NE(edited.err.find("not in the bundle"), std::string::npos) << edited.err;
  // A picture needs the scan, which is gone.
  const CommandResult drawn =
      runPalpate({"render", "limb", "-o", "a.png", "--image", name}, folder.path());
  EXPECT_EQ(drawn.exit_code, 3) << drawn.err;
  // A damaged grid cannot be made again, and is not felt.
  for (const std::string& file : filesIn(folder.path("limb/grids"))) {
    if (!file.ends_with(".vdb")) continue;
    std::string bytes = textOf(folder.path("limb/grids/" + file));
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    (void)folder.file("limb/grids/" + file, bytes);
  }
  EXPECT_EQ(runPalpate({"explain", "limb"}, folder.path()).exit_code, 3);
}

TEST(PackedScenes, ReplaceNothingButBundlesAndLeaveNothingHalfWritten) {
  const TempFolder folder;
  importLimb(folder, 2.5);
  fs::create_directory(folder.path("photos"));
  (void)folder.file("photos/cat.jpg", "cat");
  (void)folder.file("a.file", "text");
  for (const char* taken : {"photos", "a.file", "photos/"}) {
    EXPECT_EQ(pack(folder, {"limb.yaml", "-o", taken}).exit_code, 1) << taken;
    EXPECT_EQ(pack(folder, {"limb.yaml", "-o", taken, "--force"}).exit_code, 1) << taken;
  }
  EXPECT_EQ(textOf(folder.path("photos/cat.jpg")), "cat");
  EXPECT_EQ(pack(folder, {"limb.yaml", "-o", "no/such/folder"}).exit_code, 1);
  EXPECT_EQ(pack(folder, {"limb.yaml"}).exit_code, 2);
  EXPECT_EQ(pack(folder, {"limb.nii.gz", "-o", "out"}).exit_code, 2);
  (void)folder.file("broken.yaml", "palpate: 1\nlength: mm\nlayers:\n  - {name: a}\n");
  EXPECT_EQ(pack(folder, {"broken.yaml", "-o", "out"}).exit_code, 3);
  const std::vector<std::string> before = filesIn(folder.path());
  const TempFolder large;
  importLimb(large, 0.5);
  const std::vector<std::string> there = filesIn(large.path());
  (void)runInterrupted({"pack", "limb.yaml", "-o", "out"}, large.path());
  EXPECT_EQ(filesIn(large.path()), there) << "nothing is left of what failed";

  ASSERT_EQ(pack(folder, {"limb.yaml", "-o", "out"}).exit_code, 0);
  EXPECT_EQ(pack(folder, {"limb.yaml", "-o", "out"}).exit_code, 1);
  for (const char* own : {"out/notes.txt", "out/files/mine.yaml", "out/grids/more/copy.vdb"}) {
    fs::create_directories(fs::path(folder.path(own)).parent_path());
    (void)folder.file(own, "of the user");
    const CommandResult refused = pack(folder, {"limb.yaml", "-o", "out", "--force"});
    EXPECT_EQ(refused.exit_code, 1) << own;
    EXPECT_NE(refused.err.find("would be lost"), std::string::npos) << refused.err;
    EXPECT_EQ(textOf(folder.path(own)), "of the user");
    fs::remove_all(folder.path(own));
  }
  fs::remove(folder.path("out/grids/more"));
  ASSERT_EQ(pack(folder, {"limb.yaml", "-o", "out/", "--force"}).exit_code, 0);
  EXPECT_EQ(filesIn(folder.path()).size(), before.size() + 1);
}

TEST(PackedScenes, AreRefusedByTheFileThatIsDamagedOrGone) {
  const TempFolder folder;
  (void)folder.file("stone.obj",
                    "v 3 0 0\nv -3 0 0\nv 0 3 0\nv 0 -3 0\nv 0 0 3\nv 0 0 -3\n"
                    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  (void)folder.file("stone.yaml", R"(palpate: 1
length: mm
materials: {hard: {stiffness: 500 N/m}}
layers: [{name: stone, inside: {mesh: {file: stone.obj, voxel: 0.5}}, wall: hard}]
)");
  ASSERT_EQ(pack(folder, {"stone.yaml", "-o", "whole"}).exit_code, 0);
  const auto touched = [&](const char* bundle) {
    return runPalpate({"touch", bundle, "--press", "3,0,0", "--normal", "1,0,0"}, folder.path());
  };
  ASSERT_EQ(touched("whole").exit_code, 0);
  int tried = 0;
  for (const std::string& name : allFiles(folder.path("whole"))) {
    if (name == "scene.yaml") continue;  // may be edited
    for (const bool is_gone : {false, true}) {
      if (is_gone && name == "pack.json") continue;  // without it the folder is not a bundle
      fs::remove_all(folder.path("hurt"));
      fs::copy(folder.path("whole"), folder.path("hurt"), fs::copy_options::recursive);
      const fs::path hurt = fs::path(folder.path("hurt")) / name;
      std::string bytes = textOf(hurt.string());
      if (is_gone) {
        fs::remove(hurt);
      } else {
        // Damage the middle of a file; in the list, the first hash.
        const std::size_t at = name == "pack.json"
                                   ? bytes.find("fnv1a64:", bytes.find("contents")) + 9
                                   : bytes.size() / 2;
        bytes[at] = bytes[at] == '1' ? '2' : '1';
        std::ofstream(hurt, std::ios::binary) << bytes;
      }
      const CommandResult result = touched("hurt");
      EXPECT_EQ(result.exit_code, 3) << name << result.err;
      EXPECT_NE(result.err.find(is_gone ? "is gone" : "has changed since it was packed"),
                std::string::npos)
          << name << result.err;
      ++tried;
    }
  }
  EXPECT_GE(tried, 5) << "a mesh, a grid with what is known of it, the list";
}

}  // namespace
}  // namespace palpate::testing
