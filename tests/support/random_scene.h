#pragma once
/// Random scenes of constructive solid geometry, as scene files; each is reproducible from its
/// number.

#include <cstdint>
#include <string>

#include "palpate/scene/scene.h"
#include "palpate/scene/scene_file.h"

namespace palpate::test {

/// The parameters of a random scene.
struct RandomSceneOptions {
  int deepest = 5;                ///< 1 to 8: levels of operations above the primitives
  bool black_box_creases = true;  ///< blends may have operands with edges of their own
  double shell = 0.0;             ///< [mm] more than 0: the whole is a shell of this thickness
  // The same scene at another place. The numbers in the file are those printed before it is moved.
  bool mirrored = false;    ///< x becomes -x
  std::string unit = "mm";  ///< unit of its numbers
  std::string placed = {};  ///< further keys of `transform`, besides `field`; empty: not moved
};

/// A scene whose walls all have the default material: 1000 N/m, no friction, no damping, no ports.
struct RandomScene {
  std::uint64_t number = 0;
  int depth = 0;  ///< levels of operations
  bool is_label_group =
      false;  ///< the layers share one label image, which a scene file without an image cannot say
  std::string
      core;  ///< for a scene of one layer: its field as in the file, before it became a shell
  std::string yaml;  ///< for `palpate touch`; lengths in mm, all within 40 mm or so

  /// The description, with the label group if there is one.
  [[nodiscard]] SceneDescription description() const;
  [[nodiscard]] ScenePtr compiled() const { return compile(description()); }
  /// The field of `core`.
  [[nodiscard]] FieldPtr solid() const;
};

/// The same number and options give the same scene, on every platform. It may turn out empty, or
/// fill all space: then its start region has no point.
[[nodiscard]] RandomScene randomScene(std::uint64_t number, const RandomSceneOptions& options = {});

}  // namespace palpate::test
