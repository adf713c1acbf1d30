#pragma once
/// SceneLoader for one file, which reads the sections of a scene.

#include <map>
#include <memory>
#include <string>

#include "palpate/scene/scene_file.h"
#include "scene/field_reader.h"

namespace palpate {

class FileLoader final : public SceneLoader {
 public:
  /// Both must outlive the loader.
  FileLoader(const Document& document, const SceneRegistry& registry)
      : document_(document), registry_(registry), fields_(*this, registry) {}

  [[nodiscard]] const Document& document() const noexcept override { return document_; }
  [[nodiscard]] const Vocabulary& vocabulary() const override { return *registry_.vocabulary; }
  [[nodiscard]] double metersPerUnit() const noexcept override { return meters_per_unit_; }
  [[nodiscard]] std::string lengthUnit() const override { return length_unit_; }
  [[nodiscard]] std::string resolvePath(const std::string& path) const override;
  [[nodiscard]] FieldSourcePtr field(const Node& node) const override { return fields_.read(node); }
  [[nodiscard]] std::shared_ptr<void> image(const std::string& name, Mark place) const override;
  [[nodiscard]] MaterialMapPtr map(const Node& node, const ParameterKind& of) const override;

  /// Reads the whole scene. To be called once.
  [[nodiscard]] SceneDescription read();

 private:
  void readVersion(const Node& root) const;
  void readImages(const Node& images);

  const Document& document_;
  const SceneRegistry& registry_;
  mutable FieldReader fields_;  // caches the fields that it made
  std::map<std::string, std::shared_ptr<void>, std::less<>> images_ = {};
  std::string length_unit_ = "m";
  double meters_per_unit_ = 1.0;
};

}  // namespace palpate
