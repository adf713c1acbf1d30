#pragma once
/// The verbs. Each does its work, writes its files and returns its report; each throws
/// palpate::Error.

#include "console.h"
#include "options.h"
#include "report.h"

namespace palpate::tools {

[[nodiscard]] Report run(const TouchOptions& asked, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const BakeOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const ConvertOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const ImportOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const InfoOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const CheckOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const QueryOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const ExplainOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const RenderOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const BenchOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const AccuracyOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const DevicesOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const DoctorOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const ReportOptions& options, const GeneralOptions& general,
                         Console& console);
[[nodiscard]] Report run(const ViewOptions& asked, const GeneralOptions& general, Console& console);
[[nodiscard]] Report run(const ReplayOptions& options, const GeneralOptions& general,
                         Console& console);

}  // namespace palpate::tools
