#pragma once
// Shared by tests of kept grids and of bundles.

#include <cstdlib>

#include "tools/imported.h"
#include "vdb/made_scans.h"

namespace palpate::testing {

/// The cache folder for all commands that a test runs while this object exists.
class CacheFolder {
 public:
  explicit CacheFolder(const std::string& folder) { setenv("PALPATE_CACHE", folder.c_str(), 1); }
  ~CacheFolder() { unsetenv("PALPATE_CACHE"); }
  CacheFolder(const CacheFolder&) = delete;
  CacheFolder& operator=(const CacheFolder&) = delete;
};

/// limb.yaml, imported from limb.nii.gz (bone within muscle within fat) with names.csv.
inline void importLimb(const TempFolder& folder, double voxel = 1.5) {
  const vdb::test::Limb limb;
  (void)vdb::test::writeNifti(limb.labels(vdb::test::obliqueAxes(Vec3(voxel))), folder,
                              "limb.nii.gz");
  (void)folder.file("names.csv", "value,name\n1,femur\n2,muscle\n3,fat\n");
  (void)run(folder, {"import", "limb.nii.gz", "--names", "names.csv", "-o", "limb.yaml", "--json"});
}

/// A touch of `scene` from outside the limb to its axis and back, without the times of its ticks;
/// empty if it failed.
struct Felt {
  std::vector<std::string> ticks;
  std::size_t made = 0;
  std::size_t kept = 0;
  CommandResult result;
};

inline Felt feltIn(const TempFolder& folder, const std::string& scene, const std::string& trace,
                   const std::vector<std::string>& more = {}) {
  const vdb::test::Limb limb;
  std::vector<std::string> arguments = {"touch",
                                        scene,
                                        "--back",
                                        "--speed",
                                        "100mm/s",
                                        "--trace",
                                        trace,
                                        "--force",
                                        "--json",
                                        "--insert",
                                        pointText(limb.center + 30.0 * limb.outwards(0.7)),
                                        pointText(limb.center + 2.0 * limb.axis)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Felt felt;
  felt.result = runPalpate(arguments, folder.path());
  if (felt.result.exit_code != 0) return felt;
  const Json json = parseOnly(felt.result);
  for (const Json& grid : json.at("grids")) {
    (grid.at("was_kept").get<bool>() ? felt.kept : felt.made) += 1;
  }
  for (const std::string& line : linesOf(textOf(folder.path(trace)))) {
    felt.ticks.push_back(line.substr(0, line.rfind(',')));
  }
  return felt;
}

}  // namespace palpate::testing
