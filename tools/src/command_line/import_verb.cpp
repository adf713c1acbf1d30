// The verb that makes a scene from a segmented scan.

#include "command_line/verb.h"

namespace palpate::tools {
namespace {

void defineImport(CLI::App& app, Invocation& invocation) {
  auto& o = choose<ImportOptions>(invocation);
  app.add_option("scan", o.scans);
  const char* g = "Output";
  add(app, g, "-o,--output", "FILE.yaml", o.output, "where the scene goes (required)");
  addFlag(app, g, "--dry-run", o.dry_run,
          "write nothing; show regions, and the voxels, memory and time of their grids");
  g = "Regions (LABELS: values, ranges 5-28, names, patterns such as 'lung*', with commas)";
  addList(app, g, "--labels", "LABELS", o.labels,
          "only these labels, each a region of its own (default: all)")
      ->delimiter(',');
  addList(app, g, "--region", "NAME=LABELS", o.regions,
          "one region of all of these labels, may be repeated");
  add(app, g, "--names", "FILE", o.names,
      "table of names: `index name`, `value,name`, of Slicer, ITK-SNAP or FreeSurfer (default: the "
      "image's own)");
  add(app, g, "--min-island", "VOXELS", o.min_island,
      "change pieces and cavities of less than this; the changed image goes to FILE.labels.nii.gz "
      "(default: none, they are only told)")
      ->check(CLI::Range(1, 1000000000));
  addChoice(
      app, g, "--islands", {"merge", "drop"}, o.islands,
      "--min-island: they become part of what is around (default), or pieces become unlabeled "
      "and cavities stay");
  g = "The body, whose unlabeled rest becomes the region soft_tissue";
  add(app, g, "--image", "FILE", o.image, "gray values of the same scan: CT, MR");
  add(app, g, "--skin", "VALUE", o.skin,
      "--image: the body is brighter than this; its largest piece, cavities filled (CT: -300)");
  add(app, g, "--body", "FILE", o.body, "or a mask of the body: what is not 0");
  g = "Tissues, by names and codes unless said here";
  addList(
      app, g, "--tissue", "LABELS=TISSUE", o.tissues,
      "the tissue of a value, a range, a name or a pattern: \"Outer-Table=bone\", may be repeated");
  add(app, g, "--tissue-file", "FILE", o.tissue_file,
      "lines of the same; --tissue goes before them");
  add(app, g, "--codes", "freesurfer", o.codes,
      "the labels are numbers of FreeSurfer's table, of SynthSeg's too, and need no names")
      ->check(CLI::IsMember({"freesurfer"}));
  addFlag(app, g, "--strict", o.strict, "a label that fits no tissue is an error");
  g = "A way for a needle";
  add(app, g, "--to", "TARGET", o.to,
      "the shortest straight way to a region or a label that ports let through, clear of bone, "
      "vessels and nerves: reported, and suggested in the scene; or to a point marked in Slicer "
      "(.mrk.json), from a second point if the file has one");
  add(app, g, "--burr-hole", "DIAMETER", o.burr_hole,
      "--to: drill a round hole through the bone on the shortest way, in mm or with a unit; the "
      "changed image goes to FILE.labels.nii.gz");
  add(app, g, "--way", "FILE.mrk.json", o.way, "--to: write the way as a line that Slicer loads");
  g = "Materials and grids";
  addFlag(app, g, "--hounsfield", o.hounsfield,
          "--image is a CT in Hounsfield units: stiffness varies with it, where the table of "
          "tissues says how");
  add(app, g, "--materials", "FILE.yaml", o.materials,
      "table of tissues (default: the project's data/materials/tissues.yaml)");
  add(app, g, "--voxel", "LENGTH", o.voxel,
      "voxel size of the grids, in mm or with a unit (default: of the same volume as the scan's)");
  g = "What a scan leaves open";
  addList(app, g, "--priority", "NAMES", o.priority,
          "of masks that overlap the first named here has the voxel (default: the smallest)")
      ->delimiter(',');
  addScan(app, g, o.reading, false);
}

}  // namespace

Verb importVerb() {
  return {
      "import",
      "Turn a segmented scan into a scene: regions, materials, ports",
      "palpate import labels.nii.gz --names labels.csv --body mask.nii.gz -o scan.yaml",
      "palpate import SCAN... -o SCENE.yaml [OPTIONS]",
      R"(SCAN is a label image, a folder of masks, or several masks: a structure each, called as its file.
So are closed meshes, in mm (.stl .vtk .ply .obj), listed or in a folder: they become voxels, and
the labels go to FILE.labels.nii.gz.
Masks, and segments of DICOM, may overlap: the first that --priority names has the voxel, then the
smallest. Each label becomes a region, with the tissue that the words of its name or its code mean;
what fits none is listed. What stands between two regions their tissues' classes say: bone never opens,
flesh and membranes give way both ways at their forces, fluids and air have no walls, and parcels of
one tissue none between them. The scene says of every number whether it was measured, derived or
assumed, and by whom. It is text to be edited; grids are made when it is touched or baked.)",
      {},
      defineImport,
      [](const Invocation& i) {
        const auto& o = chosen<ImportOptions>(i);
        need(!o.scans.empty(), "SCAN");
        need(o.dry_run || !o.output.empty(), "-o SCENE.yaml");
        if (o.image.empty() && (o.skin || o.hounsfield)) {
          throw usageError(std::string(o.skin ? "--skin" : "--hounsfield") + " needs --image", "");
        }
        if (!o.image.empty() && !o.skin && !o.hounsfield) {
          throw usageError("--image needs --skin or --hounsfield, which say what it is for", "");
        }
        if (o.skin && !o.body.empty()) {
          throw usageError("--skin and --body both say what the body is", "");
        }
        if (!o.islands.empty() && !o.min_island) {
          throw usageError("--islands needs --min-island", "");
        }
      },
      true};
}

}  // namespace palpate::tools
