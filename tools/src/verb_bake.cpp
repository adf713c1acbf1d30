#include "baking.h"
#include "input_kind.h"
#include "json_parts.h"
#include "output_files.h"
#include "palpate/vdb/io.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {

Report run(const BakeOptions& options, const GeneralOptions& general, Console& console) {
  if (!hasExtension(options.output, ".vdb")) {
    throw Error(ErrorKind::kUsage,
                {"usage.bake", "the output " + options.output + " must end in .vdb",
                 "palpate convert writes meshes and images"});
  }
  OutputFiles files(general.force);
  files.announce(options.output, {options.input, options.names});

  const std::vector<BakedGrid> baked = bakeInput(options, console);
  std::vector<vdb::LevelSet> grids;
  grids.reserve(baked.size());
  for (const BakedGrid& one : baked) grids.push_back(one.grid);
  checkStop();
  vdb::writeVdb(files.temporary(options.output), grids, true);
  checkStop();
  files.commit();

  Report report;
  report.json = {{"schema", "palpate.bake/1"},
                 {"input", options.input},
                 {"output", options.output},
                 {"grids", Json::array()}};
  Table table({"grid", "voxel", "active voxels", "memory", "made in", "bounds"});
  for (const BakedGrid& one : baked) {
    const vdb::LevelSetInfo& info = one.grid.info();
    const double unit = info.metres_per_unit;
    report.json["grids"].push_back({{"name", info.name},
                                    {"voxel_size_m", info.voxel_size},
                                    {"half_width_voxels", info.half_width},
                                    {"active_voxels", info.active_voxels},
                                    {"memory_bytes", info.memory},
                                    {"bounds_m", boxJson(info.bounds)},
                                    {"seconds", one.seconds}});
    table.add({info.name, formatNumber(info.voxel_size / unit, 3) + " " + info.length_unit,
               formatCount(info.active_voxels), formatBytes(info.memory),
               formatSeconds(one.seconds),
               formatVector(info.bounds.lo / unit) + " to " + formatVector(info.bounds.hi / unit) +
                   " " + info.length_unit});
  }
  report.text = table.text("") + "\nWrote " + options.output + "\n";
  return report;
}

}  // namespace palpate::tools
