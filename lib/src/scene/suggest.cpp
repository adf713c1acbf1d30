// Similarity of names, and globs.

#include <algorithm>
#include <array>

#include "palpate/scene/scene_file.h"

namespace palpate {
namespace {

constexpr std::size_t kLongestWord = 64;  // longer texts are not misspelled names

char folded(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Number of insertions, deletions, replacements and swaps of neighbors that lead from a to b,
// ignoring case (the restricted Damerau-Levenshtein distance, by its usual three-row recurrence).
std::size_t distance(std::string_view a, std::string_view b) noexcept {
  using Row = std::array<std::size_t, kLongestWord + 1>;
  Row before_last{};
  Row last{};
  Row now{};
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char ca = folded(a[i - 1]);
      const char cb = folded(b[j - 1]);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (ca == cb ? 0U : 1U)});
      if (i > 1 && j > 1 && ca == folded(b[j - 2]) && folded(a[i - 2]) == cb) {
        now[j] = std::min(now[j], before_last[j - 2] + 1);
      }
    }
    before_last = last;
    last = now;
  }
  return last[b.size()];
}

// Length in bytes of the UTF-8 character at `at`.
std::size_t characterLength(std::string_view text, std::size_t at) noexcept {
  std::size_t length = 1;
  while (at + length < text.size() &&
         (static_cast<unsigned char>(text[at + length]) & 0xC0U) == 0x80U) {
    ++length;
  }
  return length;
}

}  // namespace

std::string suggest(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.empty() || word.size() > kLongestWord) return {};
  std::string_view best;
  std::size_t best_distance = kLongestWord + 1;
  for (const std::string_view candidate : candidates) {
    if (candidate.empty() || candidate.size() > kLongestWord) continue;
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t allowed = std::min(std::max<std::size_t>(1, longer / 3), longer - 1);
    const std::size_t steps = distance(word, candidate);
    if (steps <= allowed && steps < best_distance) {
      best = candidate;
      best_distance = steps;
    }
  }
  return std::string(best);
}

bool matchesGlob(std::string_view glob, std::string_view name) noexcept {
  // Greedy matching with one place to return to: after a mismatch only the last star can take more.
  std::size_t g = 0;
  std::size_t n = 0;
  std::size_t star = std::string_view::npos;
  std::size_t resume = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      resume = n;
    } else if (g < glob.size() && glob[g] == '?') {
      ++g;
      n += characterLength(name, n);
    } else if (g < glob.size() && glob[g] == name[n]) {
      ++g;
      ++n;
    } else if (star != std::string_view::npos) {
      g = star + 1;
      resume += characterLength(name, resume);
      n = resume;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') ++g;
  return g == glob.size();
}

}  // namespace palpate
