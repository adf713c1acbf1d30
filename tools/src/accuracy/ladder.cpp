#include "accuracy/ladder.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "palpate/vdb/bake.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kStrokes = 20;
constexpr std::size_t kStrokeLength = 1000;  ///< points
constexpr std::size_t kColdPerRepeat = 3;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The points of timed queries: along the strokes, rising and falling within half the band.
std::vector<Vec3> timedPath(const std::vector<Stroke>& strokes, double band) {
  std::vector<Vec3> path;
  for (const Stroke& stroke : strokes) {
    for (const JudgedPoint& point : stroke.points) {
      const double height = 0.5 * band * std::sin(0.05 * static_cast<double>(path.size()));
      path.push_back(point.at + height * point.truth.normal);
    }
  }
  return path;
}

/// The places at which the field of a grid is timed and compared.
struct Places {
  PointSet near;
  std::vector<Stroke> strokes;
  std::vector<Vec3> path;       ///< [m]
  std::vector<Vec3> scattered;  ///< [m]
};

Places choosePlaces(const Truth& truth, double voxel, const LadderSettings& settings,
                    const Progress& progress) {
  Places places;
  const double band = settings.band * voxel;
  places.near = pointsNear(truth, band, settings.points, voxel, progress);
  // If the user asks for fewer points, do less work here too.
  const std::size_t strokes = std::clamp<std::size_t>(settings.points / 1000, 2, kStrokes);
  places.strokes =
      strokesAlong(truth, places.near, strokes, kStrokeLength, kStrokeStep, voxel, progress);
  places.path = timedPath(places.strokes, band);
  for (const JudgedPoint& point : places.near.points) places.scattered.push_back(point.at);
  return places;
}

QueryTimes timesOf(const Field& field, const Places& places, const LadderSettings& settings,
                   CacheFlood& flood) {
  return timeQueries(field, places.path, places.scattered, settings.repeats,
                     kColdPerRepeat * static_cast<std::size_t>(settings.repeats), settings.clock_ns,
                     flood);
}

SamplerResult measureSampler(const vdb::LevelSet& grid, vdb::Sampler sampler, const Places& places,
                             const LadderSettings& settings, CacheFlood& flood) {
  SamplerResult out;
  out.sampler = sampler;
  const auto start = Clock::now();
  const FieldPtr field = vdb::gridField(grid, sampler);
  out.make_seconds = secondsSince(start);
  out.memory = vdb::memoryOf(*field);
  out.smooth = errorsAt(*field, places.near.points, true);
  out.near_edges = errorsAt(*field, places.near.points, false);
  out.jitter = jitterOf(*field, places.strokes);
  out.times = timesOf(*field, places, settings, flood);
  return out;
}

Rung measureRung(const AskedField& asked, const Places& places, double voxel,
                 const LadderSettings& settings, CacheFlood& flood, const Progress& progress) {
  Rung rung;
  rung.voxel = voxel;
  rung.points = places.near.points.size();
  rung.without_truth = places.near.without_truth;
  rung.near_edges = static_cast<std::size_t>(
      std::count_if(places.near.points.begin(), places.near.points.end(),
                    [](const JudgedPoint& point) { return !point.smooth; }));

  vdb::BakeOptions bake;
  bake.voxel_size = voxel;
  // The band that the most demanding sampler needs at the outermost points, so that all samplers
  // read the same grid.
  bake.half_width = vdb::kCubicHalfWidth + std::max(0.0, settings.band - 1.0);
  bake.name = asked.name + "/surface";
  vdb::LevelSet grid;
  const auto start = Clock::now();
  try {
    grid = vdb::bake(*asked.field, bake, progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    rung.why = error.problem().message;
    return rung;
  }
  rung.bake_seconds = secondsSince(start);
  rung.half_width = grid.info().half_width;
  rung.active_voxels = grid.info().active_voxels;
  for (const vdb::Sampler sampler : settings.samplers) {
    report(progress, std::string("measuring ") + samplerName(sampler), 0.5);
    rung.samplers.push_back(measureSampler(grid, sampler, places, settings, flood));
  }
  return rung;
}

std::vector<Orders> fitOrders(const std::vector<Rung>& rungs, const LadderSettings& settings) {
  std::vector<Orders> out;
  for (const vdb::Sampler sampler : settings.samplers) {
    std::vector<double> h;
    std::vector<double> value;
    std::vector<double> normal;
    std::vector<double> curvature;
    for (const Rung& rung : rungs) {
      for (const SamplerResult& result : rung.samplers) {
        if (result.sampler != sampler || result.smooth.points == 0) continue;
        h.push_back(rung.voxel);
        value.push_back(result.smooth.value.rms);
        normal.push_back(result.smooth.normal.rms);
        curvature.push_back(result.smooth.curvature.rms);
      }
    }
    out.push_back(
        {sampler, fittedOrder(h, value), fittedOrder(h, normal), fittedOrder(h, curvature)});
  }
  return out;
}

}  // namespace

const char* samplerName(vdb::Sampler sampler) {
  switch (sampler) {
    case vdb::Sampler::kCubic:
      return "cubic";
    case vdb::Sampler::kTrilinear:
      return "trilinear";
    case vdb::Sampler::kAccessor:
      return "accessor";
  }
  return "";
}

FieldResult measureLadder(const AskedField& asked, const LadderSettings& settings,
                          CacheFlood& flood, const Progress& progress) {
  const Truth truth(asked.field);
  FieldResult out;
  out.asked = asked;
  out.projected = truth.projects();
  for (std::size_t i = 0; i < settings.voxels.size(); ++i) {
    const double voxel = settings.voxels[i];
    const Progress inner = [&](std::string_view what, double fraction) {
      return !progress || progress(what, (static_cast<double>(i) + std::max(fraction, 0.0)) /
                                             static_cast<double>(settings.voxels.size()));
    };
    const Places places = choosePlaces(truth, voxel, settings, inner);
    if (i == 0) {
      out.analytic = errorsAt(*asked.field, places.near.points, true,
                              truth.projects() ? ValueIs::kOverSlope : ValueIs::kDistance);
      out.analytic_times = timesOf(*asked.field, places, settings, flood);
    }
    out.rungs.push_back(measureRung(asked, places, voxel, settings, flood, inner));
  }
  out.orders = fitOrders(out.rungs, settings);
  return out;
}

}  // namespace palpate::tools
