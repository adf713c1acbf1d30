#include "keep/kept_facts.h"

#include <array>
#include <cstdio>

#include "palpate/vdb/kept_grids.h"

namespace palpate::vdb {
namespace {

constexpr const char* kNotes = "palpate:kept_notes";
constexpr const char* kMade = "palpate:kept_made";
constexpr const char* kKept = "palpate:kept";

}  // namespace

bool wasKept(const LevelSetInfo& info) { return info.metadata.contains(kKept); }

std::string textOf(const Box3& box) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "%a %a %a %a %a %a", box.lo.x, box.lo.y, box.lo.z,
                box.hi.x, box.hi.y, box.hi.z);
  return text.data();
}

std::optional<Box3> boxOf(const std::string& text) {
  Box3 box;
  if (std::sscanf(text.c_str(), "%la %la %la %la %la %la", &box.lo.x, &box.lo.y, &box.lo.z,
                  &box.hi.x, &box.hi.y, &box.hi.z) != 6) {
    return {};
  }
  return box;
}

LevelSet withFacts(const LevelSet& grid, const KeptFacts& facts, const std::string& what) {
  std::string notes;
  for (const auto& [about, note] : facts.notes) {
    notes += (about == what ? "w" : "f") + note + "\n";
  }
  std::array<char, 100> made{};
  std::snprintf(made.data(), made.size(), "%a %llu %llu ", facts.made.half_width,
                static_cast<unsigned long long>(facts.made.active_voxels),
                static_cast<unsigned long long>(facts.made.memory));
  return grid.named(grid.info().name,
                    {{kNotes, notes}, {kMade, made.data() + textOf(facts.made.bounds)}});
}

KeptFacts factsOf(const LevelSet& grid, const std::string& what, const std::string& file) {
  KeptFacts facts;
  facts.made = grid.info();
  std::map<std::string, std::string>& metadata = facts.made.metadata;
  std::string notes = metadata[kNotes];
  for (std::size_t end = notes.find('\n'); end != std::string::npos; end = notes.find('\n')) {
    if (end > 0) facts.notes.emplace_back(notes[0] == 'w' ? what : file, notes.substr(1, end - 1));
    notes.erase(0, end + 1);
  }
  unsigned long long voxels = 0;
  unsigned long long memory = 0;
  int read = 0;
  const std::string made = metadata[kMade];
  if (std::sscanf(made.c_str(), "%la %llu %llu %n", &facts.made.half_width, &voxels, &memory,
                  &read) == 3) {
    facts.made.active_voxels = voxels;
    facts.made.memory = memory;
    if (const auto box = boxOf(made.substr(static_cast<std::size_t>(read)))) {
      facts.made.bounds = *box;
    }
  }
  metadata.erase(kNotes);
  metadata.erase(kMade);
  metadata[kKept] = "yes";
  return facts;
}

}  // namespace palpate::vdb
