#pragma once
/// Code shared by all readers of images.

#include <string>
#include <utility>
#include <vector>

#include "image/place.h"
#include "palpate/core/error.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// An image for `path`, without its voxels.
[[nodiscard]] inline Image emptyImage(const std::string& path, const std::array<int, 3>& size,
                                      const Place& place, std::vector<std::string> notes) {
  Image image;
  image.source = path;
  image.size = size;
  image.axes = place.axes;
  image.origin = place.origin;
  image.notes = std::move(notes);
  return image;
}

[[nodiscard]] inline ImageInfo infoOf(const std::array<int, 3>& size, const Place& place,
                                      std::vector<std::string> notes) {
  ImageInfo info;
  info.size = size;
  info.axes = place.axes;
  info.origin = place.origin;
  info.orientation = orientationCodes(place.axes);
  info.notes = std::move(notes);
  info.length_unit = "mm";
  return info;
}

/// `format` is the prefix of the error's code.
[[nodiscard]] inline Error notEnoughMemory(const std::string& format, const std::string& path) {
  return Error(
      ErrorKind::kOperation,
      {format + ".memory", "there is not enough memory for the image", "crop the image", path});
}

}  // namespace palpate::vdb
