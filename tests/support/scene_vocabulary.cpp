#include "support/scene_vocabulary.h"

#include <gtest/gtest.h>

#include <sstream>

#include "folders/folders.h"

namespace palpate::testing {

const Document& sceneSchema() {
  // JSON is a subset of the language that the scene reader accepts.
  static const auto schema = readDocument(test::sourceFolder() + "/data/schema/scene-1.json");
  return *schema;
}

Words schemaKeys(const std::string& definition) {
  const Node* map = &sceneSchema().root;
  if (!definition.empty()) map = map->find("definitions")->find(definition);
  Words keys;
  const Node* properties = map == nullptr ? nullptr : map->find("properties");
  if (properties == nullptr) {
    ADD_FAILURE() << "the schema has no map " << definition;
    return keys;
  }
  for (const Node::Entry& entry : properties->entries) keys.insert(entry.key);
  return keys;
}

Words allSchemaKeys() {
  Words keys = schemaKeys("");
  for (const Node::Entry& definition : sceneSchema().root.find("definitions")->entries) {
    if (definition.value.find("properties") != nullptr) keys.merge(schemaKeys(definition.key));
  }
  // One map is too small to have a definition of its own.
  keys.insert("region");
  return keys;
}

Words readerKeys(const std::string& scene, const SceneRegistry& registry, const std::string& file) {
  Words keys;
  try {
    (void)parseScene(scene, file, registry);
    ADD_FAILURE() << "accepted: " << scene;
  } catch (const Error& error) {
    const std::string& hint = error.problem().hint;
    const std::size_t colon = hint.find(": ");
    EXPECT_NE(error.problem().message.find(kNoKey), std::string::npos) << error.what();
    EXPECT_NE(colon, std::string::npos) << error.what();
    if (colon == std::string::npos) return keys;
    std::istringstream names(hint.substr(colon + 2));
    for (std::string name; names >> name;) {
      if (name.back() == ',') name.pop_back();
      keys.insert(name);
    }
  }
  return keys;
}

}  // namespace palpate::testing
