#pragma once
/// Scene files: YAML -> Document -> SceneDescription, strictly. The readers of other files (meshes,
/// grids, scans) are not known here; they come through a SceneRegistry that the vdb module fills.
///
/// A Document is a strict YAML subset as an immutable tree whose nodes know their line and column.
/// No yaml-cpp type is visible here. Refused with file:line:column: duplicate keys, aliases and
/// anchors, tags, more than one document, keys that are not plain text, nesting deeper than 64.
/// JSON is a subset and is read too.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/export.h"
#include "palpate/materials/material.h"
#include "palpate/scene/description.h"
#include "palpate/scene/units.h"

namespace palpate {

/// A place in a document.
struct Mark {
  int line = 0;    ///< from 1; 0: none
  int column = 0;  ///< [bytes] from 1
};

/// A value of a parsed YAML document, with all below it.
struct PALPATE_EXPORT Node {
  /// The kinds of values; kNull: nothing is written.
  enum class Kind { kNull, kScalar, kSequence, kMap };
  struct Entry;

  Kind kind = Kind::kNull;       ///< decides which of the other members have a value
  Mark mark = {};                ///< where its text begins
  std::string text = {};         ///< scalar: as written
  bool quoted = false;           ///< scalar: "..." or '...': text, never a number
  std::vector<Node> items = {};  ///< sequence: in the file's order
  std::vector<Entry> entries;    ///< map: in the file's order (no "= {}": Entry is incomplete here)

  /// The value at `key`; null if the key is not there, or this is not a map.
  [[nodiscard]] const Node* find(std::string_view key) const noexcept;
};

/// A key of a map and its value.
struct Node::Entry {
  std::string key;  ///< unique within its map
  Mark key_mark;    ///< where the key begins
  Node value;       ///< kNull where nothing follows the key
};

/// A parsed file, with its text for messages.
struct PALPATE_EXPORT Document {
  std::string file;                ///< as the user named it, for messages
  std::vector<std::string> lines;  ///< of the source, for excerpts
  Node root;                       ///< the top level

  /// File, line, column and line's text, to be kept for errors that are found later.
  [[nodiscard]] SourcePlace place(Mark mark) const;
  /// An Error (kInput) at `mark` that shows the offending line; the caller throws it.
  [[nodiscard]] Error error(Mark mark, std::string code, std::string message,
                            std::string hint = {}) const;
};

/// @throws Error (kInput).
[[nodiscard]] PALPATE_EXPORT std::shared_ptr<const Document> parseDocument(std::string_view text,
                                                                           std::string file);
/// Reads and parses a file. @throws Error (kInput): document.open if it cannot be read, else as
/// parseDocument().
[[nodiscard]] PALPATE_EXPORT std::shared_ptr<const Document> readDocument(const std::string& path);

class SceneLoader;

class Vocabulary;  // vocabulary.h: maps, keys, and the values that keys may have, as data
struct MapWords;
struct KeyWords;
using VocabularyPtr = std::shared_ptr<const Vocabulary>;  ///< shared and unchanging

/// The vocabulary that lib itself reads. The top level is the map "scene"; the kinds of fields are
/// the keys of "field_kind".
[[nodiscard]] PALPATE_EXPORT const VocabularyPtr& sceneVocabulary();

/// Reads a map node. A map that the vocabulary declares is checked as a whole when it is opened:
/// unknown and missing keys, types and bounds; value(), text() and similar getters then only fetch
/// the value that is there, or the declared default. In any other map every key must be read by
/// require(), optional() or one of the getters with a fallback, and finish() reports every key left
/// over as an error with a suggestion. All throw Error (kInput) at the offending place.
class PALPATE_EXPORT MapReader {
 public:
  /// For a map that is not declared; messages call it `what`. `loader` and `map` must outlive the
  /// reader. @throws Error (kInput) if `map` is not a map.
  MapReader(const SceneLoader& loader, const Node& map, std::string what);
  /// `declared`: the vocabulary's name of the map; if the vocabulary has no keys for it, the map is
  /// read as one that is not declared.
  MapReader(const SceneLoader& loader, const Node& map, std::string what,
            std::string_view declared);

