#include "image/nrrd_fields.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

#include "image/byte_stream.h"
#include "image/header_text.h"
#include "image/utf8.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kLongestLine = std::size_t{1} << 20U;

constexpr std::string_view kFields[] = {
    "axismaxs",   "axismins", "blocksize",      "byteskip",    "centers",
    "content",    "datafile", "dimension",      "encoding",    "endian",
    "kinds",      "labels",   "lineskip",       "max",         "measurementframe",
    "min",        "number",   "oldmax",         "oldmin",      "sampleunits",
    "sizes",      "space",    "spacedimension", "spaceorigin", "spacedirections",
    "spaceunits", "spacings", "thicknesses",    "type",        "units"};

/// Maps synonyms of a field's name to one of them.
std::string canonical(std::string_view name) {
  std::string key = lowerCase(name);
  std::erase_if(key, [](char c) { return c == ' ' || c == '\t'; });
  if (key == "centerings") return "centers";
  return key;
}

/// Undoes teem's escapes in the values of key/value pairs:
/// and \\.
std::string unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape =
        text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == 'n' || text[i + 1] == '\\');
    if (escape) ++i;
    out += escape && text[i] == 'n' ? '\n' : text[i];
  }
  return out;
}

}  // namespace

const std::string& NrrdFields::require(const std::string& name) const {
  if (const std::string* value = find(name)) return *value;
  throw inputError("nrrd.field", "the header has no field '" + name + "'", "write the file again",
                   path);
}

Error NrrdFields::fail(const char* code, const std::string& name, std::string message,
                       std::string hint) const {
  Problem problem{code, std::move(message), std::move(hint), path};
  if (const auto at = lines.find(name); at != lines.end()) problem.line = at->second;
  return Error(ErrorKind::kInput, std::move(problem));
}

NrrdFields readNrrdFields(const std::string& path) {
  ByteStream(path, "nrrd", 0, Packing::kNone);  // refuses anything but a regular file
  std::ifstream file(path, std::ios::binary);
  char magic[8] = {};
  file.read(magic, sizeof magic);
  const std::string_view begin(magic, sizeof magic);
  if (!begin.starts_with("NRRD000") || begin[7] < '1' || begin[7] > '9') {
    throw inputError("nrrd.format",
                     "this is not a NRRD file: it does not begin with NRRD000 and a version",
                     "such files end in .nrrd or .nhdr", path);
  }
  if (begin[7] > '5') {
    throw inputError("nrrd.format", std::string("NRRD version ") + begin[7] + "; 1 to 5 are known",
                     "save it in version 5", path);
  }
  NrrdFields out;
  out.path = path;
  std::string line;
  std::getline(file, line);
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) {
      out.has_end = true;
      out.end = static_cast<std::uint64_t>(file.tellg());
      break;
    }
    if (line.front() == '#') continue;
    const auto fail = [&](std::string message) {
      Problem problem{"nrrd.field", std::move(message), "the header may be damaged", path};
      problem.line = number;
      return Error(ErrorKind::kInput, std::move(problem));
    };
    if (line.size() > kLongestLine) throw fail("a line of the header is too long");
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || colon + 1 >= line.size()) {
      throw fail("`" + line.substr(0, 40) + "` is not a line of a NRRD header");
    }
    if (line[colon + 1] == '=') {
      out.pairs[line.substr(0, colon)] =
          asUtf8(unescaped(std::string_view(line).substr(colon + 2)));
      continue;
    }
    const std::string key = canonical(std::string_view(line).substr(0, colon));
    if (std::find(std::begin(kFields), std::end(kFields), key) == std::end(kFields)) {
      throw fail("`" + line.substr(0, 40) + "` is not a line of a NRRD header");
    }
    if (!out.fields.emplace(key, trimmed(std::string_view(line).substr(colon + 1))).second) {
      throw fail("the field '" + key + "' is given twice");
    }
    out.lines[key] = number;
    // The files of a list follow it to the end of the header.
    if (key == "datafile" && lowerCase(out.fields[key]).starts_with("list")) break;
  }
  return out;
}

}  // namespace palpate::vdb
