#pragma once
/// The vocabulary of scene files as data: every map, its keys, and what may stand at them. The
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

/// A key of a map, and all that is said of it.
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
  std::string type = {};                    ///< as declared: "length", or the name of a map
  std::string like = {};                    ///< the value that it is like; empty: none
  std::optional<Dimension> dimension = {};  ///< of a quantity
  std::vector<std::string> choices = {};
  std::size_t at_least = 1;                                 ///< items of a list
  std::size_t at_most = 0;                                  ///< 0: any number
  double least = -std::numeric_limits<double>::infinity();  ///< [SI]
  double most = std::numeric_limits<double>::infinity();
  bool is_above = false;             ///< more than `least`, not `least` itself
  std::optional<double> never = {};  ///< the one number that it may not be
  bool varies = false;               ///< may be a map of places
  bool is_required = false;
  bool has_default = false;                ///< `fallback` is a value, not words about one
  std::vector<std::string> excludes = {};  ///< keys that it does not go with
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

/// "more than 0", "2 voxels or more", "a whole number from 1 to 1000"; empty if it is not bounded.
[[nodiscard]] PALPATE_EXPORT std::string boundsText(const KeyWords& key);

struct PALPATE_EXPORT MapWords {
  std::string name;
  std::string called = {};  ///< in messages: "a port"; empty: by the key that it stands at
  std::string help = {};
  std::string more = {};
  std::vector<std::string> one_of = {};  ///< exactly one of these keys must be there
  std::vector<std::string> any_of = {};  ///< at least one of these keys must be there
  std::vector<KeyWords> keys = {};       ///< empty: not known here

  [[nodiscard]] const KeyWords* find(std::string_view key) const noexcept;
};

class PALPATE_EXPORT Vocabulary {
 public:
  /// Adds what `text` declares: new maps and values, further keys of maps that there are, and keys
  /// in the place of those of the same name. `file` is for messages. @throws Error (kInput).
  void add(std::string_view text, const std::string& file);

  /// Null if there is none.
  [[nodiscard]] const MapWords* find(std::string_view map) const noexcept;
  [[nodiscard]] const std::vector<MapWords>& maps() const noexcept { return maps_; }
  /// What keys may be like.
  [[nodiscard]] const std::vector<KeyWords>& values() const noexcept { return values_; }

 private:
  [[nodiscard]] KeyWords read(const Document& document, const Node::Entry& entry) const;
  void readType(const Document& document, const Node& type, KeyWords& key) const;
  [[nodiscard]] MapWords& mapCalled(const std::string& name);

  std::vector<MapWords> maps_ = {};
  std::vector<KeyWords> values_ = {};
};

}  // namespace palpate
