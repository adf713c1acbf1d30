// The verb that makes a scene portable.

#include "command_line/verb.h"

namespace palpate::tools {
namespace {

void definePack(CLI::App& app, Invocation& invocation) {
  auto& o = choose<PackOptions>(invocation);
  app.add_option("scene", o.scene);
  add(app, "Output", "-o,--output", "FOLDER", o.output, "the bundle (required)");
}

}  // namespace

Verb packVerb() {
  return {
      "pack",
      "Put a scene, its grids and what they were made of into one folder",
      "palpate pack data/scenes/container.yaml -o container.bundle",
      "palpate pack SCENE -o FOLDER [OPTIONS]",
      R"(The folder can be moved, and every verb that takes a scene takes it: palpate touch FOLDER ... What is
felt is the same, bit for bit. It holds scene.yaml, the scene with names within the folder; grids/, each
grid with its certificate under the hash of what it was made of; files/, the meshes, grids and tables that
the scene names; and pack.json, which says of every file of the scene where it came from, its size and its
hash. Scans are not in it: a short description stands for each, and layers of them take the grids. A scan
that a material reads is copied, and the report says so. Layers that were not in the scene when it was packed,
or are made otherwise, need the scan.)",
      {},
      definePack,
      [](const Invocation& i) {
        const auto& o = chosen<PackOptions>(i);
        need(!o.scene.empty(), "SCENE");
        need(!o.output.empty(), "-o FOLDER");
      },
      true};
}

}  // namespace palpate::tools
