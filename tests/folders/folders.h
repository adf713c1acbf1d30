#pragma once
// The folders of the sources and of the build. Only one source file of the tests contains these
// paths, so that the compiler cache serves the other files in every clone.

#include <string>

namespace palpate::test {

/// The top of the source tree.
[[nodiscard]] std::string sourceFolder();

/// The top of the build folder.
[[nodiscard]] std::string buildFolder();

}  // namespace palpate::test
