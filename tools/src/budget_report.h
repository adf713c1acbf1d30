#pragma once
/// Formats the stability budget of a scene.

#include <span>
#include <string>

#include "console.h"
#include "options.h"
#include "palpate/devices/scene_budget.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

/// Everything that is felt, item by item.
[[nodiscard]] Table budgetTable(std::span<const devices::BudgetItem> items);
[[nodiscard]] Json budgetJson(std::span<const devices::BudgetItem> items);
/// A table of all items, and below it remedies for those above the budget.
[[nodiscard]] std::string budgetText(std::span<const devices::BudgetItem> items);
/// The stiffness limits of the device for walls without damping: held by nobody, and by each kind
/// of hand.
[[nodiscard]] Json handLimitsJson(const devices::LoopModel& loop);
[[nodiscard]] Table handLimitsTable(const devices::LoopModel& loop);
[[nodiscard]] std::string handLimitsText(const devices::LoopModel& loop);
/// ", 2 samples of delay"; empty for no delay.
[[nodiscard]] std::string delayText(int delay);

/// Warns of the worst item above the budget, gives the number of the others, and, unless `scene` is
/// empty, says how to list them. Does nothing if `above` is empty.
void warnOfBudget(std::span<const devices::BudgetItem> above, const DeviceOptions& device,
                  const std::string& scene, double rate, Console& console);

}  // namespace palpate::tools
