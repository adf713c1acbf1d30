// The verbs that make and describe files, measure, and show help.

#include "command_line/verb.h"

namespace palpate::tools {

void addScan(CLI::App& app, const char* group, ScanOptions& o, bool meshes) {
  addChoice(
      app, group, "--affine", {"sform", "qform", "spacing"}, o.affine,
      "NIfTI: which form counts (default: sform, else qform; if both, they must agree); NIfTI, "
      "NRRD: "
      "spacings only, axes along R, A, S from 0");
  addChoice(
      app, group, "--space", {"RAS", "LPS"}, o.space,
      meshes
          ? "which way the axes of a mesh run (default: as the file says, else RAS), or of a NRRD "
            "image that does not say"
          : "which way the axes of a NRRD image run that does not say");
  add(app, group, "--frame", "N", o.frame, "which volume of a 4-D image, from 0")
      ->check(CLI::Range(0, 1000000));
  add(app, group, "--series", "UID", o.series, "which DICOM series of a folder that holds several");
  addFlag(app, group, "--resample", o.resample,
          "a DICOM series whose slices are unevenly spaced, off one line or sheared becomes voxels "
          "with right angles, linear between slices");
}

namespace {

/// Options about how a surface becomes a grid, and which grid.
void addBaking(CLI::App& app, BakeOptions& o) {
  const char* g = "The grid";
  add(app, g, "--voxel", "LENGTH", o.voxel,
      "voxel size, in the input's unit or with a unit: 0.5mm (default: that of an image or grid; "
      "else 1/128 of the longest side)");
  add(app, g, "--half-width", "VOXELS", o.half_width,
      "width of the narrow band on each side of the surface (default 6)")
      ->check(CLI::Range(2.0, 64.0));
  add(app, g, "--max-memory", "SIZE", o.max_memory,
      "refuse, before it is taken, what needs more: 500MB, 2GB (default: 80 % of the machine's)");
  addList(app, g, "--layer", "NAME", o.layers,
          "scene, grid: only this layer, may be repeated; mesh, --above: what to call it");
  g = "From a mesh";
  add(app, g, "--units", "UNIT", o.units,
      "what one unit of the mesh is: mm (default), cm, m, um, in");
  addChoice(
      app, g, "--sign", {"vote", "winding", "flood", "unsigned"}, o.sign,
      "what is inside: where both agree, else refuse (default); by winding number, holes closed by "
      "flat lids; what a flood from outside does not reach; or nothing, distances without sign");
  add(app, g, "--shell", "LENGTH", o.shell,
      "not a solid but a wall of this thickness along the triangles");
  add(app, g, "--smooth", "DEGREES", o.smooth,
      "facets that meet at less than this angle become one smooth surface")
      ->check(CLI::Range(0.0, 180.0));
  addScan(app, "What a scan or a mesh leaves open", o.scan, true);
  g = "From an image, or a grid of densities or labels";
  add(app, g, "--above", "VALUE", o.above, "the surface around all voxels greater than this");
  addFlag(app, g, "--distances", o.distances,
          "the voxels are signed distances, negative inside: the surface where they are zero");
  addChoice(app, g, "--keep", {"largest", "all"}, o.keep,
            "--above: which pieces (default largest)");
  addFlag(app, g, "--fill", o.fill, "--above: close enclosed cavities");
  addList(
      app, g, "--labels", "NAME,...", o.labels,
      "one grid for each of these labels: values, ranges 5-28, names, or patterns such as 'lung*'")
      ->delimiter(',');
  add(app, g, "--names", "FILE", o.names,
      "table of names: `index name`, `value,name`, of Slicer, ITK-SNAP or FreeSurfer (default: the "
      "image's own)");
}

void addLevelSet(CLI::App& app, const char* group, bool& level_set) {
  addFlag(app, group, "--level-set", level_set,
          "a grid that does not say its class holds signed distances, negative inside");
}

void defineBake(CLI::App& app, Invocation& invocation) {
  auto& o = choose<BakeOptions>(invocation);
  app.add_option("input", o.input);
  add(app, "Output", "-o,--output", "FILE.vdb", o.output, "where the grids go (required)");
  add(app, "Output", "--parts", "FILE.yaml", o.parts,
      "scene: keep its edges. Grids of its smooth parts only, and here the scene that puts them "
      "together with the rest");
  addBaking(app, o);
}

void defineConvert(CLI::App& app, Invocation& invocation) {
  auto& o = choose<ConvertOptions>(invocation);
  app.add_option("input", o.bake.input);
  const char* g = "Output";
  add(app, g, "-o,--output", "FILE", o.bake.output,
      ".stl .obj .ply .glb, .nii .nii.gz or .vdb (required)");
  add(app, g, "--to-units", "UNIT", o.to_units,
      "what one unit of the mesh is to be: mm, cm, m, um, in (default: as in the input)");
  addBaking(app, o.bake);
  addLevelSet(app, "From a grid", o.bake.level_set);
}

void defineInfo(CLI::App& app, Invocation& invocation) {
  auto& o = choose<InfoOptions>(invocation);
  app.add_option("files", o.files);
  add(app, "Options", "--units", "UNIT", o.units,
      "what one unit of a mesh is: mm (default), cm, m, um, in");
  add(app, "Options", "--names", "FILE", o.names, "image: table of names of its labels");
  addScan(app, "What a scan or a mesh leaves open", o.scan, true);
}

void defineCheck(CLI::App& app, Invocation& invocation) {
  auto& o = choose<CheckOptions>(invocation);
  app.add_option("files", o.files);
  const char* g = "Options";
  add(app, g, "--units", "UNIT", o.units,
      "what one unit is, of a mesh or of a grid that does not say: mm (a mesh's default), cm, m, "
      "um, "
      "in");
  addChoice(app, g, "--space", {"RAS", "LPS"}, o.scan.space,
            "mesh: which way its axes run (default: as the file says, else RAS); places are "
            "printed in RAS");
  add(app, g, "--voxel", "LENGTH", o.voxel,
      "mesh: voxel size of the bake that is tried (default: 1/128 of the longest side)");
  add(app, g, "--layer", "NAME", o.layer, "grid: only this one of the file");
  addLevelSet(app, g, o.level_set);
}

void defineBench(CLI::App& app, Invocation& invocation) {
  auto& o = choose<BenchOptions>(invocation);
  app.add_option("what", o.what);
  const char* g = "What to run";
  addList(app, g, "--scene", "NAME", o.scenes, "only this scene, may be repeated (default: all)");
  add(app, g, "--renderer", "NAME", o.renderer,
      "only this renderer: constraint or paper, for stability also a rival (default: all)");
  addList(app, g, "--device", "NAME", o.devices,
          "stability: only this device, may be repeated (default: falcon and touch)");
  addFlag(
      app, g, "--full", o.full,
      "stability: where nothing else is said all scenes, four devices, 1, 4 and 10 kHz (hours)");
  add(app, g, "--repeat", "N", o.repeats, "runs, of which the shortest time counts (default 10)")
      ->check(CLI::Range(1, 100000));
  add(app, g, "--paced", "N", o.paced,
      "ticks that are timed one a millisecond, the loop asleep in between (default 2000)")
      ->check(CLI::Range(0, 1000000));
  add(app, g, "--cold", "N", o.cold,
      "ticks that are timed after other data went through the caches (default 30)")
      ->check(CLI::Range(0, 1000000));
  g = "Of `bench servo`";
  addList(app, g, "--rate", "HZ", o.rates,
          "servo and stability: a rate, may be repeated (default 1000, servo 4000 too)")
      ->check(CLI::Range(1.0, 100000.0));
  add(app, g, "--seconds", "S", o.seconds, "for how long at each rate (default 5)")
      ->check(CLI::Range(0.1, 86400.0));
  add(app, g, "--load", "N", o.load,
      "threads that compute meanwhile (default: none, and then as many as there are cores)")
      ->check(CLI::Range(0, 1024));
  g = "Output files";
  add(app, g, "--csv", "FILE.csv", o.csv, "the table, one row for each scene and renderer");
  add(app, g, "--svg", "FILE.svg", o.svg,
      "a plot of error against time; for stability of stiffness over rate");
  add(app, g, "--curvature-svg", "FILE.svg", o.curvature_svg,
      "stability: a plot of stiffness over curvature times depth");
}

void defineHelp(CLI::App& app, Invocation& invocation) {
  auto& o = choose<HelpOptions>(invocation);
  app.add_option("verb", o.verb);
  app.add_option("key", o.key);
  const char* g = "Options";
  addFlag(app, g, "--markdown", o.markdown,
          "everything, as the reference in tools/README.md; of a map of scene files the table of "
          "its keys");
  addFlag(app, g, "--schema", o.schema, "scene: the JSON Schema of scene files");
  addFlag(app, g, "--man", o.man, "the manual page palpate(1)");
  addChoice(app, g, "--completion", {"bash", "zsh", "fish"}, o.completion,
            "what completes words in bash, zsh or fish", "SHELL");
}

}  // namespace

Verb bakeVerb() {
  return {
      "bake",
      "Turn a scene, a mesh or a scan into narrow-band level sets (.vdb)",
      "palpate bake data/scenes/container.yaml -o container.vdb --voxel 0.5",
      "palpate bake INPUT -o OUT.vdb [OPTIONS]",
      R"(INPUT is a scene file, a mesh (.stl .obj .ply .vtk .gltf .glb) or an image (.nii .nii.gz .nrrd
.nhdr .mha .mhd, or a folder with a DICOM series). Each layer
becomes a grid `<layer>/surface`. An image needs --above or --labels; labels that touch are also
written as one grid, `united`: a point belongs to the label whose value is smallest, or to none if
the opposite of `united` is smaller still.

No grid holds an edge: its normal is some ten degrees off there, however small the voxels are.
Where a layer has edges, a note says how far its grid is off. With --parts, only what a grid holds
and is not exact by itself becomes one, `<layer>/surface/<part>`; unions, intersections, differences
and placements stay, and so do boxes and the like. FILE.yaml is INPUT with the grids in those
places: as exact at its edges as INPUT, for every verb that takes a scene.)",
      {},
      defineBake,
      [](const Invocation& i) {
        need(!chosen<BakeOptions>(i).input.empty(), "INPUT");
        need(!chosen<BakeOptions>(i).output.empty(), "-o OUT.vdb");
      },
      true};
}

