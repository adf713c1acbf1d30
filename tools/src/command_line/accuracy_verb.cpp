#include "command_line/verb.h"

namespace palpate::tools {
namespace {

void define(CLI::App& app, Invocation& invocation) {
  auto& o = choose<AccuracyOptions>(invocation);
  app.add_option("scene", o.scene);
  const char* g = "What to compare";
  addList(app, g, "--field", "NAME", o.fields,
          "only this layer or field, may be repeated (default: every layer)");
  addList(app, g, "--voxel", "LENGTH", o.voxels,
          "a voxel size, in the scene's unit or with a unit: 0.5mm; may be repeated");
  add(app, g, "--ladder", "A,B,...", o.ladder,
      "voxel sizes (default: the longest side by 32, 64, 128 and 256)");
  addList(app, g, "--sampler", "NAME", o.samplers,
          "only this one, may be repeated: cubic, trilinear, accessor (default: all)")
      ->check(CLI::IsMember({"cubic", "trilinear", "accessor"}));
  g = "How";
  add(app, g, "--points", "N", o.points, "random points to compare at (default 100000)")
      ->check(CLI::Range(100, 100000000));
  add(app, g, "--band", "VOXELS", o.band,
      "how far from the surface they are, at most (default 1 voxel)")
      ->check(CLI::Range(0.01, 16.0));
  add(app, g, "--repeat", "N", o.repeats,
      "timed runs, of which the shortest counts; three cold queries for each (default 10)")
      ->check(CLI::Range(1, 100000));
  g = "Output files";
  add(app, g, "--csv", "FILE.csv", o.csv,
      "the table, one row for each field, voxel size and sampler");
  add(app, g, "--svg", "FILE.svg", o.svg, "plots of error against time and against memory");
}

}  // namespace

Verb accuracyVerb() {
  return {"accuracy",
          "Compare fields with their grids: error, time and memory by voxel size",
          "palpate accuracy data/scenes/reference.yaml --field torus --ladder 2,1,0.5,0.25",
          "palpate accuracy SCENE [OPTIONS]",
          R"(Bakes each layer, or the fields asked for, at every voxel size, and compares what every
sampler says with the truth: value, normal and mean curvature (from the Hessian) at random
points near the surface, and the jitter of the normal, the largest |n[i+1] - 2 n[i] + n[i-1]|
on strokes along the surface in steps of 0.2 mm, beside that of the exact surface. The truth
of an exact field, or of a bound, is the field itself; that of an implicit field is the exact
distance to its zero set. Points with an edge or medial axis within 4 voxels are told apart,
as no grid holds an edge. Times are for value and gradient: one after another along a path,
each waiting for the last, and cold (other data went through the caches).)",
          {},
          define,
          [](const Invocation& i) {
            const auto& o = chosen<AccuracyOptions>(i);
            need(!o.scene.empty(), "SCENE");
            if (!o.ladder.empty() && !o.voxels.empty()) {
              throw usageError("--ladder and --voxel exclude one another", "");
            }
          },
          true};
}

}  // namespace palpate::tools
