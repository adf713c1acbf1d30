#include "folders/folders.h"

namespace palpate::test {

std::string sourceFolder() { return PALPATE_SOURCE_DIR; }

std::string buildFolder() { return PALPATE_BINARY_DIR; }

}  // namespace palpate::test
