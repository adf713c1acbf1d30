#include "fuzz/damage.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace palpate::fuzz {
namespace {

std::size_t below(Random& random, std::size_t end) {
  return end == 0 ? 0 : static_cast<std::size_t>(random() % end);
}
std::size_t placeIn(const std::string& bytes, Random& random) {
  return below(random, bytes.size());
}

void flipBit(std::string& b, Random& r) {
  if (b.empty()) return;
  b[placeIn(b, r)] ^= static_cast<char>(1U << below(r, 8));
}
void flipBits(std::string& b, Random& r) {
  for (std::size_t n = 2 + below(r, 30); n > 0; --n) flipBit(b, r);
}
void flipInHead(std::string& b, Random& r) {
  if (b.empty()) return;
  b[below(r, std::min<std::size_t>(b.size(), 512))] = static_cast<char>(r());
}
void setByte(std::string& b, Random& r) {
  if (b.empty()) return;
  b[placeIn(b, r)] = static_cast<char>(r());
}
void write(std::string& b, Random& r, const void* what, std::size_t size) {
  if (b.size() < size) return;
  std::memcpy(b.data() + below(r, b.size() - size + 1), what, size);
}
void allOnes32(std::string& b, Random& r) {
  const std::uint32_t word = 0xFFFFFFFF;
  write(b, r, &word, sizeof word);
}
void largest32(std::string& b, Random& r) {
  const std::uint32_t word = 0x7FFFFFFF;
  write(b, r, &word, sizeof word);
}
void allOnes64(std::string& b, Random& r) {
  const std::uint64_t word = ~std::uint64_t{0};
  write(b, r, &word, sizeof word);
}
void smallNegative64(std::string& b, Random& r) {
  const std::int64_t word = -static_cast<std::int64_t>(below(r, 1U << 20U));
  write(b, r, &word, sizeof word);
}
void bigNumber32(std::string& b, Random& r) {
  const auto word = static_cast<std::uint32_t>(r());
  write(b, r, &word, sizeof word);
}
void zeros(std::string& b, Random& r) {
  const std::size_t from = placeIn(b, r);
  const std::size_t count = std::min(b.size() - from, 1 + below(r, 64));
  std::fill_n(b.begin() + static_cast<std::ptrdiff_t>(from), count, '\0');
}
void truncate(std::string& b, Random& r) { b.resize(placeIn(b, r)); }
void remove(std::string& b, Random& r) {
  const std::size_t from = placeIn(b, r);
  b.erase(from, 1 + below(r, 64));
}
void insertNoise(std::string& b, Random& r) {
  std::string noise(1 + below(r, 64), '\0');
  for (char& c : noise) c = static_cast<char>(r());
  b.insert(placeIn(b, r), noise);
}
void repeat(std::string& b, Random& r) {
  const std::size_t from = placeIn(b, r);
  const std::string part = b.substr(from, 1 + below(r, 256));
  for (std::size_t n = 1 + below(r, 40); n > 0; --n) b.insert(from, part);
}
void move(std::string& b, Random& r) {
  const std::size_t from = placeIn(b, r);
  const std::string part = b.substr(from, 1 + below(r, 256));
  b.erase(from, part.size());
  b.insert(placeIn(b, r), part);
}
/// Replaces a number in text form by one that does not fit.
void hugeText(std::string& b, Random& r) {
  const std::size_t from = placeIn(b, r);
  const std::size_t at = b.find_first_of("0123456789", from);
  if (at == std::string::npos) return flipBit(b, r);
  constexpr std::array<const char*, 6> kTexts = {
      "99999999999999999999", "-1", "4294967295", "1e308", "2147483647", "nan"};
  b.replace(at, 1, kTexts[below(r, kTexts.size())]);
}

void mixed(std::string& b, Random& r);

constexpr Damage kDamages[] = {{"bit", flipBit},          {"bits", flipBits},
                               {"head", flipInHead},      {"byte", setByte},
                               {"ones32", allOnes32},     {"largest32", largest32},
                               {"ones64", allOnes64},     {"negative64", smallNegative64},
                               {"random32", bigNumber32}, {"zeros", zeros},
                               {"truncated", truncate},   {"removed", remove},
                               {"noise", insertNoise},    {"repeated", repeat},
                               {"moved", move},           {"huge_text", hugeText},
                               {"mixed", mixed}};

void mixed(std::string& b, Random& r) {
  constexpr std::size_t kSingle = std::size(kDamages) - 1;
  for (std::size_t n = 2 + below(r, 4); n > 0; --n) kDamages[below(r, kSingle)].apply(b, r);
}

}  // namespace

std::span<const Damage> damages() { return kDamages; }

}  // namespace palpate::fuzz
