#include "accuracy/accuracy_report.h"

#include <cmath>

namespace palpate::tools {
namespace {

std::string truthText(const FieldResult& result) {
  return result.projected ? "the exact distance, by projection onto the zero set"
                          : "the field's own value";
}

Json spreadJson(const Spread& spread, double unit = 1.0) {
  return {{"rms", spread.rms / unit}, {"max", spread.most / unit}};
}

Json errorsJson(const Errors& errors, double voxel) {
  if (errors.points == 0 && errors.out_of_band == 0) return {};
  Json json = {{"points", errors.points},
               {"out_of_band", errors.out_of_band},
               {"value_error_m", spreadJson(errors.value)}};
  if (voxel > 0.0) json["value_error_voxels"] = spreadJson(errors.value, voxel);
  json["normal_error_degrees"] = spreadJson(errors.normal);
  json["curvature_error_per_m"] = spreadJson(errors.curvature);
  return json;
}

Json timesJson(const QueryTimes& times) {
  return {{"independent", times.independent}, {"dependent", times.dependent}, {"cold", times.cold}};
}

Json samplerJson(const SamplerResult& result, double voxel) {
  Json jitter = {{"points", result.jitter.points},
                 {"rms", result.jitter.field.rms},
                 {"max", result.jitter.field.most},
                 {"true_rms", result.jitter.truth.rms},
                 {"true_max", result.jitter.truth.most}};
  return {{"sampler", samplerName(result.sampler)},
          {"smooth", errorsJson(result.smooth, voxel)},
          {"near_edges", errorsJson(result.near_edges, voxel)},
          {"jitter", result.jitter.points > 0 ? std::move(jitter) : Json()},
          {"query_ns", timesJson(result.times)},
          {"memory_bytes", result.memory},
          {"make_seconds", result.make_seconds}};
}

Json rungJson(const Rung& rung) {
  Json json = {{"voxel_size_m", rung.voxel}};
  if (!rung.why.empty()) {
    json["why_not"] = rung.why;
    return json;
  }
  json["half_width_voxels"] = rung.half_width;
  json["active_voxels"] = rung.active_voxels;
  json["bake_seconds"] = rung.bake_seconds;
  json["points"] = rung.points;
  json["points_near_edges"] = rung.near_edges;
  json["points_without_truth"] = rung.without_truth;
  json["samplers"] = Json::array();
  for (const SamplerResult& result : rung.samplers) {
    json["samplers"].push_back(samplerJson(result, rung.voxel));
  }
  return json;
}

Json optionalJson(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

/// Three digits: further digits would change with the choice of points.
std::string brief(double value) { return formatNumber(value, 3); }

/// RMS and max as cells; dashes if nothing was compared.
void addSpread(std::vector<std::string>& row, const Spread& spread, double unit, bool any) {
  row.push_back(any ? brief(spread.rms / unit) : "-");
  row.push_back(any ? brief(spread.most / unit) : "-");
}

std::vector<std::string> errorCells(const Errors& errors, double voxel, const LengthUnit& unit) {
  const bool any = errors.points > 0;
  std::vector<std::string> row = {std::to_string(errors.points)};
  addSpread(row, errors.value, unit.meters, any);
  if (voxel > 0.0) {
    addSpread(row, errors.value, voxel, any);
  } else {
    row.insert(row.end(), {"-", "-"});
  }
  addSpread(row, errors.normal, 1.0, any);
  addSpread(row, errors.curvature, 1.0 / unit.meters, any);
  return row;
}

std::vector<std::string> errorHeading(const LengthUnit& unit) {
  return {"voxel " + unit.name,
          "sampler",
          "points",
          "value " + unit.name + " rms",
          "max",
          "voxels rms",
          "max",
          "normal deg rms",
          "max",
          "curvature 1/" + unit.name + " rms",
          "max"};
}

void join(std::vector<std::string>& row, const std::vector<std::string>& more) {
  row.insert(row.end(), more.begin(), more.end());
}

std::string errorTable(const FieldResult& result, const LengthUnit& unit) {
  std::vector<std::string> heading = errorHeading(unit);
  join(heading, {"jitter max", "true"});
  Table table(heading);
  std::vector<std::string> itself = {"-", "analytic"};
  join(itself, errorCells(result.analytic, 0.0, unit));
  join(itself, {"-", "-"});
  table.add(itself);
  for (const Rung& rung : result.rungs) {
    for (const SamplerResult& s : rung.samplers) {
      std::vector<std::string> row = {brief(rung.voxel / unit.meters), samplerName(s.sampler)};
      join(row, errorCells(s.smooth, rung.voxel, unit));
      const bool any = s.jitter.points > 0;
      join(row, {any ? brief(s.jitter.field.most) : "-", any ? brief(s.jitter.truth.most) : "-"});
      table.add(row);
    }
  }
  return table.text("  ");
}

std::string edgeTable(const FieldResult& result, const LengthUnit& unit) {
  Table table(errorHeading(unit));
  for (const Rung& rung : result.rungs) {
    if (rung.near_edges == 0) continue;
    for (const SamplerResult& s : rung.samplers) {
      std::vector<std::string> row = {brief(rung.voxel / unit.meters), samplerName(s.sampler)};
      join(row, errorCells(s.near_edges, rung.voxel, unit));
      table.add(row);
    }
  }
  return table.empty()
             ? ""
             : "Near edges (within " + brief(kStencilReach) + " voxels)\n" + table.text("  ");
}

std::string costTable(const FieldResult& result, const LengthUnit& unit) {
  Table table({"voxel " + unit.name, "sampler", "independent ns", "dependent ns", "cold ns",
               "memory", "active voxels", "bake", "make"});
  const auto ns = [](double value) { return formatNumber(value, value < 100.0 ? 3 : 4); };
  const auto times = [&](const QueryTimes& t) {
    return std::vector<std::string>{ns(t.independent), ns(t.dependent), ns(t.cold)};
  };
  std::vector<std::string> itself = {"-", "analytic"};
  join(itself, times(result.analytic_times));
  join(itself, {"-", "-", "-", "-"});
  table.add(itself);
  for (const Rung& rung : result.rungs) {
    for (const SamplerResult& s : rung.samplers) {
      std::vector<std::string> row = {brief(rung.voxel / unit.meters), samplerName(s.sampler)};
      join(row, times(s.times));
      join(row, {formatBytes(s.memory), formatCount(rung.active_voxels),
                 formatSeconds(rung.bake_seconds), formatSeconds(s.make_seconds)});
      table.add(row);
    }
  }
  return table.text("  ");
}

std::string optionalText(const std::optional<double>& value) {
  return value ? formatNumber(*value, 3) : "-";
}

std::string ordersText(const FieldResult& result) {
  Table table({"order in the voxel size", "value", "normal", "curvature"});
  for (const Orders& o : result.orders) {
    table.add({samplerName(o.sampler), optionalText(o.value), optionalText(o.normal),
               optionalText(o.curvature)});
  }
  return table.text("  ");
}

std::string leftOutText(const FieldResult& result, const LengthUnit& unit) {
  std::string text;
  for (const Rung& rung : result.rungs) {
    const std::string size = "  " + brief(rung.voxel / unit.meters) + " " + unit.name + ": ";
    if (!rung.why.empty()) text += size + "not done: " + rung.why + "\n";
    if (rung.without_truth > 0) {
      text += size + std::to_string(rung.without_truth) +
              " more points left out, because the true distance was not found there\n";
    }
    for (const SamplerResult& s : rung.samplers) {
      const std::size_t out = s.smooth.out_of_band + s.near_edges.out_of_band;
      if (out > 0) {
        text += size + samplerName(s.sampler) + ": " + std::to_string(out) +
                " points left out, because they are out of its band\n";
      }
    }
  }
  return text;
}

}  // namespace

Json accuracyJson(const FieldResult& result) {
  Json json = {{"field", result.asked.name},
               {"layer", result.asked.layer},
               {"metric", metricName(result.asked.field->metric())},
               {"source", result.asked.source.empty() ? Json() : Json(result.asked.source)},
               {"truth", result.projected ? "projection" : "field"},
               {"analytic",
                {{"errors", errorsJson(result.analytic, 0.0)},
                 {"query_ns", timesJson(result.analytic_times)}}},
               {"grids", Json::array()},
               {"orders", Json::array()}};
  for (const Rung& rung : result.rungs) json["grids"].push_back(rungJson(rung));
  for (const Orders& o : result.orders) {
    json["orders"].push_back({{"sampler", samplerName(o.sampler)},
                              {"value", optionalJson(o.value)},
                              {"normal", optionalJson(o.normal)},
                              {"curvature", optionalJson(o.curvature)}});
  }
  return json;
}

std::string accuracyText(const FieldResult& result, const LengthUnit& unit) {
  std::string text = result.asked.name + " (" + metricName(result.asked.field->metric()) +
                     "); the truth is " + truthText(result) + "\n\n";
  text += errorTable(result, unit) + "\n";
  const std::string edges = edgeTable(result, unit);
  if (!edges.empty()) text += edges + "\n";
  text += costTable(result, unit) + "\n" + ordersText(result);
  const std::string left_out = leftOutText(result, unit);
  if (!left_out.empty()) text += "\n" + left_out;
  return text;
}

std::string accuracyCsv(const std::vector<FieldResult>& results) {
  std::string text =
      "field,voxel_m,sampler,near_edges,points,out_of_band,value_rms_m,value_max_m,"
      "value_rms_voxels,value_max_voxels,normal_rms_degrees,normal_max_degrees,"
      "curvature_rms_per_m,curvature_max_per_m,jitter_rms,jitter_max,true_jitter_rms,"
      "true_jitter_max,independent_ns,dependent_ns,cold_ns,memory_bytes,active_voxels,"
      "bake_s,make_s\n";
  for (const FieldResult& result : results) {
    for (const Rung& rung : result.rungs) {
      for (const SamplerResult& s : rung.samplers) {
        for (const bool edges : {false, true}) {
          const Errors& e = edges ? s.near_edges : s.smooth;
          if (e.points + e.out_of_band == 0) continue;
          text += result.asked.name + "," + formatNumber(rung.voxel, 9) + "," +
                  samplerName(s.sampler) + (edges ? ",1," : ",0,") + std::to_string(e.points) +
                  "," + std::to_string(e.out_of_band);
          for (const double value :
               {e.value.rms, e.value.most, e.value.rms / rung.voxel, e.value.most / rung.voxel,
                e.normal.rms, e.normal.most, e.curvature.rms, e.curvature.most, s.jitter.field.rms,
                s.jitter.field.most, s.jitter.truth.rms, s.jitter.truth.most, s.times.independent,
                s.times.dependent, s.times.cold}) {
            text += "," + formatNumber(value, 9);
          }
          text += "," + std::to_string(s.memory) + "," + std::to_string(rung.active_voxels) + "," +
                  formatNumber(rung.bake_seconds, 9) + "," + formatNumber(s.make_seconds, 9) + "\n";
        }
      }
    }
  }
  return text;
}

}  // namespace palpate::tools
