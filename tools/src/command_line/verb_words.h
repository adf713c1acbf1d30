#pragma once
/// Verbs and options as plain words, for documents that are generated from their declarations
/// besides --help.

#include <string>
#include <vector>

namespace palpate::tools {

struct OptionWords {
  std::vector<std::string> names = {};  ///< "-o", "--output"
  std::string value = {};               ///< name of its value, for people; empty: a flag
  std::string help = {};
  std::string group = {};
  std::vector<std::string> choices = {};  ///< allowed values; empty: any
  bool is_file = false;
};

struct VerbWords {
  std::string name;
  std::string line = {};
  std::string usage = {};
  std::string example = {};
  std::string details = {};
  std::vector<OptionWords> options = {};  ///< in the order of their groups, with --help
};

/// All verbs, in the order of `palpate --help`.
[[nodiscard]] std::vector<VerbWords> verbWords();

/// palpate(1), in the man macros of roff.
[[nodiscard]] std::string manPage(const std::vector<VerbWords>& verbs);

/// A script that completes verbs, options, their values and files in `shell`: bash, zsh or fish.
/// After `palpate help scene` it also completes `scene_words`.
[[nodiscard]] std::string completion(const std::string& shell, const std::vector<VerbWords>& verbs,
                                     const std::vector<std::string>& scene_words);

}  // namespace palpate::tools
