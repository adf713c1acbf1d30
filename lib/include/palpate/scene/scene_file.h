#pragma once
/// Scene files: YAML -> Document -> SceneDescription, strictly. What reads other files (meshes,
/// grids, scans) is not known here; it comes through a SceneRegistry that the vdb module fills.
///
/// A Document is a strict YAML subset as an immutable tree with places. No yaml-cpp type is visible
/// here. Refused with file:line:column: duplicate keys, aliases and anchors, tags, more than one
/// document, keys that are not plain text, nesting deeper than 64. JSON is a subset and is read
/// too.

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

struct Mark {
  int line = 0;    ///< from 1
  int column = 0;  ///< from 1
};

struct PALPATE_EXPORT Node {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  struct Entry;

  Kind kind = Kind::kNull;
  Mark mark = {};
  std::string text = {};  ///< scalar: as written
  bool quoted = false;    ///< scalar: "..." or '...': text, never a number
  std::vector<Node> items = {};
  std::vector<Entry> entries;  ///< map: in the order of the file (no "= {}": Entry is incomplete)

  [[nodiscard]] const Node* find(std::string_view key) const noexcept;
};

struct Node::Entry {
  std::string key;
  Mark key_mark;
  Node value;
};

struct PALPATE_EXPORT Document {
  std::string file;                ///< as the user named it, for messages
  std::vector<std::string> lines;  ///< of the source, for excerpts
  Node root;

  [[nodiscard]] SourcePlace place(Mark mark) const;
  [[nodiscard]] Error error(Mark mark, std::string code, std::string message,
                            std::string hint = {}) const;
};

/// @throws Error (kInput).
[[nodiscard]] PALPATE_EXPORT std::shared_ptr<const Document> parseDocument(std::string_view text,
                                                                           std::string file);
[[nodiscard]] PALPATE_EXPORT std::shared_ptr<const Document> readDocument(const std::string& path);

class SceneLoader;

class Vocabulary;  // vocabulary.h: maps, keys, and what may stand at them, as data
struct MapWords;
struct KeyWords;
using VocabularyPtr = std::shared_ptr<const Vocabulary>;

/// What lib itself reads. The top level is the map "scene"; the kinds of fields are the keys of
/// "field_kind".
[[nodiscard]] PALPATE_EXPORT const VocabularyPtr& sceneVocabulary();

/// A map node being read. A map that the vocabulary declares is checked whole when it is opened:
/// unknown and missing keys, types and bounds; value(), text() and their like then only fetch what
/// is there, or the declared default. In any other map every key must be asked for, by require(),
/// optional() or one of the getters with a fallback, and what is left over is an error with a
/// suggestion (finish()). All throw Error (kInput) at the offending place.
class PALPATE_EXPORT MapReader {
 public:
  MapReader(const SceneLoader& loader, const Node& map, std::string what);
  /// `declared`: the vocabulary's name of the map; read as one that it does not declare if it has
  /// no keys for it.
  MapReader(const SceneLoader& loader, const Node& map, std::string what,
            std::string_view declared);

  [[nodiscard]] bool has(std::string_view key) const noexcept;
  /// What is written at a declared key; null if it is not there.
  [[nodiscard]] const Node* find(std::string_view key) const noexcept { return map_->find(key); }
  /// A number, or a quantity in SI; not given: the declared default, or 0 where that is in words.
  [[nodiscard]] double value(std::string_view key) const;
  [[nodiscard]] std::string text(std::string_view key) const;  ///< "" without a default
  [[nodiscard]] int choice(std::string_view key) const;        ///< -1 without a default
  [[nodiscard]] bool flag(std::string_view key) const;
  [[nodiscard]] Vec3 point(std::string_view key) const;  ///< [m], or a direction
  /// The map at `key`, opened; `key` must be there.
  [[nodiscard]] MapReader map(std::string_view key) const;
  /// The maps of a list of them.
  [[nodiscard]] std::vector<MapReader> maps(std::string_view key) const;

  [[nodiscard]] const Node& require(std::string_view key);
  [[nodiscard]] const Node* optional(std::string_view key);
  [[nodiscard]] std::string requireText(std::string_view key);
  [[nodiscard]] std::string textOr(std::string_view key, std::string fallback);
  [[nodiscard]] double requireNumber(std::string_view key);
  [[nodiscard]] double numberOr(std::string_view key, double fallback);
  [[nodiscard]] bool boolOr(std::string_view key, bool fallback);  ///< only true and false
  /// A bare number in the file's length unit, or a text with a unit; in [m].
  [[nodiscard]] double requireLength(std::string_view key);
  [[nodiscard]] double lengthOr(std::string_view key, double fallback_meters);
  [[nodiscard]] Vec3 requirePoint(std::string_view key);  ///< lengths, in [m]
  /// Error at the key's value (or at the map if the key is not there).
  [[nodiscard]] Error errorAt(std::string_view key, std::string code, std::string message,
                              std::string hint = {}) const;
  /// Throws if a key was not asked for.
  void finish();

