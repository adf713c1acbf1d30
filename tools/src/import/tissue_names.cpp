#include "import/tissue_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

namespace palpate::tools {
namespace {

using Words = std::vector<std::string>;

constexpr const char* kNone = "none";

bool isCapital(char c) { return c >= 'A' && c <= 'Z'; }
bool isSmall(char c) { return c >= 'a' && c <= 'z'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
/// Bytes of characters beyond ASCII count as letters.
bool isLetter(char c) {
  return isCapital(c) || isSmall(c) || static_cast<unsigned char>(c) >= 0x80;
}

/// The name without text in brackets; the whole name if all of it is in brackets.
std::string withoutBrackets(std::string_view name) {
  std::string result;
  int depth = 0;
  for (const char c : name) {
    if (c == '(' || c == '[') {
      ++depth;
    } else if (depth > 0 && (c == ')' || c == ']')) {
      --depth;
      result += ' ';
    } else if (depth == 0) {
      result += c;
    }
  }
  return std::any_of(result.begin(), result.end(), isLetter) ? result : std::string(name);
}

std::string ordinal(const std::string& digits, std::string_view ending) {
  constexpr std::array<const char*, 5> kOrdinals = {"first", "second", "third", "fourth", "fifth"};
  if (ending != "st" && ending != "nd" && ending != "rd" && ending != "th") return {};
  const bool is_known = digits.size() == 1 && digits[0] >= '1' && digits[0] <= '5';
  return is_known ? kOrdinals.at(static_cast<std::size_t>(digits[0] - '1')) : "";
}

/// Whether a word equals the pattern, is its plural, or begins with it if the pattern ends with *.
bool fits(std::string_view pattern, std::string_view word) {
  if (pattern.ends_with('*')) return word.starts_with(pattern.substr(0, pattern.size() - 1));
  if (word == pattern) return true;
  if (pattern.size() < 3) return false;
  const bool is_y = pattern.ends_with('y');
  const std::string_view stem = is_y ? pattern.substr(0, pattern.size() - 1) : pattern;
  if (!word.starts_with(stem)) return false;
  const std::string_view end = word.substr(stem.size());
  return is_y ? end == "ies" || end == "ys" : end == "s" || end == "es";
}

bool fitsAny(const Words& patterns, std::string_view word) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& p) { return fits(p, word); });
}

/// Splits `words` at the separators; no part is empty.
std::vector<Words> partsOf(const Words& words, const std::set<std::string_view>& separators) {
  std::vector<Words> parts(1);
  for (const std::string& word : words) {
    if (!separators.contains(word)) {
      parts.back().push_back(word);
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty()) parts.pop_back();
  return parts;
}

/// A whole word takes precedence over a beginning, and a longer beginning over a shorter one.
template <typename List>
const std::string* find(const List& list, const std::string& word) {
  const std::string* best = nullptr;
  std::size_t length = 0;
  for (const auto& one : list) {
    if (!fits(one.word, word)) continue;
    if (!one.word.ends_with('*')) return &one.tissue;
    if (one.word.size() > length) {
      length = one.word.size();
      best = &one.tissue;
    }
  }
  return best;
}

NameVerdict byWord(const std::string& tissue, const std::string& word, bool is_strong = false) {
  return {tissue, "word \"" + word + "\"", is_strong};
}

/// Whether the name is nothing but that of a vertebra: L5, C2, T12, S1.
bool isVertebra(std::string_view name) {
  return (name.size() == 2 || name.size() == 3) &&
         std::string_view("CTLS").find(name[0]) != std::string_view::npos &&
         std::all_of(name.begin() + 1, name.end(), isDigit);
}

}  // namespace

