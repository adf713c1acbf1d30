#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>

#include "command_line/verb.h"
#include "command_line/verb_words.h"
#include "palpate/vdb/register.h"
#include "vocabulary/documents.h"

namespace palpate::tools {
namespace {

/// Layout of --help: a wide first column, no type decorations that the text does not explain.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(30); }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_option_text().empty() ? "" : " " + option->get_option_text();
  }
  std::string make_usage(const CLI::App* app, std::string) const override {
    return "\nUsage: " + app->get_name() + "\n";
  }
  std::string make_description(const CLI::App* app) const override {
    return app->get_description() + "\n";
  }
  std::string make_positionals(const CLI::App*) const override { return {}; }
};

/// True for verbs that make the grids of a scene, or take kept ones.
bool makesGrids(std::string_view verb) {
  constexpr std::string_view kVerbs[] = {"touch",   "view",    "replay", "bake",
                                         "pack",    "convert", "check",  "query",
                                         "explain", "render",  "report", "accuracy"};
  return std::find(std::begin(kVerbs), std::end(kVerbs), verb) != std::end(kVerbs);
}

std::string markdown() {
  std::string text = "```\n" + overview() + "```\n";
  for (const Verb& verb : verbs()) {
    text += "\n### palpate " + std::string(verb.name) + "\n\n```\n" + verbHelp(verb) + "```\n";
  }
  return text;
}

}  // namespace

std::unique_ptr<CLI::App> makeApp(const Verb& verb, Invocation& invocation) {
  auto app = std::make_unique<CLI::App>(verb.line, verb.usage);
  app->formatter(std::make_shared<HelpFormatter>());
  app->set_help_flag();  // --help is handled before parsing, so that it never competes with errors
  verb.define(*app, invocation);
  const char* g = "General";
  if (verb.name != std::string_view("help")) {
    addFlag(*app, g, "--json", invocation.general.json, "print one JSON object instead of text");
    addFlag(*app, g, "--quiet", invocation.general.quiet, "no notes and no progress on stderr");
    if (makesGrids(verb.name)) {
      addFlag(*app, g, "--no-cache", invocation.no_cache,
              "make all grids anew, and keep none for the next time");
    }
    if (verb.writes) {
      addFlag(*app, g, "--force", invocation.general.force, "replace existing output files");
    }
  }
  app->footer((verb.details[0] != '\0' ? std::string(verb.details) + "\n\n" : "") +
              "Example: " + verb.example);
  return app;
}

std::string verbHelp(const Verb& verb) {
  Invocation scratch;
  auto app = makeApp(verb, scratch);
  bool unused = false;
  app->add_flag("-h,--help", unused, "print this")->group("General");
  std::string text = app->help();
  for (std::size_t at = 0; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
  return text;
}

std::string overview() {
  std::string text =
      "palpate - feel what is inside a scanned or modeled object\n\nUsage: palpate VERB "
      "[OPTIONS]\n\n";
  for (const Verb& verb : verbs()) {
    text += "  " + std::string(verb.name) + std::string(10 - std::string(verb.name).size(), ' ') +
            verb.line + "\n            " + verb.example + "\n";
  }
  return text +
         "\n  palpate VERB --help   all about one verb\n  palpate --version     the version\n\n"
         "Results go to stdout, everything else to stderr; --json gives one JSON object.\n"
         "Exit code: 0 done, 1 the answer is no or the operation failed, 2 wrong usage, 3 bad "
         "input, 4 device, "
         "130 interrupted.\n";
}

std::string helpText(const HelpOptions& options) {
  if (options.verb == "scene") {
    const VocabularyPtr vocabulary = vdb::vocabulary();
    if (options.schema) return schemaText(*vocabulary);
    return options.markdown ? keyTable(*vocabulary, options.key)
                            : sceneHelp(*vocabulary, options.key);
  }
  if (options.man) return manPage(verbWords());
  if (!options.completion.empty()) {
    return completion(options.completion, verbWords(), sceneWords(*vdb::vocabulary()));
  }
  if (options.markdown) return markdown();
  if (options.verb.empty()) return overview();
  const Verb* verb = findVerb(options.verb);
  if (verb == nullptr) throw unknownVerb(options.verb);
  return verbHelp(*verb);
}

}  // namespace palpate::tools
