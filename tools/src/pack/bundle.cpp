#include "pack/bundle.h"

#include <filesystem>
#include <type_traits>
#include <variant>

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

void open(std::string& input) {
  if (!input.empty() && isBundle(input)) input = (fs::path(input) / kBundleScene).string();
}

void open(std::vector<std::string>& inputs) {
  for (std::string& input : inputs) open(input);
}

}  // namespace

bool isBundle(const std::string& folder) {
  std::error_code failed;
  return fs::is_directory(folder, failed) &&
         fs::is_regular_file(fs::path(folder) / kBundleAbout, failed) &&
         fs::is_regular_file(fs::path(folder) / kBundleScene, failed);
}

std::string bundleGridsOf(const std::string& scene_file) {
  const fs::path file(scene_file);
  const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  return isBundle(folder.string()) ? (folder / kBundleGrids).string() : std::string();
}

void openBundles(AnyOptions& options) {
  std::visit(
      [](auto& of) {
        using Options = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Options, ViewOptions>) {
          open(of.touch.scene);
        } else if constexpr (std::is_same_v<Options, ReportOptions>) {
          open(of.inputs);
        } else if constexpr (std::is_same_v<Options, ConvertOptions>) {
          open(of.bake.input);
        } else if constexpr (std::is_same_v<Options, BenchOptions>) {
          // A bench names its own scenes, not files.
        } else if constexpr (requires { of.scene; }) {
          open(of.scene);
        } else if constexpr (requires { of.input; }) {
          open(of.input);
        } else if constexpr (requires { of.files; }) {
          open(of.files);
        }
      },
      options);
}

}  // namespace palpate::tools
