#include "palpate/vdb/label_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/vdb/text.h"
#include "survey/label_runs.h"

namespace palpate::vdb {
namespace {

constexpr int kMostLabel = 65535;
/// Gray values change at nearly every voxel, labels at one in dozens.
constexpr std::uint64_t kVoxelsPerRun = 4;
constexpr std::size_t kFewLabels = 64;

[[noreturn]] void failNotLabels(const Image& image, const std::string& what) {
  throw inputError("labels.not_labels", what,
                   "give the image of the segmentation, not that of the scan", image.source);
}

std::string placeOf(const Image& image, std::size_t voxel) {
  const auto nx = static_cast<std::size_t>(image.size[0]);
  const auto ny = static_cast<std::size_t>(image.size[1]);
  return "voxel (" + std::to_string(voxel % nx) + ", " + std::to_string(voxel / nx % ny) + ", " +
         std::to_string(voxel / nx / ny) + ")";
}

Vec3 centerOf(const Image& image, std::size_t voxel) {
  const auto nx = static_cast<std::size_t>(image.size[0]);
  const auto ny = static_cast<std::size_t>(image.size[1]);
  const std::size_t row = voxel / nx;
  const std::size_t slice = row / ny;
  return image.toWorld(Vec3(static_cast<double>(voxel % nx), static_cast<double>(row % ny),
                            static_cast<double>(slice)));
}

/// Number of faces between two pieces, across i, j and k.
using Faces = std::array<std::uint64_t, 3>;

class Survey {
 public:
  Survey(const Image& image, std::size_t regions) : image_(image) {
    survey_.regions.resize(regions + 2);
    for (int axis = 0; axis < 3; ++axis) {
      face_area_[static_cast<std::size_t>(axis)] =
          glm::length(glm::cross(image.axes[(axis + 1) % 3], image.axes[(axis + 2) % 3]));
    }
  }

  LabelSurvey make(std::shared_ptr<const LabelRuns> runs, const Progress& progress) {
    addPieces(*runs);
    report(progress, "labels", 0.8);
    addContacts(*runs);
    for (LabelSurvey::Region& region : survey_.regions) {
      std::stable_sort(region.pieces.begin(), region.pieces.end(),
                       [](const auto& a, const auto& b) { return a.voxels > b.voxels; });
      std::stable_sort(region.contacts.begin(), region.contacts.end(),
                       [](const auto& a, const auto& b) { return a.area > b.area; });
    }
    findNesting();
    survey_.runs = std::move(runs);
    report(progress, "labels", 1.0);
    return std::move(survey_);
  }

 private:
  void addPieces(const LabelRuns& runs) {
    const double voxel = std::abs(glm::determinant(image_.axes));
    const auto& pieces = runs.pieces();
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      LabelSurvey::Region& region = survey_.regions[pieces[p].number];
      region.voxels += pieces[p].voxels;
      region.at_border = region.at_border || pieces[p].at_border;
      region.pieces.push_back({pieces[p].voxels, centerOf(image_, pieces[p].seed),
                               pieces[p].at_border, survey_.outside(), p});
    }
    for (LabelSurvey::Region& region : survey_.regions) {
      region.volume = static_cast<double>(region.voxels) * voxel;
    }
    const auto nx = static_cast<std::size_t>(image_.size[0]);
    runs.forEachRun([&](std::size_t piece, std::size_t first, std::size_t voxels) {
      Box3& bounds = survey_.regions[pieces[piece].number].bounds;
      bounds.include(centerOf(image_, first));
      if (voxels > 1) bounds.include(centerOf(image_, first / nx * nx + first % nx + voxels - 1));
      addBorder(pieces[piece].number, first, voxels);
    });
  }

  /// The image's border counts as contact with the outside.
  void addBorder(std::size_t region, std::size_t first, std::size_t voxels) {
    if (region == survey_.outside()) return;
    const auto nx = static_cast<std::size_t>(image_.size[0]);
    const auto ny = static_cast<std::size_t>(image_.size[1]);
    const auto nz = static_cast<std::size_t>(image_.size[2]);
    const std::size_t i = first % nx;
    const std::size_t j = first / nx % ny;
    const std::size_t k = first / nx / ny;
    Faces faces{};
    faces[0] = (i == 0 ? 1U : 0U) + (i + voxels == nx ? 1U : 0U);
    faces[1] = ((j == 0 ? 1U : 0U) + (j + 1 == ny ? 1U : 0U)) * voxels;
    faces[2] = ((k == 0 ? 1U : 0U) + (k + 1 == nz ? 1U : 0U)) * voxels;
    if (faces[0] + faces[1] + faces[2] == 0) return;
    addFaces(region, survey_.outside(), faces);
    survey_.regions[region].border += areaOf(faces);
  }

