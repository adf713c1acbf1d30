#pragma once
/// A scene file, read with every kind that palpate::vdb adds, and the cost of its grids.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "console.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/register.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

/// An entry of the scene's `images`.
struct SceneImage {
  std::string name;
  std::string file;           ///< as this process can open it
  vdb::ImageOptions options;  ///< how the scene reads it
  bool has_names = false;     ///< true for a label image, false for gray values
};

/// Neither copied nor moved: the description's sources report back to it.
class LoadedScene {
 public:
  /// Reads the file; makes no grid yet. @throws Error (kInput).
  /// `max_memory` [bytes] of each grid; 0: the library's own limit.
  /// `text`: the text of the scene, if `file` does not hold it itself (a mesh, say).
  LoadedScene(const std::string& file, Console& console, std::uint64_t max_memory = 0,
              const std::string& text = {});
  LoadedScene(const LoadedScene&) = delete;
  LoadedScene& operator=(const LoadedScene&) = delete;

  [[nodiscard]] const SceneDescription& description() const noexcept { return description_; }
  [[nodiscard]] LengthUnit unit() const;
  [[nodiscard]] const std::vector<SceneImage>& images() const noexcept { return images_; }
  /// The colors of layers that come from labels with a color.
  [[nodiscard]] const std::map<std::string, vdb::LabelColor>& colors() const noexcept {
    return colors_;
  }
  [[nodiscard]] const std::vector<vdb::GridRecord>& grids() const noexcept { return grids_; }

  /// Compiles, with progress. @throws Error.
  [[nodiscard]] ScenePtr compile(Purpose purpose = Purpose::kShow) const;

  [[nodiscard]] Json gridsJson() const;
  [[nodiscard]] Table gridsTable() const;
  [[nodiscard]] std::string gridsText() const;  ///< empty if there is none; ends with lossText()
  /// The parts of scans that grids could not hold, one line each; empty if nothing was lost.
  [[nodiscard]] std::string lossText() const;

 private:
  Console* console_;
  std::vector<vdb::GridRecord> grids_;
  std::vector<SceneImage> images_;
  std::map<std::string, vdb::LabelColor> colors_;
  SceneDescription description_;
};

}  // namespace palpate::tools
