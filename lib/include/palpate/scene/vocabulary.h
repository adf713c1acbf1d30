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
  /// The form of a value.
  enum class Form {
    kText,
    kNumber,
    kWhole,  ///< integer
    kBoolean,
    kChoice,
    kLengthUnit,
    kQuantity,   ///< number with a unit of `dimension`
    kPoint,      ///< three lengths
    kDirection,  ///< three numbers, not all zero
    kField,
    kMap,  ///< by `type`
    kAny   ///< described by `value` and `schema`
  };
  /// How many values a key has: one, a list, or a map from names to values.
  enum class Count { kOne, kList, kNames };

  std::string name;           ///< as it is written in the file
  Form form = Form::kText;    ///< of the value, or of each item of a list
  Count count = Count::kOne;  ///< one value, a list, or a map from names to values
  std::string type = {};      ///< as declared: "length", or the name of a map
  std::string like = {};      ///< name of the declared value that it is like; empty: none
  std::optional<Dimension> dimension = {};                  ///< of a quantity
  std::vector<std::string> choices = {};                    ///< words that kChoice permits
  std::size_t at_least = 1;                                 ///< items of a list
  std::size_t at_most = 0;                                  ///< 0: any number
  double least = -std::numeric_limits<double>::infinity();  ///< [SI]
  double most = std::numeric_limits<double>::infinity();    ///< [SI]
  bool is_above = false;                   ///< must be more than `least`, not equal to it
  std::optional<double> never = {};        ///< the one number that it may not be
  bool varies = false;                     ///< may be a map that differs from place to place
  bool is_required = false;                ///< an error if it is not there
  bool has_default = false;                ///< `fallback` is a value, not a description of one
  std::vector<std::string> excludes = {};  ///< keys that may not stand beside it
  std::vector<std::string> refuses = {};   ///< texts or names that it may not be
  std::string fallback = {};               ///< default, as text or in words; empty: none
  std::string unit = {};                   ///< of a number, in words: "voxels"
  std::string help = {};                   ///< one line
  std::string more = {};                   ///< further sentences; may be empty
  std::string remedy = {};                 ///< hint of errors about its bounds or choices
  std::string needs = {};                  ///< other keys that must be there, in words
  std::string metric = {};                 ///< kind of field: its Metric, in words
  std::string in_code = {};                ///< kind of field: its function in C++
  std::string value = {};                  ///< kAny: what may stand there, in words
  std::string called = {};      ///< how messages call a map at this key; empty: by the key
  std::string refused_as = {};  ///< error code of a word that is not a choice; empty: the usual
  std::string since = "0.1";    ///< version of palpate that first read it
  Node schema = {};             ///< kNull: follows from the form
};

/// "more than 0", "2 voxels or more", "a whole number from 1 to 1000"; empty if there are no
/// bounds.
[[nodiscard]] PALPATE_EXPORT std::string boundsText(const KeyWords& key);

/// A map of the file format, and its keys.
struct PALPATE_EXPORT MapWords {
  std::string name;         ///< as the vocabulary names it: "port"
  std::string called = {};  ///< name in messages: "a port"; empty: the key that it stands at
  std::string help = {};    ///< one line
  std::string more = {};    ///< further sentences; may be empty
  std::vector<std::string> one_of = {};  ///< exactly one of these keys must be there
  std::vector<std::string> any_of = {};  ///< at least one of these keys must be there
  std::vector<KeyWords> keys = {};       ///< empty: this vocabulary does not know them

  /// The entry of a key; null if the map has no such key.
  [[nodiscard]] const KeyWords* find(std::string_view key) const noexcept;
};

/// All maps and values of a file format. Built at set-up; const use from any thread.
class PALPATE_EXPORT Vocabulary {
 public:
  /// Adds the declarations in `text`: new maps and values, further keys of maps that exist, and
  /// keys that replace those of the same name. `file` is for messages. @throws Error (kInput).
  void add(std::string_view text, const std::string& file);

  /// Null if there is none.
  [[nodiscard]] const MapWords* find(std::string_view map) const noexcept;
  /// All maps, in the order of their first declaration.
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
