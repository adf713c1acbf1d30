#include "image/nrrd_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "image/header_text.h"
#include "image/structures.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

constexpr std::string_view kPrefix = "Segment";

/// The number N of a key "SegmentN_...".
std::optional<int> numberOfKey(std::string_view key) {
  if (!key.starts_with(kPrefix)) return {};
  const std::size_t bar = key.find('_');
  if (bar == std::string_view::npos) return {};
  return numberIn<int>(key.substr(kPrefix.size(), bar - kPrefix.size()));
}

/// Takes the type from Slicer's tags, "...|TerminologyEntry:CONTEXT~CATEGORY~TYPE~...|", where each
/// of the three is SCHEME^VALUE^MEANING.
std::optional<LabelCode> codeIn(std::string_view tags) {
  constexpr std::string_view kKey = "TerminologyEntry:";
  constexpr int kType = 2;
  const std::size_t key = tags.find(kKey);
  if (key == std::string_view::npos) return {};
  std::string_view entry = tags.substr(key + kKey.size());
  entry = entry.substr(0, entry.find('|'));
  for (int field = 0; field < kType; ++field) {
    const std::size_t tilde = entry.find('~');
    if (tilde == std::string_view::npos) return {};
    entry.remove_prefix(tilde + 1);
  }
  entry = entry.substr(0, entry.find('~'));
  const std::size_t first = entry.find('^');
  const std::size_t second = first == std::string_view::npos ? first : entry.find('^', first + 1);
  if (second == std::string_view::npos || first == 0) return {};
  return LabelCode{std::string(entry.substr(0, first)),
                   std::string(entry.substr(first + 1, second - first - 1)),
                   std::string(entry.substr(second + 1))};
}

}  // namespace

Error Segments::fail(const char* code, std::string message, std::string hint) const {
  return inputError(code, std::move(message), std::move(hint), path_);
}

void Segments::readOne(const std::map<std::string, std::string>& pairs, int number, int layers) {
  const std::string key = std::string(kPrefix) + std::to_string(number) + "_";
  const auto find = [&](const char* name) -> const std::string* {
    const auto at = pairs.find(key + name);
    return at == pairs.end() ? nullptr : &at->second;
  };
  const auto wrong = [&](const char* name, const std::string& text) {
    return fail("nrrd.segment", key + name + " is '" + text + "'", "save the segmentation again");
  };
  Segment s;
  s.number = number;
  if (const std::string* name = find("Name")) s.name = *name;
  if (s.name.empty()) {
    if (const std::string* id = find("ID")) s.name = *id;
  }
  if (s.name.empty())
    throw fail("nrrd.segment", "segment " + std::to_string(number) + " has no name");
  // Files from before label values and shared layers existed: one layer for each segment, with the
  // value 1.
  s.layer = layers > 1 ? number : 0;
  const auto whole = [&](const char* name, int& value, int least, int most) {
    const std::string* const text = find(name);
    if (text == nullptr) return;
    const auto n = numberIn<int>(trimmed(*text));
    if (!n || *n < least || *n > most) throw wrong(name, *text);
    value = *n;
  };
  whole("LabelValue", s.stored, 1, std::numeric_limits<int>::max());
  whole("Layer", s.layer, 0, std::numeric_limits<int>::max());
  if (s.layer >= layers) {
    throw fail("nrrd.segment",
               "segment '" + s.name + "' is in layer " + std::to_string(s.layer) + " (from 0) of " +
                   std::to_string(layers),
               "save the segmentation again");
  }
  if (const std::string* text = find("Color")) {
    const auto c = numbersIn<float>(*text);
    const auto in_range = [](float v) { return v >= 0.0F && v <= 1.0F; };
    if (!c || c->size() != 3 || !std::all_of(c->begin(), c->end(), in_range)) {
      throw wrong("Color", *text);
    }
    s.color = LabelColor{(*c)[0], (*c)[1], (*c)[2]};
  }
  if (const std::string* text = find("Tags")) s.code = codeIn(*text);
  if (const std::string* text = find("Extent")) {
    const auto e = numbersIn<int>(*text);
    if (!e || e->size() != 6) throw wrong("Extent", *text);
    s.extent.emplace();
    std::copy(e->begin(), e->end(), s.extent->begin());
  }
  segments_.push_back(std::move(s));
}

