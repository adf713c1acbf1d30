#pragma once
/// Files that stand for the scans of a bundle (scanStandIn).

#include <string>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

struct StandIn {
  std::string content_key;  ///< of the image's files, and of how they are understood
  LabelTable labels;
  bool is_labels = false;
};

/// @throws Error (kInput, pack.stand_in) for what is none.
[[nodiscard]] StandIn readStandIn(const std::string& path);

}  // namespace palpate::vdb