  /// [m2] For a surface of all directions, faces have 3/2 of its area on average.
  [[nodiscard]] double areaOf(const Faces& faces) const {
    double area = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      area += static_cast<double>(faces[axis]) * face_area_[axis] * (2.0 / 3.0);
    }
    return area;
  }

  void addFaces(std::size_t a, std::size_t b, const Faces& faces) {
    Faces& sum = between_[std::min(a, b) << 32U | std::max(a, b)];
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += faces[axis];
  }

  void addContacts(const LabelRuns& runs) {
    const auto& pieces = runs.pieces();
    // The survey determines the surroundings of each small piece.
    std::vector<std::unordered_map<std::size_t, std::uint64_t>> around(pieces.size());
    runs.forEachContact([&](std::size_t a, std::size_t b, int axis, int faces) {
      Faces these{};
      these[static_cast<std::size_t>(axis)] = static_cast<std::uint64_t>(faces);
      addFaces(pieces[a].number, pieces[b].number, these);
      around[a][pieces[b].number] += static_cast<std::uint64_t>(faces);
      around[b][pieces[a].number] += static_cast<std::uint64_t>(faces);
    });
    for (LabelSurvey::Region& region : survey_.regions) {
      for (LabelSurvey::Piece& piece : region.pieces) {
        std::uint64_t most = 0;
        for (const auto& [other, faces] : around[piece.id]) {
          if (faces > most || (faces == most && other < piece.around)) {
            most = faces;
            piece.around = other;
          }
        }
      }
    }
    for (const auto& [pair, faces] : between_) {
      const auto a = static_cast<std::size_t>(pair >> 32U);
      const auto b = static_cast<std::size_t>(pair & 0xFFFFFFFFU);
      const double area = areaOf(faces);
      survey_.regions[a].contacts.push_back({b, area});
      survey_.regions[b].contacts.push_back({a, area});
      survey_.regions[a].area += area;
      survey_.regions[b].area += area;
    }
  }

  /// Whether a region touches the outside elsewhere than at the image's border.
  [[nodiscard]] bool isOpen(const LabelSurvey::Contact& of_outside) const {
    const double border = survey_.regions[of_outside.other].border;
    return survey_.regions[survey_.outside()].voxels == 0 ||
           of_outside.area - border > 1e-9 * of_outside.area;
  }

  /// The regions that can be reached from outside if `without` blocks the way.
  [[nodiscard]] std::vector<bool> reached(std::size_t without) const {
    std::vector<bool> seen(survey_.regions.size(), false);
    std::vector<std::size_t> stack{survey_.outside()};
    seen[survey_.outside()] = true;
    while (!stack.empty()) {
      const std::size_t here = stack.back();
      stack.pop_back();
      for (const LabelSurvey::Contact& contact : survey_.regions[here].contacts) {
        if (contact.other == without || seen[contact.other]) continue;
        if (here == survey_.outside() && !isOpen(contact)) continue;
        seen[contact.other] = true;
        stack.push_back(contact.other);
      }
    }
    return seen;
  }

  void findNesting() {
    const std::size_t count = survey_.outside();
    std::vector<std::vector<std::size_t>> encloses(count);
    std::vector<std::size_t> depth(count, 0);
    for (std::size_t one = 0; one < count; ++one) {
      if (survey_.regions[one].voxels == 0) continue;
      const std::vector<bool> seen = reached(one);
      for (std::size_t other = 0; other < count; ++other) {
        if (other == one || seen[other] || survey_.regions[other].voxels == 0) continue;
        encloses[one].push_back(other);
        ++depth[other];
      }
    }
    // Regions that enclose one region also enclose each other: the innermost is the one inside most
    // others.
    for (std::size_t one = 0; one < count; ++one) {
      for (const std::size_t other : encloses[one]) {
        auto& within = survey_.regions[other].within;
        if (!within || depth[one] > depth[*within]) within = one;
      }
    }
  }

  const Image& image_;
  std::array<double, 3> face_area_{};  // [m2]
  std::unordered_map<std::uint64_t, Faces> between_;
  LabelSurvey survey_;
};

}  // namespace