std::vector<std::string> wordsOf(std::string_view name) {
  const std::string text = withoutBrackets(name);
  Words words;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t from = at;
    if (isDigit(text[at])) {
      while (at < text.size() && isDigit(text[at])) ++at;
      const std::string digits = text.substr(from, at - from);
      const bool ends = at + 2 >= text.size() || !isSmall(text[at + 2]);
      const std::string as_word =
          at + 2 <= text.size() && ends ? ordinal(digits, text.substr(at, 2)) : "";
      if (!as_word.empty()) at += 2;
      words.push_back(as_word.empty() ? digits : as_word);
      continue;
    }
    if (!isLetter(text[at])) {
      ++at;
      continue;
    }
    // A word ends where a capital letter begins a new one: aB, ABc.
    ++at;
    while (at < text.size() && isLetter(text[at])) {
      const bool after_small = !isCapital(text[at - 1]) && isCapital(text[at]);
      const bool before_small = isCapital(text[at - 1]) && isCapital(text[at]) &&
                                at + 1 < text.size() && isSmall(text[at + 1]);
      if (after_small || before_small) break;
      ++at;
    }
    std::string word = text.substr(from, at - from);
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    // An abbreviation, as in "M. psoas".
    if (word.size() <= 3 && at + 1 < text.size() && text[at] == '.' &&
        (text[at + 1] == ' ' || text[at + 1] == '_')) {
      word += '.';
    }
    words.push_back(std::move(word));
  }
  return words;
}

bool TissueNames::isAside(const std::string& word) const {
  return isDigit(word[0]) || fitsAny(aside_, word);
}

/// `rest`: this part, and all words after it in the name.
NameVerdict TissueNames::ofPart(const Words& part, const Words& rest) const {
  const auto has = [](const Words& in, const std::string& pattern) {
    return std::any_of(in.begin(), in.end(),
                       [&](const std::string& word) { return fits(pattern, word); });
  };
  const Together* longest = nullptr;
  for (const Together& entry : together_) {
    if (longest != nullptr && entry.words.size() <= longest->words.size()) continue;
    const bool fits_all = std::all_of(entry.words.begin(), entry.words.end(),
                                      [&](const std::string& p) { return has(rest, p); });
    const bool is_here = std::any_of(entry.words.begin(), entry.words.end(),
                                     [&](const std::string& p) { return has(part, p); });
    if (fits_all && is_here) longest = &entry;
  }
  if (longest != nullptr) {
    std::string text;
    for (const std::string& word : longest->words) text += (text.empty() ? "" : " + ") + word;
    return {longest->tissue, "words \"" + text + "\"", true};
  }
  Words said;
  std::copy_if(part.begin(), part.end(), std::back_inserter(said),
               [&](const std::string& word) { return !isAside(word); });
  if (said.empty()) return {};
  if (const std::string* tissue = find(leading_, said.front())) {
    return byWord(*tissue, said.front(), true);
  }
  for (const auto* list : {&nouns_, &names_}) {
    const auto word = std::find_if(said.rbegin(), said.rend(), [&](const std::string& each) {
      return find(*list, each) != nullptr;
    });
    if (word != said.rend()) return byWord(*find(*list, *word), *word, list == &nouns_);
  }
  const bool has_number =
      std::any_of(part.begin(), part.end(), [](const std::string& w) { return isDigit(w[0]); });
  for (const std::string& word : said) {
    const std::string* tissue = has_number ? find(numbered_, word) : nullptr;
    if (tissue != nullptr) return {*tissue, "word \"" + word + "\" with a number"};
  }
  return {};
}

NameVerdict TissueNames::ofPlace(const Words& part) const {
  const auto word = std::find_if(part.rbegin(), part.rend(), [&](const std::string& each) {
    return find(places_, each) != nullptr;
  });
  return word != part.rend() ? byWord(*find(places_, *word), *word) : NameVerdict{};
}

bool TissueNames::isBrain(const Words& words) const {
  bool says = false;
  for (const std::string& word : words) {
    const bool is_hint = fitsAny(brain_words_, word);
    if (!is_hint && !isAside(word)) return false;
    says = says || is_hint;
  }
  return says;
}

NameVerdict TissueNames::inCompany(NameVerdict verdict, const Words& words,
                                   const Context& context) const {
  for (const Company& company : company_) {
    if (verdict.why != byWord("", company.word).why) continue;
    const auto met = std::find_if(context.words.begin(), context.words.end(), [&](const auto& w) {
      return fitsAny(company.among, w) && std::find(words.begin(), words.end(), w) == words.end();
    });
    if (met == context.words.end()) continue;
    return {company.tissue, verdict.why + ", in an image with \"" + *met + "\"", true};
  }
  return verdict;
}