Segments::Segments(const std::map<std::string, std::string>& pairs, int layers, std::string path)
    : path_(std::move(path)) {
  std::set<int> numbers;
  for (const auto& [key, value] : pairs) {
    if (const auto number = numberOfKey(key)) numbers.insert(*number);
  }
  for (const int number : numbers) readOne(pairs, number, layers);
  numberLabels();
}

void Segments::numberLabels() {
  int next = 1;
  for (const Segment& s : segments_) next = std::max(next, s.stored + 1);
  std::set<int> taken;
  std::set<std::pair<int, int>> places;
  for (Segment& s : segments_) {
    if (!places.emplace(s.layer, s.stored).second) {
      throw fail("nrrd.segment",
                 "segment '" + s.name + "' has label value " + std::to_string(s.stored) +
                     " in layer " + std::to_string(s.layer) + ", as another segment has",
                 "give each segment of a layer a value of its own");
    }
    s.label = taken.contains(s.stored) ? next++ : s.stored;
    taken.insert(s.label);
    if (s.label != s.stored) {
      notes_.push_back("segment '" + s.name + "' of layer " + std::to_string(s.layer) +
                       " has label value " + std::to_string(s.stored) +
                       ", as a segment of another layer: it is label " + std::to_string(s.label) +
                       " here");
    }
  }
}

LabelTable Segments::table() const {
  LabelTable table;
  for (const Segment& s : segments_) {
    table.names[s.label] = s.name;
    if (s.color) table.colors[s.label] = *s.color;
  }
  return table;
}

LabelCodes Segments::codes() const {
  LabelCodes codes;
  for (const Segment& s : segments_) {
    if (s.code) codes[s.label] = *s.code;
  }
  return codes;
}

std::vector<float> Segments::merged(const std::vector<std::vector<float>>& layers,
                                    const std::array<int, 3>& size, double voxel_volume,
                                    std::vector<std::string>& notes) const {
  std::vector<std::map<int, const Segment*>> by_value(layers.size());
  for (const Segment& s : segments_) by_value[static_cast<std::size_t>(s.layer)][s.stored] = &s;
  std::vector<float> out(layers.front().size(), 0.0F);
  Overlaps overlaps;
  std::vector<const Segment*> here;
  std::uint64_t shared = 0;
  std::uint64_t unnamed = 0;
  std::size_t at = 0;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++at) {
        const Segment* last = nullptr;
        here.clear();
        for (std::size_t layer = 0; layer < layers.size(); ++layer) {
          const float value = layers[layer][at];
          if (value == 0.0F) continue;
          const auto found = by_value[layer].find(static_cast<int>(value));
          if (found == by_value[layer].end() || static_cast<float>(found->first) != value) {
            if (layers.size() > 1) {
              throw fail("nrrd.segment",
                         "a voxel of layer " + std::to_string(layer) + " has the value " +
                             std::to_string(value) + ", which no segment has",
                         "save the segmentation again");
            }
            out[at] = value;
            ++unnamed;
            continue;
          }
          const Segment& s = *found->second;
          const int index[3] = {i, j, k};
          for (std::size_t a = 0; s.extent && a < 3; ++a) {
            const int first = (*s.extent)[2 * a];
            const int end = (*s.extent)[2 * a + 1];
            if (index[a] < first || index[a] > end) {
              throw fail("nrrd.segment_extent",
                         "segment '" + s.name + "' has voxel " + std::to_string(i) + ", " +
                             std::to_string(j) + ", " + std::to_string(k) +
                             ", which is outside of its own Segment" + std::to_string(s.number) +
                             "_Extent",
                         "save the segmentation again");
            }
          }
          here.push_back(&s);
          if (last == nullptr || last->number < s.number) last = &s;
        }
        if (last == nullptr) continue;
        shared += here.size() > 1 ? 1 : 0;
        for (const Segment* const one : here) {
          if (one != last) overlaps.add(last->label, one->label, 1);
        }
        out[at] = static_cast<float>(last->label);
      }
    }
  }
  overlaps.tell(shared, "are in several segments; each goes to the later segment in the file",
                table().names, voxel_volume, notes);
  if (unnamed > 0) {
    notes.push_back(std::to_string(unnamed) + " voxels have values that no segment has");
  }
  return out;
}

}  // namespace palpate::vdb
