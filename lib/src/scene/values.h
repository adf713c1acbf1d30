#pragma once
/// Nodes read as values. `what` names the value in messages ("'radius' of sphere"). All throw Error
/// (kInput) at the node. All of them refuse an empty node.

#include <string>
#include <string_view>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/scene/scene_file.h"
#include "palpate/scene/vocabulary.h"

namespace palpate {

/// Any text. A plain scalar that YAML readers take for something else (12, true) must be quoted, so
/// that a scene means the same to every reader.
[[nodiscard]] std::string readText(const Document& document, const Node& node,
                                   const std::string& what);
[[nodiscard]] double readNumber(const Document& document, const Node& node,
                                const std::string& what);
[[nodiscard]] bool readBool(const Document& document, const Node& node, const std::string& what);
[[nodiscard]] double readQuantity(const Document& document, const Node& node, Dimension dimension,
                                  const std::string& what);
/// A bare number in the file's length unit, or a text with a unit; in [m].
[[nodiscard]] double readLength(const SceneLoader& loader, const Node& node,
                                const std::string& what);

/// `{axis, degrees}`: a rotation about an axis through the origin, by the right-hand rule.
[[nodiscard]] Mat3 readRotation(const MapReader& rotate);

/// The number at `node` for `key`, within its bounds; in SI.
[[nodiscard]] double readValue(const SceneLoader& loader, const Node& node, const KeyWords& key);
/// Three lengths, or three numbers that are a direction.
[[nodiscard]] Vec3 readVector(const SceneLoader& loader, const Node& node, const KeyWords& key);
/// Index of the choice that the node names.
[[nodiscard]] std::size_t readChoice(const Document& document, const Node& node,
                                     const KeyWords& key);
/// @throws Error unless the node is of the type of `key` and within its bounds. The contents of
/// fields, maps and lists of these are checked by their own readers.
void checkValue(const SceneLoader& loader, const Node& node, const KeyWords& key);

/// The items of a list of at least `least` and, unless 0, at most `most` items, none of them empty.
[[nodiscard]] const std::vector<Node>& readList(const Document& document, const Node& node,
                                                const std::string& what, std::size_t least,
                                                std::size_t most);
/// Index of the one of `choices` that the node names.
[[nodiscard]] std::size_t readChoice(const Document& document, const Node& node,
                                     const std::string& what,
                                     const std::vector<std::string_view>& choices);

/// The error that there is no `kind` ("port") of this name; the hint is drawn from `names`.
[[nodiscard]] Error unknownName(const Document& document, Mark mark, const std::string& kind,
                                const std::string& name,
                                const std::vector<std::string_view>& names);
/// The error that the node needs palpate::vdb, which the program does not have. `what` names the
/// thing that cannot be read.
[[nodiscard]] Error noReader(const Document& document, Mark mark, const std::string& what);

/// @throws Error unless `node` is a map.
void requireMap(const Document& document, const Node& node, const std::string& what);
/// @throws Error if the entry has no value; the error points at the key, because there is no value
/// to point at.
void refuseEmpty(const Document& document, const Node::Entry& entry);

}  // namespace palpate
