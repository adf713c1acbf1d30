#include "budget_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/core/text.h"
#include "palpate/devices/device_presets.h"
#include "text.h"

namespace palpate::tools {
namespace {

using devices::BudgetItem;
using devices::BudgetTerm;
using devices::FeltAs;

const char* kindName(FeltAs kind) {
  switch (kind) {
    case FeltAs::kWall:
      return "wall";
    case FeltAs::kSheet:
      return "sheet";
    case FeltAs::kContent:
      return "content";
    case FeltAs::kNeedle:
      break;
  }
  return "needle";
}

bool isSpring(const BudgetItem& each) { return each.item.most.stiffness > 0.0; }
const char* unitOf(const BudgetItem& each) { return isSpring(each) ? " N/m" : " N.s/m"; }
double askedOf(const BudgetItem& each) {
  return isSpring(each) ? each.item.most.stiffness : each.item.most.damping;
}

const char* nameOf(BudgetTerm term) { return term == BudgetTerm::kFriction ? "encoder" : "linear"; }
/// The rule that decides the budget; encoder friction does not limit a drag.
const char* ruleOf(const BudgetItem& each) {
  return nameOf(isSpring(each) ? each.budget.ruledBy() : BudgetTerm::kLinear);
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }
std::string number(double value) { return std::isfinite(value) ? formatNumber(value, 4) : "-"; }

std::string nameOf(const BudgetItem& each) {
  return each.item.material + "." + each.item.parameter;
}

std::string sizeOf(double share) {
  return std::isfinite(share) ? formatNumber(share, 3) + " times its budget" : "beyond any budget";
}

/// Ways to get below the budget, listed one after another.
std::string cures(const BudgetItem& each) {
  std::string text;
  const auto add = [&](bool given, const std::string& part) {
    if (given) text += (text.empty() ? "" : "; or ") + part;
  };
  add(each.allowed > 0.0,
      "at most " + formatNumber(each.allowed, 3) + unitOf(each) + " at the hand");
  add(std::isfinite(each.rate), formatNumber(each.rate, 3) + " Hz or more");
  add(each.force > 0.0 && each.item.length > 0.0,
      "at most " + formatNumber(1e3 * each.force * each.item.length, 2) + " mm of shaft in it");
  add(each.force > 0.0,
      "forces " + formatNumber(each.force, 2) + " times as large (`device: {force: ...}`)");
  std::string hands;
  for (const std::string& hand : each.hands) hands += (hands.empty() ? "" : " or ") + hand;
  add(!hands.empty(), "a hand that is " + hands);
  return text.empty() ? "nothing that palpate knows of" : text;
}

struct HandLimits {
  std::string hand;
  devices::StabilityBudget budget;
};

std::vector<HandLimits> limitsByHand(devices::LoopModel loop) {
  std::vector<HandLimits> all;
  loop.hand.reset();
  all.push_back({"none", devices::budgetOf(loop)});
  for (const devices::HandPreset& hand : devices::handPresets()) {
    loop.hand = hand.model;
    all.push_back({std::string(hand.name), devices::budgetOf(loop)});
  }
  return all;
}

}  // namespace

Json handLimitsJson(const devices::LoopModel& loop) {
  Json json = Json::array();
  for (const HandLimits& each : limitsByHand(loop)) {
    json.push_back({{"hand", each.hand},
                    {"linear_N_per_m", finite(each.budget.linear)},
                    {"passive_N_per_m", finite(each.budget.passive)},
                    {"encoder_N_per_m", finite(each.budget.friction)},
                    {"budget_N_per_m", each.budget.stiffness()},
                    {"ruled_by", nameOf(each.budget.ruledBy())}});
  }
  return json;
}

Table handLimitsTable(const devices::LoopModel& loop) {
  Table table({"hand (assumed)", "linear limit", "passive up to", "encoder limit", "budget, N/m"});
  for (const HandLimits& each : limitsByHand(loop)) {
    table.add({each.hand, number(each.budget.linear), number(each.budget.passive),
               number(each.budget.friction),
               number(each.budget.stiffness()) + " (" + nameOf(each.budget.ruledBy()) + ")"});
  }
  return table;
}

std::string handLimitsText(const devices::LoopModel& loop) {
  return "Walls without damping\n" + handLimitsTable(loop).text("  ");
}

std::string delayText(int delay) {
  if (delay == 0) return {};
  return ", " + std::to_string(delay) + (delay == 1 ? " sample" : " samples") + " of delay";
}

Json budgetJson(std::span<const BudgetItem> items) {
  Json json = Json::array();
  for (const BudgetItem& each : items) {
    Json item = {{"kind", kindName(each.item.kind)},
                 {"material", each.item.material},
                 {"parameter", each.item.parameter},
                 {"places", each.item.places},
                 {"shaft_m", each.item.length > 0.0 ? Json(each.item.length) : Json()},
                 {"note", each.item.note.empty() ? Json() : Json(each.item.note)},
                 {"stiffness_N_per_m", each.item.most.stiffness},
                 {"damping_N_s_per_m", each.item.most.damping},
                 {"linear_N_per_m", finite(each.budget.linear)},
                 {"passive_N_per_m", finite(each.budget.passive)},
                 {"encoder_N_per_m", finite(each.budget.friction)},
                 {"ruled_by", ruleOf(each)},
                 {isSpring(each) ? "allowed_N_per_m" : "allowed_N_s_per_m", each.allowed},
                 {"share", finite(each.share)},
                 {"above", each.isAbove()},
                 {"cure", Json()}};
    if (each.isAbove()) {
      item["quiet_up_to_m_per_s"] = finite(each.quiet_speed);
      item["cure"] = {{"rate_Hz", finite(each.rate)},
                      {"force_share", each.force},
                      {"hands", each.hands},
                      {"missing_damping_N_s_per_m", finite(each.missing_damping)}};
    }
    json.push_back(std::move(item));
  }
  return json;
}

Table budgetTable(std::span<const BudgetItem> items) {
  Table table({"felt as", "parameter", "at the hand", "linear limit", "passive up to",
               "encoder limit", "budget", "takes"});
  for (const BudgetItem& each : items) {
    const bool is_spring = isSpring(each);
    table.add({kindName(each.item.kind), nameOf(each), number(askedOf(each)) + unitOf(each),
               is_spring ? number(each.budget.linear) : "-",
               is_spring ? number(each.budget.passive) : "-",
               is_spring ? number(each.budget.friction) : "-",
               number(each.allowed) + " (" + ruleOf(each) + ")",
               std::isfinite(each.share) ? formatNumber(100.0 * each.share, 3) + " %" : "ALL"});
  }
  return table;
}

std::string budgetText(std::span<const BudgetItem> items) {
  const Table table = budgetTable(items);
  std::string above;
  for (const BudgetItem& each : items) {
    if (!each.isAbove()) continue;
    above += "  " + nameOf(each) + " (" + joined(each.item.places) + "): " + sizeOf(each.share);
    if (!each.item.note.empty()) above += ", " + each.item.note;
    if (each.item.length > 0.0) {
      above += ", over a shaft of " + formatNumber(1e3 * each.item.length, 3) + " mm";
    }
    if (std::isfinite(each.quiet_speed)) {
      above += "; friction keeps it quiet for taps up to " +
               formatNumber(10.0 * std::round(1e2 * each.quiet_speed), 4) + " mm/s";
    }
    above += "\n    cured by " + cures(each) + "\n";
  }
  if (table.empty()) return "  nothing is felt\n";
  return table.text("  ") +
         (above.empty() ? "  All of it is within the budget.\n" : "\nAbove the budget\n" + above);
}

void warnOfBudget(std::span<const BudgetItem> above, const DeviceOptions& device,
                  const std::string& scene, double rate, Console& console) {
  if (above.empty()) return;
  const auto worst =
      std::max_element(above.begin(), above.end(),
                       [](const BudgetItem& a, const BudgetItem& b) { return a.share < b.share; });
  std::string text = nameOf(*worst) + ", " + number(askedOf(*worst)) + unitOf(*worst) +
                     " at the hand, is " + sizeOf(worst->share) + " with this device";
  if (above.size() > 1) {
    text += ", and " + std::to_string(above.size() - 1) + " more " +
            (above.size() == 2 ? "is" : "are") + " above it";
  }
  text += ": it may buzz";
  if (scene.empty()) {
    console.warn(text);
    return;
  }
  text +=
      ". `palpate explain " + scene + " --device " + device.name + " --rate " + formatNumber(rate);
  if (!device.hand.empty()) text += " --hand " + device.hand;
  if (device.delay.value_or(0) > 0) text += " --delay " + std::to_string(*device.delay);
  console.warn(text + "` lists them, and what would cure it");
}

}  // namespace palpate::tools