Verb convertVerb() {
  return {
      "convert",
      "Turn grids into meshes or images, meshes into others, and all into grids",
      "palpate convert data/scenes/container.yaml -o container.stl --voxel 0.5",
      "palpate convert INPUT -o OUTPUT [OPTIONS]",
      R"(INPUT is a grid (.vdb), a mesh, a scene or an image; the output's name says what it becomes.
A mesh winds outwards. An image holds signed distances. Scenes, meshes and images are baked
on the way, as `palpate bake` does. A file has no more than one mesh or image, so of several
layers or grids one must be named with --layer. A grid becomes another grid by --voxel; by --above
or --labels if it holds densities or labels; and by itself if it is turned, stretched or of
doubles, or if its inside is not marked: that is mended whatever becomes of the grid, and refused
where the band has holes. A trace of `palpate touch` (.csv) becomes a curve for 3D Slicer
(.mrk.json): the path of the proxy.)",
      {},
      defineConvert,
      [](const Invocation& i) {
        need(!chosen<ConvertOptions>(i).bake.input.empty(), "INPUT");
        need(!chosen<ConvertOptions>(i).bake.output.empty(), "-o OUTPUT");
      },
      true};
}

Verb infoVerb() {
  return {
      "info",
      "Say what a file is: scene, grid, mesh or scan",
      "palpate info /usr/share/mricron/templates/ch2.nii.gz",
      "palpate info FILE... [OPTIONS]",
      R"(An image is read whole: its place in space, its values, and how many voxels each label has. It
counts as labels if it says so, has a table of names, few different whole values, or parcels of them.)",
      {},
      defineInfo,
      [](const Invocation& i) { need(!chosen<InfoOptions>(i).files.empty(), "FILE"); }};
}

