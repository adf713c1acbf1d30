#pragma once
/// Files that stand for the scans of a bundle (scanStandIn).

#include <string>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

struct StandIn {
  std::string content_key;  ///< key of the image's files, and of the options by which they are read
  LabelTable labels;
  bool is_labels = false;
};

/// @throws Error (kInput, pack.stand_in) for a file that is not a stand-in.
[[nodiscard]] StandIn readStandIn(const std::string& path);

}  // namespace palpate::vdb
