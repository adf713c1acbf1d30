#include "image/structures.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/core/text.h"
#include "palpate/scene/scene_file.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kMostTold = 8;

std::string cubicCentimeters(double cubic_meters) { return shortNumber(cubic_meters * 1e6, 3); }

/// The structures in the order in which they are painted: a later one overwrites earlier ones.
std::vector<std::size_t> paintOrder(const std::vector<Structure>& structures,
                                    const std::vector<std::string>& priority,
                                    const std::string& source) {
  std::vector<std::string_view> names;
  for (const Structure& one : structures) names.push_back(one.name);
  std::vector<std::size_t> rank(structures.size(), priority.size());
  for (std::size_t p = 0; p < priority.size(); ++p) {
    const auto at = std::find(names.begin(), names.end(), priority[p]);
    if (at == names.end()) {
      const std::string close = suggest(priority[p], names);
      throw inputError("labels.priority", "no structure is named `" + priority[p] + "`",
                       close.empty() ? "the priority names structures, the first before all others"
                                     : "did you mean `" + close + "`?",
                       source);
    }
    std::size_t& place = rank[static_cast<std::size_t>(at - names.begin())];
    place = std::min(place, p);
  }
  std::vector<std::size_t> order(structures.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (rank[a] != rank[b]) return rank[a] > rank[b];
    return structures[a].voxels > structures[b].voxels;
  });
  return order;
}

void tellEmpty(const std::vector<Structure>& structures, const std::string& what,
               std::vector<std::string>& notes) {
  std::string list;
  std::size_t count = 0;
  for (const Structure& one : structures) {
    if (one.voxels > 0) continue;
    if (++count <= kMostTold) list += (list.empty() ? "" : ", ") + one.name;
  }
  if (count == 0) return;
  notes.push_back(std::to_string(count) + " of " + std::to_string(structures.size()) + " " + what +
                  " have no voxel: " + list + (count > kMostTold ? ", ..." : ""));
}

}  // namespace

void Overlaps::tell(std::uint64_t voxels, const std::string& rule, const NameTable& names,
                    double voxel_volume, std::vector<std::string>& notes) const {
  if (pairs_.empty()) return;
  std::vector<std::pair<std::pair<int, int>, std::uint64_t>> ordered(pairs_.begin(), pairs_.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text = std::to_string(voxels) + " voxels (" +
                     cubicCentimeters(static_cast<double>(voxels) * voxel_volume) + " cm^3) " +
                     rule + ":";
  for (std::size_t n = 0; n < ordered.size() && n < kMostTold; ++n) {
    const auto& [pair, shared] = ordered[n];
    text += (n == 0 ? " " : ", ") + names.at(pair.first) + " has " +
            cubicCentimeters(static_cast<double>(shared) * voxel_volume) + " cm^3 of " +
            names.at(pair.second);
  }
  if (ordered.size() > kMostTold) {
    text += ", and " + std::to_string(ordered.size() - kMostTold) + " pairs less";
  }
  notes.push_back(std::move(text));
}

std::vector<float> mergeStructures(const std::vector<Structure>& structures,
                                   const std::string& what,
                                   const std::vector<std::string>& priority, Image& image) {
  const std::size_t count = static_cast<std::size_t>(image.size[0]) *
                            static_cast<std::size_t>(image.size[1]) *
                            static_cast<std::size_t>(image.size[2]);
  std::vector<float> out(count, 0.0F);
  NameTable names;
  for (const std::size_t n : paintOrder(structures, priority, image.source)) {
    pollStop();
    const Structure& one = structures[n];
    names[one.label] = one.name;
    for (const VoxelRun& run : one.runs) {
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(run.begin),
                out.begin() + static_cast<std::ptrdiff_t>(run.end), static_cast<float>(one.label));
    }
  }
  Overlaps overlaps;
  std::vector<bool> is_shared(count, false);
  std::uint64_t shared = 0;
  for (const Structure& one : structures) {
    pollStop();
    for (const VoxelRun& run : one.runs) {
      for (std::uint64_t at = run.begin; at < run.end;) {
        const float owner = out[at];
        const std::uint64_t first = at;
        while (at < run.end && out[at] == owner) ++at;
        if (static_cast<int>(owner) == one.label) continue;
        overlaps.add(static_cast<int>(owner), one.label, at - first);
        for (std::uint64_t n = first; n < at; ++n) {
          shared += is_shared[n] ? 0 : 1;
          is_shared[n] = true;
        }
      }
    }
  }
  const std::string rule = priority.empty()
                               ? "each goes to the smallest of them"
                               : "each goes to the first by priority, then to the smallest";
  overlaps.tell(shared, "are in several " + what + "; " + rule, names,
                std::abs(glm::determinant(image.axes)), image.notes);
  tellEmpty(structures, what, image.notes);
  return out;
}

}  // namespace palpate::vdb
