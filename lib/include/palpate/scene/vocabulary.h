#pragma once
/// The vocabulary of scene files as data: every map, its keys, and the values they may have. The
/// reader, the JSON Schema, the tables of the documents, help and completion are made from it. It
/// is written in YAML (lib/src/scene/vocabulary.yaml says how); other modules add to a copy of it
/// in the same way.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/export.h"
#include "palpate/scene/scene_file.h"
#include "palpate/scene/units.h"

namespace palpate {

/// A key of a map, and everything that the vocabulary declares about it.
struct KeyWords {
  enum class Form {
    kText,
    kNumber,
    kWhole,
    kBoolean,
    kChoice,
    kLengthUnit,
    kQuantity,
    kPoint,
    kDirection,
    kField,
    kMap,
    kAny
  };
  enum class Count { kOne, kList, kNames };

  std::string name;
  Form form = Form::kText;
  Count count = Count::kOne;
  std::string type = {};  ///< as declared: "length", or the name of a map
  std::string like = {};  ///< name of the declared value that it is like; empty: none
  std::optional<Dimension> dimension = {};  ///< of a quantity
  std::vector<std::string> choices = {};
  std::size_t at_least = 1;                                 ///< items of a list
  std::size_t at_most = 0;                                  ///< 0: any number
  double least = -std::numeric_limits<double>::infinity();  ///< [SI]
  double most = std::numeric_limits<double>::infinity();
  bool is_above = false;             ///< must be more than `least`, not equal to it
  std::optional<double> never = {};  ///< the one number that it may not be
  bool varies = false;               ///< may be a map that differs from place to place
  bool is_required = false;
  bool has_default = false;                ///< `fallback` is a value, not a description of one
  std::vector<std::string> excludes = {};  ///< keys that may not stand beside it
  std::vector<std::string> refuses = {};   ///< texts or names that it may not be
  std::string fallback = {};
  std::string unit = {};
  std::string help = {};
  std::string more = {};
  std::string remedy = {};
  std::string needs = {};
  std::string metric = {};
  std::string in_code = {};
  std::string value = {};
  std::string called = {};
  std::string refused_as = {};
  std::string since = "0.1";
  Node schema = {};  ///< kNull: follows from the form
};

/// "more than 0", "2 voxels or more", "a whole number from 1 to 1000"; empty if there are no
/// bounds.
[[nodiscard]] PALPATE_EXPORT std::string boundsText(const KeyWords& key);

struct PALPATE_EXPORT MapWords {
  std::string name;
  std::string called = {};  ///< name in messages: "a port"; empty: the key that it stands at
  std::string help = {};
  std::string more = {};
  std::vector<std::string> one_of = {};  ///< exactly one of these keys must be there
  std::vector<std::string> any_of = {};  ///< at least one of these keys must be there
  std::vector<KeyWords> keys = {};       ///< empty: this vocabulary does not know them

  [[nodiscard]] const KeyWords* find(std::string_view key) const noexcept;
};

class PALPATE_EXPORT Vocabulary {
 public:
  /// Adds the declarations in `text`: new maps and values, further keys of maps that exist, and
  /// keys that replace those of the same name. `file` is for messages. @throws Error (kInput).
  void add(std::string_view text, const std::string& file);

  /// Null if there is none.
  [[nodiscard]] const MapWords* find(std::string_view map) const noexcept;
  [[nodiscard]] const std::vector<MapWords>& maps() const noexcept { return maps_; }
  /// The declared values that a key's `like` can name.
  [[nodiscard]] const std::vector<KeyWords>& values() const noexcept { return values_; }

 private:
  [[nodiscard]] KeyWords read(const Document& document, const Node::Entry& entry) const;
  void readType(const Document& document, const Node& type, KeyWords& key) const;
  [[nodiscard]] MapWords& mapCalled(const std::string& name);

  std::vector<MapWords> maps_ = {};
  std::vector<KeyWords> values_ = {};
};

}  // namespace palpate
