#pragma once
/// The stability budget of a scene, in print.

#include <span>
#include <string>

#include "console.h"
#include "options.h"
#include "palpate/devices/scene_budget.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

/// What is felt, item by item.
[[nodiscard]] Table budgetTable(std::span<const devices::BudgetItem> items);
[[nodiscard]] Json budgetJson(std::span<const devices::BudgetItem> items);
/// A table of all items, and below it what would cure those above the budget.
[[nodiscard]] std::string budgetText(std::span<const devices::BudgetItem> items);
/// What the device can hold of walls without damping: held by nobody, and by each hand.
[[nodiscard]] Json handLimitsJson(const devices::LoopModel& loop);
[[nodiscard]] Table handLimitsTable(const devices::LoopModel& loop);
[[nodiscard]] std::string handLimitsText(const devices::LoopModel& loop);
/// ", 2 samples of delay"; empty for none.
[[nodiscard]] std::string delayText(int delay);

/// A warning of the worst item above the budget, the number of the others, and, unless `scene` is
/// empty, how to list them. Nothing if there is none.
void warnOfBudget(std::span<const devices::BudgetItem> above, const DeviceOptions& device,
                  const std::string& scene, double rate, Console& console);

}  // namespace palpate::tools
