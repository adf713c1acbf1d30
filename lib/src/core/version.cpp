#include "palpate/version.h"

namespace palpate {

const char* version() noexcept { return PALPATE_VERSION_STRING; }

}  // namespace palpate
