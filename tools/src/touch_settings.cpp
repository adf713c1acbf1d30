#include "touch_settings.h"

#include <cmath>

#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

PaperParameters paperParameters(const TouchOptions& o, const LengthUnit& unit) {
  PaperParameters paper;
  if (!o.epsilon.empty()) {
    paper.epsilon = parseLength(o.epsilon, unit, "--epsilon");
    if (!(*paper.epsilon > 0.0)) {
      throw Error(ErrorKind::kUsage, {"usage.touch", "--epsilon must be greater than 0"});
    }
  }
  paper.max_halvings = o.halvings;
  paper.alpha = o.alpha;
  if (o.alpha_form == "by_field") paper.alpha_form = AlphaForm::kByMetric;
  if (o.alpha_form == "printed") paper.alpha_form = AlphaForm::kLength;
  if (o.alpha_form == "newton") paper.alpha_form = AlphaForm::kNewton;
  if (o.interior == "together") paper.interior = PaperInterior::kTogether;
  if (o.interior == "wall") paper.interior = PaperInterior::kWall;
  return paper;
}

double positive(double value, const char* what) {
  if (value > 0.0) return value;
  throw Error(ErrorKind::kUsage, {"usage.touch", std::string(what) + " must be greater than 0",
                                  "leave it out for no limit"});
}

}  // namespace

bool givesPaperParameters(const TouchOptions& o) {
  return !o.epsilon.empty() || o.halvings || o.alpha || !o.alpha_form.empty() ||
         !o.interior.empty();
}

RendererSettings rendererSettings(const TouchOptions& o, const LengthUnit& unit) {
  RendererSettings settings;
  if (o.renderer == "paper") settings.kind = RendererKind::kPaper;
  if (o.renderer == "constraint") settings.kind = RendererKind::kConstraint;
  settings.paper = paperParameters(o, unit);
  settings.limits = forceLimits(o);
  return settings;
}

std::string rendererName(RendererKind kind) {
  return kind == RendererKind::kPaper ? "paper" : "constraint";
}

ForceLimits forceLimits(const TouchOptions& o) {
  ForceLimits limits;
  if (!o.max_force.empty()) {
    limits.max_force = positive(parseForce(o.max_force, "--max-force"), "--max-force");
  }
  if (!o.slew.empty()) limits.max_growth = positive(parseForceRate(o.slew, "--slew"), "--slew");
  if (!o.ramp.empty()) limits.ramp = positive(parseTime(o.ramp, "--ramp"), "--ramp");
  return limits;
}

Json limitsJson(const ForceLimits& limits) {
  const auto or_null = [](double value, bool given) { return given ? Json(value) : Json(); };
  return {{"max_force_N", or_null(limits.max_force, std::isfinite(limits.max_force))},
          {"slew_N_per_s", or_null(limits.max_growth, std::isfinite(limits.max_growth))},
          {"ramp_s", or_null(limits.ramp, limits.ramp > 0.0)}};
}

std::string limitsText(const ForceLimits& limits) {
  std::string text;
  const auto add = [&](bool given, const std::string& part) {
    if (given) text += (text.empty() ? "" : ", ") + part;
  };
  add(std::isfinite(limits.max_force), "at most " + formatNumber(limits.max_force) + " N");
  add(std::isfinite(limits.max_growth),
      "growing by at most " + formatNumber(limits.max_growth) + " N/s");
  add(limits.ramp > 0.0, "from 0 in " + formatSeconds(limits.ramp));
  return text.empty() ? text : "Force       " + text + "\n";
}

}  // namespace palpate::tools
