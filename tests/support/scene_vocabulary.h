#pragma once
// The vocabulary of scene files, as the JSON Schema states it and as the reader reports it.

#include <set>
#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::testing {

using Words = std::set<std::string>;

/// The schema of scene files, data/schema/scene-1.json.
const Document& sceneSchema();

/// Keys that the schema allows in `definition`; the top level's for "".
Words schemaKeys(const std::string& definition);

/// Every key that the schema allows anywhere, except names that authors choose.
Words allSchemaKeys();

/// The keys that the reader knows in the map of `scene` that contains the key kNoKey: its error
/// lists them.
Words readerKeys(const std::string& scene, const SceneRegistry& registry,
                 const std::string& file = "test.yaml");

/// A key unlike all others, so that the reader lists all keys and suggests none.
inline constexpr const char* kNoKey = "qqqqqqqqqqqqqqqqqqqq";

}  // namespace palpate::testing
