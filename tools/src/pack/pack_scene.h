#pragma once
/// The verb `pack`.

#include "console.h"
#include "options.h"
#include "pack/pack_options.h"
#include "report.h"

namespace palpate::tools {

[[nodiscard]] Report run(const PackOptions& options, const GeneralOptions& general,
                         Console& console);

}  // namespace palpate::tools