std::map<int, std::uint64_t> countLabels(const Image& image) {
  struct Counts {
    std::vector<std::uint64_t> of = std::vector<std::uint64_t>(kMostLabel + 1, 0);
    std::uint64_t runs = 0;
    std::size_t wrong = std::numeric_limits<std::size_t>::max();
  };
  tbb::combinable<Counts> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, image.values.size(), 1U << 16U),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      Counts& counts = parts.local();
                      // No voxel equals NaN, whatever the image holds.
                      constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
                      float last = kNone;
                      std::uint64_t run = 0;
                      const auto end_run = [&] {
                        if (run > 0) counts.of[static_cast<std::size_t>(last)] += run;
                      };
                      for (std::size_t n = range.begin(); n != range.end(); ++n) {
                        const float value = image.values[n];
                        if (value == last) {
                          ++run;
                          continue;
                        }
                        end_run();
                        ++counts.runs;
                        run = 0;
                        // Written so that NaN fails too.
                        if (!(value >= 0.0F && value <= static_cast<float>(kMostLabel) &&
                              std::floor(value) == value)) {
                          counts.wrong = std::min(counts.wrong, n);
                          last = kNone;
                          continue;
                        }
                        last = value;
                        run = 1;
                      }
                      end_run();
                    });
  Counts all;
  parts.combine_each([&](const Counts& part) {
    for (std::size_t label = 0; label < part.of.size(); ++label) all.of[label] += part.of[label];
    all.runs += part.runs;
    all.wrong = std::min(all.wrong, part.wrong);
  });
  if (all.wrong < image.values.size()) {
    failNotLabels(image, std::string("this is not a label image: ") + placeOf(image, all.wrong) +
                             " is " + shortNumber(image.values[all.wrong], 9) +
                             ", and labels are whole numbers from 0 to " +
                             std::to_string(kMostLabel));
  }
  std::map<int, std::uint64_t> counts;
  for (std::size_t label = 0; label < all.of.size(); ++label) {
    if (all.of[label] > 0) counts.emplace(static_cast<int>(label), all.of[label]);
  }
  if (counts.size() > kFewLabels && all.runs * kVoxelsPerRun > image.values.size()) {
    failNotLabels(image, "this is not a label image: it has " + std::to_string(counts.size()) +
                             " values, which change with almost every voxel");
  }
  return counts;
}

LabelSurvey surveyLabels(const Image& image, const std::vector<std::vector<int>>& regions,
                         const VoxelMask* body, const Progress& progress) {
  report(progress, "labels", 0.0);
  const auto gap = static_cast<LabelRuns::Number>(regions.size());
  const auto outside = static_cast<LabelRuns::Number>(regions.size() + 1);
  std::vector<LabelRuns::Number> number_of(kMostLabel + 1, outside);
  for (std::size_t region = 0; region < regions.size(); ++region) {
    for (const int label : regions[region]) {
      number_of.at(static_cast<std::size_t>(label)) = static_cast<LabelRuns::Number>(region);
    }
  }
  const auto nx = static_cast<std::size_t>(image.size[0]);
  auto runs = std::make_shared<LabelRuns>(image.size, [&](int j, int k, LabelRuns::Number* row) {
    const std::size_t at =
        nx * (static_cast<std::size_t>(j) +
              static_cast<std::size_t>(image.size[1]) * static_cast<std::size_t>(k));
    for (std::size_t i = 0; i < nx; ++i) {
      row[i] = number_of[static_cast<std::size_t>(image.values[at + i])];
      if (row[i] == outside && body != nullptr && (*body)[at + i] != 0) row[i] = gap;
    }
  });
  report(progress, "labels", 0.4);
  runs->findPieces([&](LabelRuns::Number number) { return number >= gap; });
  report(progress, "labels", 0.6);
  return Survey(image, regions.size()).make(std::move(runs), progress);
}

std::vector<IslandChange> changeIslands(Image& image, const std::vector<std::vector<int>>& regions,
                                        const LabelSurvey& survey, std::uint64_t smaller_than,
                                        IslandRule rule) {
  std::vector<IslandChange> changes;
  constexpr float kAsItIs = -1.0F;
  std::vector<float> becomes(survey.runs->pieces().size(), kAsItIs);
  const auto label_of = [&](std::size_t region) {
    return region < regions.size() ? static_cast<float>(regions[region].front()) : 0.0F;
  };
  for (std::size_t region = 0; region < survey.regions.size(); ++region) {
    const bool is_labelled = region < regions.size();
    const auto& pieces = survey.regions[region].pieces;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      const LabelSurvey::Piece& piece = pieces[p];
      if (piece.voxels >= smaller_than) continue;
      std::size_t to = piece.around;
      if (is_labelled) {
        if (p == 0) continue;
        if (rule == IslandRule::kDrop) to = survey.gap();
      } else if (piece.at_border || rule == IslandRule::kDrop || to >= regions.size()) {
        continue;  // its surroundings have no label either, or it is not a cavity
      }
      becomes[piece.id] = label_of(to);
      changes.push_back({region, to, piece.voxels, piece.place});
    }
  }
  if (changes.empty()) return changes;
  survey.runs->forEachRun([&](std::size_t piece, std::size_t first, std::size_t voxels) {
    if (becomes[piece] == kAsItIs) return;
    std::fill_n(image.values.begin() + static_cast<std::ptrdiff_t>(first), voxels, becomes[piece]);
  });
  std::stable_sort(changes.begin(), changes.end(),
                   [](const auto& a, const auto& b) { return a.voxels > b.voxels; });
  return changes;
}

}  // namespace palpate::vdb
