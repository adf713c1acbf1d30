#include <array>
#include <cstdio>

#include "palpate/vdb/certificate.h"

namespace palpate::vdb {
namespace {

constexpr const char* kKey = "palpate:certificate";

const char* nameOf(Sampler sampler) {
  return sampler == Sampler::kCubic       ? "cubic"
         : sampler == Sampler::kTrilinear ? "trilinear"
                                          : "accessor";
}

}  // namespace

LevelSet withCertificate(const LevelSet& grid, const BandCertificate& c) {
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(),
                "2 %s %s within_m %.9g lipschitz %.9g steepest %.9g slope %.9g at_m %.9g %.9g %.9g "
                "rough %.9g "
                "off_m %.9g",
                c.content.c_str(), nameOf(c.sampler), c.within, c.lipschitz, c.steepest, c.slope,
                c.slope_place.x, c.slope_place.y, c.slope_place.z, c.rough, c.off);
  return grid.named(grid.info().name, {{kKey, text.data()}});
}

std::optional<BandCertificate> storedCertificate(const LevelSet& grid, Sampler sampler) {
  const auto entry = grid.info().metadata.find(kKey);
  if (entry == grid.info().metadata.end()) return {};
  BandCertificate c;
  c.sampler = sampler;
  std::array<char, 17> content{};
  std::array<char, 16> name{};
  const int read =
      std::sscanf(entry->second.c_str(),
                  "2 %16[0-9a-f] %15[a-z] within_m %lf lipschitz %lf steepest %lf slope %lf at_m "
                  "%lf %lf %lf rough %lf "
                  "off_m %lf",
                  content.data(), name.data(), &c.within, &c.lipschitz, &c.steepest, &c.slope,
                  &c.slope_place.x, &c.slope_place.y, &c.slope_place.z, &c.rough, &c.off);
  const double least = kLeastWithin * grid.info().voxel_size;
  const bool holds = read == 11 && nameOf(sampler) == std::string(name.data()) &&
                     c.within >= least && c.steepest <= kMostSteep && c.off >= 0.0;
  if (!holds) return {};
  c.content = content.data();
  if (c.content != contentHash(grid)) return {};
  return c;
}

}  // namespace palpate::vdb