  [[nodiscard]] const SceneLoader& loader() const noexcept { return *loader_; }
  [[nodiscard]] const Node& node() const noexcept { return *map_; }
  /// What the vocabulary says of a key of this map, which it must declare.
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

/// What a map is of.
struct ParameterKind {
  std::string key;                          ///< "stiffness"
  std::optional<Dimension> dimension = {};  ///< none: a ratio
  bool is_signed = false;                   ///< values below 0 have a meaning, as of a velocity
};

/// What a loader extension needs to know of the file that is being read.
class PALPATE_EXPORT SceneLoader {
 public:
  virtual ~SceneLoader() = default;
  [[nodiscard]] virtual const Document& document() const noexcept = 0;
  [[nodiscard]] virtual const Vocabulary& vocabulary() const { return *sceneVocabulary(); }
  [[nodiscard]] virtual double metersPerUnit() const noexcept = 0;
  [[nodiscard]] virtual std::string lengthUnit() const = 0;
  /// A path written in the scene, made relative to the scene file's folder.
  [[nodiscard]] virtual std::string resolvePath(const std::string& path) const = 0;
  /// A field written as a name, or inline as {kind: {...}}.
  [[nodiscard]] virtual FieldSourcePtr field(const Node& node) const = 0;
  /// What the registry's image reader made of `images.NAME`; error at `place` if there is none.
  [[nodiscard]] virtual std::shared_ptr<void> image(const std::string& name, Mark place) const = 0;
  /// The map of a parameter, written as {grid: {...}} or whatever kinds the registry has.
  [[nodiscard]] virtual MaterialMapPtr map(const Node& node, const ParameterKind& of) const = 0;
};

/// Kinds that other modules add: what makes them, by their YAML keys, and what may be written of
/// them. A kind that the vocabulary does not declare asks for its keys itself.
struct SceneRegistry {
  /// `fields: {x: {mesh: {...}}}`: makes the source of a field; must not do heavy work itself.
  using FieldKind = std::function<FieldSourcePtr(MapReader&)>;
  /// One entry of `images:`; opaque to lib.
  using ImageKind = std::function<std::shared_ptr<void>(MapReader&)>;
  /// `layers: [{name, labels: {...}}]`: what the layer's field comes from, and its label group
  /// with the labels, ascending, that it has of it.
  struct LayerSurface {
    FieldSourcePtr inside;
    std::string label_group = {};
    std::vector<int> labels = {};
  };
  using LayerKind = std::function<LayerSurface(MapReader&, const std::string& layer_name)>;
  /// `stiffness: {image: ct, transfer: [...]}`: reads the map whose keys include the kind's name.
  /// It is made at once, as its range decides whether it may stand there.
  using ParameterMapKind = std::function<MaterialMapPtr(MapReader&, const ParameterKind&)>;

  /// `grids: {tolerance, voxel}`: what a layer made of formulas is asked to become.
  struct GridChoice {
    std::string layer;
    std::string length_unit;
    double tolerance = 0.0;           ///< [m] by how much a grid may be off
    double voxel_size = 0.0;          ///< [m] 0: not said
    std::vector<FieldPtr> keep = {};  ///< these stay as they are, as ports name them
    SourcePlace place = {};
  };
  /// The same field, of which the parts that a grid holds within the tolerance and answers faster
  /// are grids; made when it is asked for.
  using GridChooser = std::function<FieldSourcePtr(const FieldSourcePtr&, const GridChoice&)>;

  VocabularyPtr vocabulary = sceneVocabulary();
  std::map<std::string, FieldKind> fields = {};
  std::map<std::string, LayerKind> layers = {};
  std::map<std::string, ParameterMapKind> maps = {};
  ImageKind image = {};
  GridChooser choose_grids = {};
};

/// @throws Error (kInput) for the first problem found, with file:line:column, the line and a
/// remedy.
[[nodiscard]] PALPATE_EXPORT SceneDescription parseScene(std::string_view text,
                                                         const std::string& file,
                                                         const SceneRegistry& registry = {});
[[nodiscard]] PALPATE_EXPORT SceneDescription readScene(const std::string& path,
                                                        const SceneRegistry& registry = {});

/// The closest of `candidates` to `word` if it is close enough to be a slip; else empty.
[[nodiscard]] PALPATE_EXPORT std::string suggest(std::string_view word,
                                                 std::span<const std::string_view> candidates);

/// True if `name` matches `glob` ('*' any run, '?' any one; everything else literal).
[[nodiscard]] PALPATE_EXPORT bool matchesGlob(std::string_view glob,
                                              std::string_view name) noexcept;

}  // namespace palpate
