#pragma once
/// Options about facts that a scan or a mesh may not state.

#include <string>

#include "console.h"
#include "options.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "text.h"

namespace palpate::tools {

[[nodiscard]] vdb::ImageOptions imageOptions(const ScanOptions& options);

/// Reads the mesh in `file`, in `units`; if these are empty, in those of its format, else in mm.
/// Notes the assumptions about its unit and, if it may come from a scan, about its space.
[[nodiscard]] vdb::Mesh readMeshFile(const std::string& file, const std::string& units,
                                     const ScanOptions& options, Console& console);

/// The unit for texts about a mesh, and for its grid: mm if `units` is empty.
[[nodiscard]] LengthUnit meshUnit(const std::string& units);

/// "RAS", with the reason.
[[nodiscard]] std::string spaceText(const vdb::Mesh& mesh, const ScanOptions& options);

/// Throws Error (kUsage) if one of `options` was given that applies to images only.
void refuseScanOptions(const ScanOptions& options, bool is_mesh);

}  // namespace palpate::tools
