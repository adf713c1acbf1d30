// Value and gradient of a grid along a path: our samplers compared with those of OpenVDB and
// NanoVDB, in one run. See README.md.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>

#include "brick/brick_field.h"
#include "results.h"
#include "rivals.h"
#include "shapes.h"
#include "write_results.h"

namespace palpate::bench {
namespace {

std::vector<Run> ourRuns(const vdb::LevelSet& grid) {
  std::vector<Run> runs;
  const auto bricks = std::make_shared<const vdb::BrickField>(grid);
  runs.push_back(makeRun("bricks, cubic", [bricks](const Vec3& p) { return bricks->sample(p); }));
  for (const auto& [name, sampler] :
       {std::pair{"bricks, cubic, as Field", vdb::Sampler::kCubic},
        std::pair{"bricks, trilinear, as Field", vdb::Sampler::kTrilinear},
        std::pair{"accessor, trilinear, as Field", vdb::Sampler::kAccessor}}) {
    runs.push_back(makeRun(
        name, [field = vdb::gridField(grid, sampler)](const Vec3& p) { return field->sample(p); }));
  }
  return runs;
}

/// One iteration is the whole path, so that repetitions are short and the shortest is undisturbed.
void registerRun(const std::shared_ptr<const Shape>& shape, const Run& run, const char* kind,
                 const std::function<double(std::span<const Vec3>)>& walk) {
  benchmark::RegisterBenchmark((shape->name + "|" + run.sampler + "|" + kind).c_str(),
                               [shape, walk](benchmark::State& state) {
                                 // Other rows ran in between: a first, untimed walk warms the
                                 // caches.
                                 benchmark::DoNotOptimize(walk(shape->path));
                                 for (auto _ : state) benchmark::DoNotOptimize(walk(shape->path));
                                 state.counters["queries"] =
                                     static_cast<double>(shape->path.size());
                               })
      ->Iterations(1)
      ->Repetitions(60)
      ->Unit(benchmark::kNanosecond);
}

void registerShape(Shape made, Results& results) {
  const auto shape = std::make_shared<const Shape>(std::move(made));
  for (const auto& runs :
       {ourRuns(shape->grid), openvdbRuns(shape->grid), nanovdbRuns(shape->grid)}) {
    for (const Run& run : runs) {
      results.expect(shape->name, run.sampler);
      registerRun(shape, run, "independent", run.independent);
      registerRun(shape, run, "dependent", run.dependent);
    }
  }
}

int run(int count, char** arguments) {
  const std::string mesh = takeOption("mesh", count, arguments);
  const std::string folder = takeOption("write", count, arguments);
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  const tools::Machine machine = tools::thisMachine();
  if (!machine.optimized) std::fputs("warning: not optimized: times say nothing\n", stderr);
  Results results;
  registerShape(torusShape(), results);
  registerShape(ballShape(), results);
  if (mesh.empty()) {
    std::fputs("no mesh was given (--mesh=FILE): skipped\n", stderr);
  } else {
    registerShape(meshShape(mesh), results);
  }
  benchmark::RunSpecifiedBenchmarks(&results);
  std::printf("%s, %s, %s build\n\n%s", machine.cpu.c_str(), machine.compiler.c_str(),
              machine.build_type.c_str(), results.table().c_str());
  if (!folder.empty()) write(results.json(machine), machine, folder);
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  try {
    return palpate::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
