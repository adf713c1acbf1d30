#pragma once
/// Compares one field with its grids: every sampler at every voxel size.

#include <optional>
#include <string>
#include <vector>

#include "accuracy/compare.h"
#include "accuracy/query_time.h"
#include "asked_fields.h"
#include "palpate/vdb/level_set.h"

namespace palpate::tools {

inline constexpr double kStrokeStep = 0.2e-3;  ///< [m]

struct LadderSettings {
  std::vector<double> voxels;  ///< [m] coarsest first
  std::vector<vdb::Sampler> samplers;
  std::size_t points = 100000;
  double band = 1.0;  ///< [voxels]
  int repeats = 10;
  double clock_ns = 0.0;
};

/// The result of one sampler on one grid.
struct SamplerResult {
  vdb::Sampler sampler = vdb::Sampler::kCubic;
  Errors smooth;      ///< away from edges
  Errors near_edges;  ///< an edge or medial axis within reach of the stencil
  Jitter jitter;
  QueryTimes times;
  std::uint64_t memory = 0;   ///< [bytes] that queries read from
  double make_seconds = 0.0;  ///< [s] time to make the field from the grid
};

/// One voxel size.
struct Rung {
  double voxel = 0.0;  ///< [m]
  /// Not empty: the field cannot be baked at this size, and the members below are unset
  std::string why = {};
  double half_width = 0.0;  ///< [voxels]
  std::uint64_t active_voxels = 0;
  double bake_seconds = 0.0;  ///< [s]
  std::size_t points = 0;
  std::size_t near_edges = 0;     ///< number of points near edges
  std::size_t without_truth = 0;  ///< points left out because the true distance was not found
  std::vector<SamplerResult> samplers = {};
};

/// Exponents p of error = c h^p, fitted to the points away from edges.
struct Orders {
  vdb::Sampler sampler = vdb::Sampler::kCubic;
  std::optional<double> value, normal, curvature;
};

struct FieldResult {
  AskedField asked;
  bool projected = false;  ///< the truth is the exact distance by projection, not the field's value
  /// Errors of the field itself, at the points of the coarsest voxel size; of its value over its
  /// slope if it is implicit.
  Errors analytic;
  QueryTimes analytic_times;
  std::vector<Rung> rungs = {};
  std::vector<Orders> orders = {};
};

/// Compares a field, which must be bounded, with its grids. @throws Error.
[[nodiscard]] FieldResult measureLadder(const AskedField& asked, const LadderSettings& settings,
                                        CacheFlood& flood, const Progress& progress);

[[nodiscard]] const char* samplerName(vdb::Sampler sampler);

}  // namespace palpate::tools
