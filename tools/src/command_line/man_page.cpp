#include "command_line/verb_words.h"
#include "palpate/version.h"

namespace palpate::tools {
namespace {

/// Escapes text for roff: no line begins with a control character, no hyphen turns into a dash.
std::string plain(std::string_view text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '`' || c == '\'') {
      out += c == '`' ? "\\(ga" : "\\(aq";
    } else {
      out += c;
    }
    begins = c == '\n';
  }
  return out;
}

std::string request(const char* name, std::string_view text) {
  return std::string(".") + name + " \"" + plain(text) + "\"\n";
}

std::string optionText(const OptionWords& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "\\fB" : ", \\fB") + plain(name) + "\\fR";
  }
  if (!option.value.empty()) names += " \\fI" + plain(option.value) + "\\fR";
  return ".TP\n" + names + "\n" + plain(option.help) + "\n";
}

std::string verbText(const VerbWords& verb) {
  std::string text = request("SS", "palpate " + verb.name) + plain(verb.line) + ".\n.PP\n" +
                     ".nf\n" + plain(verb.usage) + "\n.fi\n";
  std::string group;
  for (const OptionWords& option : verb.options) {
    if (option.group != group) text += ".PP\n" + plain(option.group) + ":\n";
    group = option.group;
    text += optionText(option);
  }
  if (!verb.details.empty()) {
    std::string details = verb.details;
    for (std::size_t at = 0; (at = details.find("\n\n", at)) != std::string::npos;) {
      details.replace(at, 2, "\n\v\n");
    }
    std::string body = plain(details);
    for (std::size_t at = 0; (at = body.find('\v')) != std::string::npos;) {
      body.replace(at, 1, ".PP");
    }
    text += ".PP\n" + body + "\n";
  }
  return text + ".PP\nExample:\n.PP\n.nf\n.RS\n" + plain(verb.example) + "\n.RE\n.fi\n";
}

}  // namespace

std::string manPage(const std::vector<VerbWords>& verbs) {
  std::string text =
      ".\\\" Made by `palpate help --man`.\n"
      ".TH PALPATE 1 \"\" \"palpate " PALPATE_VERSION_STRING
      "\" \"User Commands\"\n"
      ".SH NAME\npalpate \\- feel what is inside a scanned or modeled object\n"
      ".SH SYNOPSIS\n.B palpate\n.I VERB\n[\\fIOPTIONS\\fR]\n"
      ".SH DESCRIPTION\n"
      "Results go to stdout, everything else to stderr; \\fB\\-\\-json\\fR gives one JSON object.\n"
      "\\fBpalpate help scene\\fR tells the keys of scene files.\n"
      ".SH VERBS\n";
  for (const VerbWords& verb : verbs) text += verbText(verb);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : {std::pair{"0", "done"},
                                      {"1", "the answer is no, or the operation failed"},
                                      {"2", "wrong usage"},
                                      {"3", "bad input"},
                                      {"4", "the device failed"},
                                      {"130", "interrupted"}}) {
    text += std::string(".TP\n.B ") + code + "\n" + meaning + "\n";
  }
  return text;
}

}  // namespace palpate::tools
