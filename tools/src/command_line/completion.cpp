#include "command_line/verb_words.h"
#include "palpate/core/text.h"

namespace palpate::tools {
namespace {

std::vector<std::string> namesOf(const std::vector<VerbWords>& verbs) {
  std::vector<std::string> names;
  for (const VerbWords& verb : verbs) names.push_back(verb.name);
  return names;
}

/// The words that may follow `help`: verbs and `scene`.
std::string helpTopics(const std::vector<VerbWords>& verbs) {
  return joined(namesOf(verbs), " ") + " scene";
}

std::string forBash(const std::vector<VerbWords>& verbs,
                    const std::vector<std::string>& scene_words) {
  std::string text =
      "# Made by `palpate help --completion bash`.\n"
      "_palpate() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]} verb= i\n"
      "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
      "    if [[ ${COMP_WORDS[i]} != -* ]]; then verb=${COMP_WORDS[i]}; break; fi\n"
      "  done\n"
      "  local options= words=\n"
      "  case $verb in\n"
      "    '') words='" +
      joined(namesOf(verbs), " ") + "'; options='--help --version --json --quiet --force' ;;\n";
  for (const VerbWords& verb : verbs) {
    std::vector<std::string> names;
    std::string values;
    for (const OptionWords& option : verb.options) {
      names.insert(names.end(), option.names.begin(), option.names.end());
      if (option.value.empty()) continue;
      values += "        " + joined(option.names, "|") + ") ";
      if (!option.choices.empty()) {
        values += "words='" + joined(option.choices, " ") + "'";
      } else {
        values += option.is_file ? "words=FILES" : "words=NONE";
      }
      values += " ;;\n";
    }
    text += std::string("    ") + verb.name + ")\n      options='" + joined(names, " ") + "'\n";
    if (verb.name == "help") {
      text += "      if ((COMP_CWORD == i + 1)); then words='" + helpTopics(verbs) +
              "'\n      elif [[ ${COMP_WORDS[i+1]} == scene ]]; then words='" +
              joined(scene_words, " ") + "'; else words=NONE; fi\n";
    } else {
      text += "      words=FILES\n";
    }
    if (!values.empty()) text += "      case $last in\n" + values + "      esac\n";
    text += "      ;;\n";
  }
  return text +
         "  esac\n"
         "  if [[ $word == -* ]]; then words=$options; fi\n"
         "  case $words in\n"
         "    FILES) compopt -o default 2>/dev/null; COMPREPLY=() ;;\n"
         "    NONE) COMPREPLY=() ;;\n"
         "    *) COMPREPLY=($(compgen -W \"$words\" -- \"$word\")) ;;\n"
         "  esac\n"
         "}\n"
         "complete -F _palpate palpate\n";
}

/// The text in single quotes for a shell.
std::string shellWord(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string forFish(const std::vector<VerbWords>& verbs,
                    const std::vector<std::string>& scene_words) {
  std::string text = "# Made by `palpate help --completion fish`.\n";
  const std::string none = "not __fish_seen_subcommand_from " + joined(namesOf(verbs), " ");
  for (const VerbWords& verb : verbs) {
    text += "complete -c palpate -f -n " + shellWord(none) + " -a " + verb.name + " -d " +
            shellWord(verb.line) + "\n";
  }
  for (const VerbWords& verb : verbs) {
    for (const OptionWords& option : verb.options) {
      text += "complete -c palpate -n '__fish_seen_subcommand_from " + verb.name + "'";
      for (const std::string& name : option.names) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.choices.empty()) {
        text += " -x -a " + shellWord(joined(option.choices, " "));
      } else if (!option.value.empty()) {
        text += option.is_file ? " -r" : " -x";
      }
      text += " -d " + shellWord(option.help) + "\n";
    }
  }
  const std::string seen = "__fish_seen_subcommand_from help";
  return text + "complete -c palpate -f -n " +
         shellWord(seen + "; and not __fish_seen_subcommand_from scene") + " -a " +
         shellWord(helpTopics(verbs)) + "\ncomplete -c palpate -f -n " +
         shellWord(seen + "; and __fish_seen_subcommand_from scene") + " -a " +
         shellWord(joined(scene_words, " ")) + "\n";
}

std::string forZsh(const std::vector<VerbWords>& verbs,
                   const std::vector<std::string>& scene_words) {
  const auto described = [](std::string name, const std::string& help) {
    std::string text;
    for (const char c : help)
      text += c == ':' || c == '[' || c == ']' ? std::string{'\\', c} : std::string{c};
    return shellWord(std::move(name) + text);
  };
  std::string text =
      "#compdef palpate\n# Made by `palpate help --completion zsh`.\n_palpate() {\n"
      "  local -a verbs=(\n";
  for (const VerbWords& verb : verbs) text += "    " + described(verb.name + ":", verb.line) + "\n";
  text +=
      "  )\n  if ((CURRENT == 2)); then _describe verb verbs; return; fi\n  case $words[2] in\n";
  for (const VerbWords& verb : verbs) {
    text += std::string("    ") + verb.name + ")\n";
    if (verb.name == "help") {
      text += "      if ((CURRENT == 3)); then compadd " + helpTopics(verbs) +
              "; fi\n      if ((CURRENT == 4)) && [[ $words[3] == scene ]]; then compadd " +
              joined(scene_words, " ") + "; fi\n";
    }
    text += "      _arguments";
    for (const OptionWords& option : verb.options) {
      for (const std::string& name : option.names) {
        std::string help;
        for (const char c : option.help) {
          help += c == '[' || c == ']' || c == ':' ? std::string{'\\', c} : std::string{c};
        }
        std::string spec = "*" + name + "[" + help + "]";
        if (!option.value.empty()) {
          spec += ":value:";
          if (!option.choices.empty()) spec += "(" + joined(option.choices, " ") + ")";
          if (option.is_file) spec += "_files";
        }
        text += " \\\n        " + shellWord(spec);
      }
    }
    text += verb.name == "help" ? "\n      ;;\n" : " \\\n        '*:file:_files'\n      ;;\n";
  }
  return text + "  esac\n}\n_palpate \"$@\"\n";
}

}  // namespace

std::string completion(const std::string& shell, const std::vector<VerbWords>& verbs,
                       const std::vector<std::string>& scene_words) {
  if (shell == "bash") return forBash(verbs, scene_words);
  return shell == "zsh" ? forZsh(verbs, scene_words) : forFish(verbs, scene_words);
}

}  // namespace palpate::tools
