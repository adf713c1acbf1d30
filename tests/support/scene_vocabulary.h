#pragma once
// The vocabulary of scene files, as the JSON Schema says it and as the reader shows it.

#include <set>
#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::testing {

using Words = std::set<std::string>;

/// The schema of scene files, data/schema/scene-1.json.
const Document& sceneSchema();

/// Keys that the schema allows in `definition`; the top level's for "".
Words schemaKeys(const std::string& definition);

/// Every key that the schema allows anywhere, but for names that authors give.
Words allSchemaKeys();

/// The keys that the reader knows in the map of `scene` where the key kNoKey stands: those its
/// refusal lists.
Words readerKeys(const std::string& scene, const SceneRegistry& registry,
                 const std::string& file = "test.yaml");

/// Unlike every key, so that the reader lists all it knows and suggests none.
inline constexpr const char* kNoKey = "qqqqqqqqqqqqqqqqqqqq";

}  // namespace palpate::testing
