#pragma once
/// The lines of a NRRD header, uninterpreted.

#include <cstdint>
#include <map>
#include <string>

#include "palpate/core/error.h"

namespace palpate::vdb {

struct NrrdFields {
  std::string path;
  std::map<std::string, std::string>
      fields;                                ///< lower-case names without blanks: "spacedirections"
  std::map<std::string, int> lines;          ///< line number of each
  std::map<std::string, std::string> pairs;  ///< `key:=value`
  std::uint64_t end = 0;                     ///< [bytes] behind the empty line
  bool has_end = false;                      ///< there is an empty line

  [[nodiscard]] const std::string* find(const std::string& name) const {
    const auto at = fields.find(name);
    return at == fields.end() ? nullptr : &at->second;
  }
  /// @throws Error (kInput, nrrd.field) if the header has no such field.
  [[nodiscard]] const std::string& require(const std::string& name) const;
  /// An error about field `name`.
  [[nodiscard]] Error fail(const char* code, const std::string& name, std::string message,
                           std::string hint = {}) const;
};

/// @throws Error (kInput): missing, empty, not a NRRD file, a line that does not belong in a
/// header, a field given twice.
[[nodiscard]] NrrdFields readNrrdFields(const std::string& path);

}  // namespace palpate::vdb
