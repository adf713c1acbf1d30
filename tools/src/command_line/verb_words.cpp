#include "command_line/verb_words.h"

#include <algorithm>

#include "command_line/verb.h"

namespace palpate::tools {
namespace {

/// The words of "sform|qform", or of a set that a check allows, "{sform,qform}".
std::vector<std::string> choicesOf(const CLI::Option& option) {
  std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  if (open == std::string::npos) return {};
  type = type.substr(open + 1, type.find('}') - open - 1);
  std::vector<std::string> words = CLI::detail::split(type, ',');
  // Sets are listed in no particular order.
  std::sort(words.begin(), words.end());
  return words;
}

bool isFile(const std::string& value) {
  return value.starts_with("FILE") || value == "SCENE" || value == "IMAGE";
}

std::vector<OptionWords> optionsOf(const Verb& verb) {
  Invocation scratch;
  const auto app = makeApp(verb, scratch);
  std::vector<OptionWords> all;
  for (const std::string& group : app->get_groups()) {
    for (const CLI::Option* option : app->get_options()) {
      if (option->get_group() != group || option->get_positional()) continue;
      OptionWords words;
      for (const std::string& name : option->get_snames()) words.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) words.names.push_back("--" + name);
      words.value = option->get_option_text();
      words.help = option->get_description();
      words.group = group;
      words.choices = choicesOf(*option);
      words.is_file = isFile(words.value);
      all.push_back(std::move(words));
    }
  }
  all.push_back({{"-h", "--help"}, "", "print this", "General", {}, false});
  return all;
}

}  // namespace

std::vector<VerbWords> verbWords() {
  std::vector<VerbWords> all;
  for (const Verb& verb : verbs()) {
    all.push_back({verb.name, verb.line, verb.usage, verb.example, verb.details, optionsOf(verb)});
  }
  return all;
}

}  // namespace palpate::tools