  /// Whether the map has the key; it does not count as read by this.
  [[nodiscard]] bool has(std::string_view key) const noexcept;
  /// The node at a declared key; null if the key is not there.
  [[nodiscard]] const Node* find(std::string_view key) const noexcept { return map_->find(key); }
  /// A number, or a quantity in SI; if absent, the declared default, or 0 if that default is stated
  /// in words.
  [[nodiscard]] double value(std::string_view key) const;
  [[nodiscard]] std::string text(std::string_view key) const;  ///< "" without a default
  [[nodiscard]] int choice(std::string_view key) const;        ///< -1 without a default
  /// `true` or `false`; without a default: false.
  [[nodiscard]] bool flag(std::string_view key) const;
  [[nodiscard]] Vec3 point(std::string_view key) const;  ///< [m], or a direction
  /// The map at `key`, opened; `key` must be there.
  [[nodiscard]] MapReader map(std::string_view key) const;
  /// The maps in the list at `key`.
  [[nodiscard]] std::vector<MapReader> maps(std::string_view key) const;

  /// The value of a key that must be there.
  [[nodiscard]] const Node& require(std::string_view key);
  /// The value of a key that may be left out; null if it is. A key without a value is an error.
  [[nodiscard]] const Node* optional(std::string_view key);
  /// The text of a key that must be there; a bare number, `true` or `false` is an error.
  [[nodiscard]] std::string requireText(std::string_view key);
  /// The text of a key as requireText(), or `fallback` if it is not there.
  [[nodiscard]] std::string textOr(std::string_view key, std::string fallback);
  /// The number of a key that must be there, without a unit.
  [[nodiscard]] double requireNumber(std::string_view key);
  /// The same, or `fallback` if the key is not there.
  [[nodiscard]] double numberOr(std::string_view key, double fallback);
  [[nodiscard]] bool boolOr(std::string_view key, bool fallback);  ///< only true and false
  /// A bare number in the file's length unit, or a text with a unit; the result is in [m].
  [[nodiscard]] double requireLength(std::string_view key);
  /// As requireLength(), or `fallback_meters` [m] if the key is not there.
  [[nodiscard]] double lengthOr(std::string_view key, double fallback_meters);
  [[nodiscard]] Vec3 requirePoint(std::string_view key);  ///< lengths, in [m]
  /// Error at the key's value (or at the map if the key is not there).
  [[nodiscard]] Error errorAt(std::string_view key, std::string code, std::string message,
                              std::string hint = {}) const;
  /// Throws if a key was not read.
  void finish();

  /// Access to the file that the map is part of.
  [[nodiscard]] const SceneLoader& loader() const noexcept { return *loader_; }
  /// The map itself.
  [[nodiscard]] const Node& node() const noexcept { return *map_; }
  /// The vocabulary's entry for a key of this map, which must be declared there.
  [[nodiscard]] const KeyWords& words(std::string_view key) const;

 private:
  [[nodiscard]] Error unknown(const Node::Entry& entry,
                              const std::vector<std::string_view>& names) const;

