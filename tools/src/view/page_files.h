#pragma once
/// The files of the page, as they were built into the command.

#include <span>
#include <string_view>

namespace palpate::tools {

struct PageFile {
  std::string_view path;  ///< below the page's folder: "index.html"
  std::string_view type;  ///< "text/html;charset=utf-8"
  std::string_view bytes;
};

/// Empty in a build without a page.
[[nodiscard]] std::span<const PageFile> pageFiles() noexcept;

}  // namespace palpate::tools
