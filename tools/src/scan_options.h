#pragma once
/// Options that say what a scan or a mesh leaves open.

#include <string>

#include "console.h"
#include "options.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "text.h"

namespace palpate::tools {

[[nodiscard]] vdb::ImageOptions imageOptions(const ScanOptions& options);

/// The mesh in `file`, in `units`; if they are empty in those of its format, else in mm. Says what
/// was taken for granted of its unit and, if it may be of a scan, its space.
[[nodiscard]] vdb::Mesh readMeshFile(const std::string& file, const std::string& units,
                                     const ScanOptions& options, Console& console);

/// The unit of what is written about a mesh, and of its grid: mm if `units` is empty.
[[nodiscard]] LengthUnit meshUnit(const std::string& units);

/// "RAS", and why.
[[nodiscard]] std::string spaceText(const vdb::Mesh& mesh, const ScanOptions& options);

/// Throws Error (kUsage) if one of `options` was given that applies to images only.
void refuseScanOptions(const ScanOptions& options, bool is_mesh);

}  // namespace palpate::tools
