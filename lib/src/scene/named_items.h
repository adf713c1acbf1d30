#pragma once
/// Lists of named things in a scene.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/scene/description.h"
#include "scene/messages.h"

namespace palpate {

template <typename Items>
std::vector<std::string_view> namesOf(const Items& items) {
  std::vector<std::string_view> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// Throws if one of `items` already has the name of `item`; `what` says what they are, for the
/// message.
template <typename Item>
void refuseSecond(const std::string& what, const Item& item, const std::vector<Item>& items) {
  for (const Item& other : items) {
    if (other.name != item.name) continue;
    throw errorAt(item.place, "scene.duplicate_name",
                  "a second " + what + " is called " + inQuotes(item.name),
                  "the first is in line " + std::to_string(other.place.line));
  }
}

}  // namespace palpate
