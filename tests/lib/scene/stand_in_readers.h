#pragma once
/// Replacements for the readers of palpate::vdb, which lib's tests do not link: they read the same
/// keys and return spheres.

#include <memory>
#include <string>

#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "support/test_maps.h"

namespace palpate {

inline SceneRegistry standInReaders() {
  const auto later = [](const std::string& summary, double radius) {
    return std::make_shared<FieldSource>(
        summary, [radius](const Progress&) { return sphere(Vec3(0.0), radius); });
  };
  SceneRegistry registry;
  registry.fields["mesh"] = [later](MapReader& reader) {
    const std::string file = reader.loader().resolvePath(reader.requireText("file"));
    (void)reader.textOr("units", "");
    (void)reader.textOr("space", "");
    (void)reader.numberOr("half_width", 6.0);
    (void)reader.textOr("sampler", "");
    (void)reader.textOr("sign", "");
    (void)reader.textOr("edges", "");
    (void)reader.numberOr("sharp", 0.0);
    (void)reader.lengthOr("shell", 1.0);
    (void)reader.numberOr("smooth", 30.0);
    return later("mesh " + file, reader.lengthOr("voxel", 1.0));
  };
  registry.fields["grid"] = [later](MapReader& reader) {
    const std::string file = reader.loader().resolvePath(reader.requireText("file"));
    (void)reader.textOr("name", "");
    (void)reader.textOr("units", "");
    (void)reader.textOr("class", "");
    (void)reader.textOr("sampler", "");
    return later("grid " + file, 1.0);
  };
  registry.choose_grids = [](const FieldSourcePtr& field, const SceneRegistry::GridChoice&) {
    return field;
  };
  registry.fields["mask"] = [later](MapReader& reader) {
    const std::string file = reader.loader().resolvePath(reader.requireText("file"));
    for (const char* key : {"name", "units", "sampler"}) (void)reader.textOr(key, "");
    (void)reader.numberOr("above", 0.5);
    return later("mask " + file, reader.lengthOr("voxel", 1.0));
  };
  registry.fields["baked"] = [](MapReader& reader) {
    const FieldSourcePtr field = reader.loader().field(reader.require("field"));
    (void)reader.lengthOr("voxel", 1.0);
    (void)reader.numberOr("half_width", 6.0);
    (void)reader.textOr("sampler", "");
    (void)reader.textOr("parts", "");
    (void)reader.lengthOr("tolerance", 1.0);
    (void)reader.textOr("file", "");
    (void)reader.textOr("name", "");
    return field;
  };
  registry.image = [](MapReader& reader) -> std::shared_ptr<void> {
    auto file = std::make_shared<std::string>(reader.requireText("file"));
    (void)reader.textOr("names", "");
    (void)reader.textOr("affine", "");
    (void)reader.textOr("space", "");
    (void)reader.numberOr("frame", 0.0);
    (void)reader.textOr("series", "");
    (void)reader.optional("resample");
    for (const char* list : {"with", "priority"}) (void)reader.optional(list);
    return file;
  };
  const auto image = [](MapReader& reader) {
    const Node& node = reader.require("image");
    return *std::static_pointer_cast<std::string>(reader.loader().image(node.text, node.mark));
  };
  registry.layers["labels"] = [later, image](MapReader& reader, const std::string& name) {
    const std::string file = image(reader);
    (void)reader.require("match");
    (void)reader.textOr("sampler", "");
    return SceneRegistry::LayerSurface{
        later("labels of " + file + " for " + name, reader.lengthOr("voxel", 1.0)), file};
  };
  registry.layers["threshold"] = [later, image](MapReader& reader, const std::string&) {
    const std::string file = image(reader);
    if (reader.optional("below") == nullptr) (void)reader.requireNumber("above");
    (void)reader.textOr("keep", "all");
    (void)reader.textOr("sampler", "");
    (void)reader.boolOr("fill", false);
    return SceneRegistry::LayerSurface{later("threshold of " + file, reader.lengthOr("voxel", 1.0)),
                                       ""};
  };
  // Low enough to be the height of a texture.
  registry.maps["grid"] = [](MapReader& outer, const ParameterKind&) {
    MapReader reader(outer.loader(), outer.require("grid"), "'grid'");
    (void)reader.requireText("file");
    for (const char* key : {"name", "unit", "units", "tolerance"}) (void)reader.optional(key);
    reader.finish();
    return testing::flatMap(1e-4);
  };
  registry.maps["image"] = [image](MapReader& reader, const ParameterKind&) {
    (void)image(reader);
    (void)reader.require("transfer");
    (void)reader.optional("tolerance");
    return testing::flatMap(1e-4);
  };
  // No field is worth a grid.
  registry.choose_grids = [](const FieldSourcePtr& field, const SceneRegistry::GridChoice&) {
    return field;
  };
  return registry;
}

}  // namespace palpate
