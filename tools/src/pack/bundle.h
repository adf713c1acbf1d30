#pragma once
/// Recognizes a folder that is a bundle of `palpate pack`.

#include <string>

#include "pack/pack_options.h"

namespace palpate::tools {

inline constexpr const char* kBundleScene = "scene.yaml";
inline constexpr const char* kBundleAbout = "pack.json";
inline constexpr const char* kBundleGrids = "grids";
inline constexpr const char* kBundleFiles = "files";

[[nodiscard]] bool isBundle(const std::string& folder);

/// The folder of the grids of a bundle's scene; empty for any other scene.
[[nodiscard]] std::string bundleGridsOf(const std::string& scene_file);

/// Replaces the folder of a bundle by the scene in it, wherever a verb takes a scene.
void openBundles(AnyOptions& options);

}  // namespace palpate::tools
