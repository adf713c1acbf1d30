#pragma once
// Kinds of damage that occur in files, and that attackers make.

#include <cstdint>
#include <random>
#include <span>
#include <string>

namespace palpate::fuzz {

using Random = std::mt19937_64;

struct Damage {
  const char* name;
  void (*apply)(std::string& bytes, Random& random);
};

/// All seventeen kinds.
[[nodiscard]] std::span<const Damage> damages();

}  // namespace palpate::fuzz