NameVerdict TissueNames::one(const std::string& name, const Context& context) const {
  const Words words = wordsOf(name);
  const std::vector<Words> segments = partsOf(words, {"of", "de", "von"});
  Words rest;
  std::vector<Words> rests(segments.size());
  for (std::size_t s = segments.size(); s-- > 0;) {
    rest.insert(rest.begin(), segments[s].begin(), segments[s].end());
    rests[s] = rest;
  }
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const std::vector<Words> parts = partsOf(segments[s], {"and", "or", "with", "et"});
    NameVerdict decided;
    for (const Words& part : parts) {
      NameVerdict verdict = ofPart(part, parts.size() > 1 ? part : rests[s]);
      if (verdict.tissue.empty() && parts.size() > 1) verdict = ofPlace(part);
      if (verdict.tissue.empty()) continue;
      if (!decided.tissue.empty() && decided.tissue != verdict.tissue) {
        return {"", "says both " + decided.tissue + " and " + verdict.tissue};
      }
      if (decided.tissue.empty()) decided = verdict;
    }
    if (decided.tissue == kNone) return {"", decided.why + " alone says no tissue"};
    if (decided.tissue.empty()) continue;
    // "Rectus" is a gyrus among names of gyri, and a muscle elsewhere.
    if (!decided.is_strong && context.is_brain && isBrain(words)) break;
    return inCompany(decided, words, context);
  }
  if (isVertebra(name)) return {"bone", "name of a vertebra"};
  if (context.is_brain && isBrain(words)) {
    return {"brain", "words of the brain, which most labels here are of"};
  }
  NameVerdict place = ofPlace(words);
  if (place.tissue.empty()) place.why = "no word of it is known";
  return place;
}

std::vector<NameVerdict> TissueNames::of(const std::vector<std::string>& names) const {
  Context context;
  std::size_t decided = 0;
  std::size_t brain = 0;
  for (const std::string& name : names) {
    const NameVerdict verdict = one(name, context);
    decided += verdict.tissue.empty() ? 0 : 1;
    brain += verdict.tissue == "brain" ? 1 : 0;
  }
  for (const std::string& name : names) {
    const Words words = wordsOf(name);
    context.words.insert(context.words.end(), words.begin(), words.end());
  }
  context.is_brain = 2 * brain > decided;
  std::vector<NameVerdict> verdicts;
  for (const std::string& name : names) verdicts.push_back(one(name, context));
  return verdicts;
}

std::optional<std::string> TissueNames::ofCode(const vdb::LabelCode& code) const {
  const auto at = codes_.find({code.scheme, code.value});
  if (at == codes_.end()) return std::nullopt;
  return at->second;
}

std::optional<std::string> TissueNames::ofNumber(const std::string& table, int number) const {
  const auto at = numbers_.find(table);
  if (at == numbers_.end()) return std::nullopt;
  for (const Numbers& range : at->second) {
    if (number >= range.first && number <= range.last) return range.tissue;
  }
  return std::nullopt;
}

std::vector<std::string> TissueNames::numberTables() const {
  std::vector<std::string> names;
  for (const auto& [name, ranges] : numbers_) names.push_back(name);
  return names;
}

std::vector<std::string> TissueNames::tissues() const {
  std::set<std::string> all;
  for (const auto* list : {&leading_, &nouns_, &names_, &numbered_, &places_}) {
    for (const Word& word : *list) all.insert(word.tissue);
  }
  for (const Together& entry : together_) all.insert(entry.tissue);
  for (const Company& entry : company_) all.insert(entry.tissue);
  for (const auto& [code, tissue] : codes_) all.insert(tissue);
  for (const auto& [table, ranges] : numbers_) {
    for (const Numbers& range : ranges) all.insert(range.tissue);
  }
  all.erase(kNone);
  return {all.begin(), all.end()};
}

}  // namespace palpate::tools
