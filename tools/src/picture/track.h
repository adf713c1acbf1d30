#pragma once
/// The path of a hand in a picture: where the hand was, where the proxy was, and the force.

#include <span>
#include <string>
#include <vector>

#include "palpate/render/trace.h"

namespace palpate::tools {

struct Track {
  struct Point {
    Vec3 hip{0.0};    ///< [m]
    Vec3 proxy{0.0};  ///< [m]
    Vec3 force{0.0};  ///< [N]
  };
  std::vector<Point> points;

  [[nodiscard]] Box3 bounds() const;
};

[[nodiscard]] Track trackOf(std::span<const TraceRow> rows);

/// Reads a trace file. @throws Error (kInput) with file:line.
[[nodiscard]] Track readTrack(const std::string& file);

}  // namespace palpate::tools
