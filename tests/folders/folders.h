#pragma once
// Where the sources and the build are. One file of the tests holds these paths, so that the
// compiler's cache serves the other files in every clone.

#include <string>

namespace palpate::test {

/// The top of the source tree.
[[nodiscard]] std::string sourceFolder();

/// The top of the build folder.
[[nodiscard]] std::string buildFolder();

}  // namespace palpate::test