  const SceneLoader* loader_;
  const Node* map_;
  std::string what_;
  const MapWords* words_ = nullptr;
  std::vector<std::string> known_;
};

/// The kind of quantity that a map holds.
struct ParameterKind {
  std::string key;                          ///< "stiffness"
  std::optional<Dimension> dimension = {};  ///< no value: a ratio
  bool is_signed = false;                   ///< negative values have a meaning, as for a velocity
};

/// Access to the file being read, for extensions of the loader.
class PALPATE_EXPORT SceneLoader {
 public:
  virtual ~SceneLoader() = default;
  /// The file that is read; valid as long as the loader.
  [[nodiscard]] virtual const Document& document() const noexcept = 0;
  /// The maps and keys that the file may have; the default is lib's own.
  [[nodiscard]] virtual const Vocabulary& vocabulary() const { return *sceneVocabulary(); }
  /// [m] The length of one unit of bare numbers, from `length:`.
  [[nodiscard]] virtual double metersPerUnit() const noexcept = 0;
  /// That unit as the file names it: "mm".
  [[nodiscard]] virtual std::string lengthUnit() const = 0;
  /// A path written in the scene, made relative to the scene file's folder.
  [[nodiscard]] virtual std::string resolvePath(const std::string& path) const = 0;
  /// A field written as a name, or inline as {kind: {...}}.
  [[nodiscard]] virtual FieldSourcePtr field(const Node& node) const = 0;
  /// The object that the registry's image reader made of `images.NAME`; error at `place` if there
  /// is none.
  [[nodiscard]] virtual std::shared_ptr<void> image(const std::string& name, Mark place) const = 0;
  /// The map of a parameter, written as {grid: {...}} or another kind that the registry has.
  [[nodiscard]] virtual MaterialMapPtr map(const Node& node, const ParameterKind& of) const = 0;
};

/// Kinds that other modules add: the functions that make them, by their YAML keys, and the keys
/// that may be written for them. A kind that the vocabulary does not declare reads its keys itself.
struct SceneRegistry {
  /// `fields: {x: {mesh: {...}}}`: makes the source of a field; must not do heavy work itself.
  using FieldKind = std::function<FieldSourcePtr(MapReader&)>;
  /// One entry of `images:`; opaque to lib.
  using ImageKind = std::function<std::shared_ptr<void>(MapReader&)>;
  /// `layers: [{name, labels: {...}}]`: the source of the layer's field, and its label group with
  /// the labels of that group that it owns, ascending.
  struct LayerSurface {
    FieldSourcePtr inside;         ///< negative inside the layer
    std::string label_group = {};  ///< LayerDescription::label_group
    std::vector<int> labels = {};  ///< LayerDescription::labels
  };
  /// Reads the map at the kind's key of the layer `layer_name`.
  using LayerKind = std::function<LayerSurface(MapReader&, const std::string& layer_name)>;
  /// `stiffness: {image: ct, transfer: [...]}`: reads the map whose keys include the kind's name.
  /// It is made at once, as its range decides whether it is allowed there.
  using ParameterMapKind = std::function<MaterialMapPtr(MapReader&, const ParameterKind&)>;

  /// `grids: {tolerance, voxel}`: what a grid for a layer made of formulas has to satisfy.
  struct GridChoice {
    std::string layer;                ///< name of the layer
    std::string length_unit;          ///< unit of the scene file, for the grids' coordinates
    double tolerance = 0.0;           ///< [m] by how much a grid may be off
    double voxel_size = 0.0;          ///< [m] 0: not given
    std::vector<FieldPtr> keep = {};  ///< fields to keep as they are, since ports name them
    SourcePlace place = {};           ///< of `grids:`
  };
  /// The same field with some parts replaced by grids: those that a grid holds within the tolerance
  /// and answers faster. It is made when it is asked for.
  using GridChooser = std::function<FieldSourcePtr(const FieldSourcePtr&, const GridChoice&)>;

  /// Maps and keys that the file may have; must declare at least those of sceneVocabulary().
  VocabularyPtr vocabulary = sceneVocabulary();
  std::map<std::string, FieldKind> fields = {};       ///< by kind: the key under `fields:`
  std::map<std::string, LayerKind> layers = {};       ///< by kind: the key of a layer
  std::map<std::string, ParameterMapKind> maps = {};  ///< by kind: a key of a parameter's map
  ImageKind image = {};                               ///< empty: `images:` is an error
  GridChooser choose_grids = {};                      ///< empty: `grids:` is an error
};

/// @throws Error (kInput) for the first problem found, with file:line:column, the line and a
/// remedy.
[[nodiscard]] PALPATE_EXPORT SceneDescription parseScene(std::string_view text,
                                                         const std::string& file,
                                                         const SceneRegistry& registry = {});
/// Reads the file `path`. @throws Error (kInput) as readDocument() and parseScene().
[[nodiscard]] PALPATE_EXPORT SceneDescription readScene(const std::string& path,
                                                        const SceneRegistry& registry = {});

/// The closest of `candidates` to `word` if it is close enough to be a slip; else empty.
[[nodiscard]] PALPATE_EXPORT std::string suggest(std::string_view word,
                                                 std::span<const std::string_view> candidates);

/// True if `name` matches `glob` ('*' any run, '?' any one; everything else literal).
[[nodiscard]] PALPATE_EXPORT bool matchesGlob(std::string_view glob,
                                              std::string_view name) noexcept;

}  // namespace palpate