Verb checkVerb() {
  return {
      "check",
      "Say whether meshes, grids and scenes can be touched, and what is wrong with them",
      "palpate check organ.stl --units mm",
      "palpate check FILE... [OPTIONS]",
      R"(A mesh: holes, edges with three triangles or more, triangles turned, doubled, without area or
passing through others (exactly), parts inside out, size; and a bake is tried, as only that
tells what is solid. A grid (.vdb): class, unit, band, |gradient| (1 for distances), voxels that
are not numbers, holes in the band, and an inside that is not marked as such. A scene: all of it is
made, and a note names, with a place, all that grids could not hold of its meshes and scans.
Exit code 0 if all can be touched, baking mending what is wrong; 1 if one cannot.)",
      {},
      defineCheck,
      [](const Invocation& i) { need(!chosen<CheckOptions>(i).files.empty(), "FILE"); }};
}

Verb benchVerb() {
  return {
      "bench",
      "Measure contact (time and error of a tick), a hand in the loop, or how late a loop wakes",
      "palpate bench contact --scene sphere --scene torus --svg contact.svg",
      "palpate bench contact|stability|servo [OPTIONS]",
      R"(`stability` lets a relaxed hand press on hard cases through simulated devices, with our renderers and
published ones, and finds the stiffest wall on which it comes to rest, beside the device's budget
(tools/docs/stability.md).
`contact` runs both renderers along the same paths on scenes of known truth and compares the forces with
closed forms, or with a slow oracle where there is none: `judged` is the number of ticks compared.
`missed` counts those where one has a force and the other none; `step` and `turn` are the largest
from tick to tick, with the true ones beside them. `unsettled` is the share of ticks that ended
before the proxy was at rest, and how many came in a row. A dash: not measured, not judged, or not
said by this renderer. Scenes: sphere, sphere-baked, sphere-deep, sphere-small, sphere-hollow,
ellipsoid, quadric, torus, box-edge, box-room, box-corner, three-balls, three-hollow, cone-tip,
cone-wide, csg-nested, crease, groove, saddle, container, ports-10, ports-100, ports-1000, balls-1,
balls-1000, balls-10000, five-layers and lump (not judged).
`palpate bench servo` runs an empty loop in real time, and says whether this machine is good
enough for each rate: how late turns began, and how many were missed.)",
      {},
      defineBench,
      [](const Invocation& i) {
        need(!chosen<BenchOptions>(i).what.empty(), "contact, stability or servo");
      },
      true};
}

Verb helpVerb() {
  return {"help",
          "Print help: all about a verb or a key of scene files, the manual, completion",
          "palpate help scene opens_at",
          "palpate help [VERB | scene [KEY]] [OPTIONS]",
          R"(KEY is a key of scene files, a map of keys such as material, or both: port.rate.
Completion is switched on by `source <(palpate help --completion bash)`, or for good by a file:
bash ~/.local/share/bash-completion/completions/palpate, zsh _palpate in a folder of fpath,
fish ~/.config/fish/completions/palpate.fish.)",
          {},
          defineHelp,
          [](const Invocation& i) {
            const auto& o = chosen<HelpOptions>(i);
            if (o.verb == "scene") return;
            if (!o.key.empty()) throw usageError("unexpected argument '" + o.key + "'", "");
            if (o.schema) throw usageError("--schema is about scene files", "palpate help scene");
          }};
}

}  // namespace palpate::tools
