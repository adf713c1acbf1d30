#pragma once
/// A sequence of pictures as an animated WebP. The only file that uses the encoder.

#include <memory>
#include <string>

#include "picture/canvas.h"

namespace palpate::tools {

class Animation {
 public:
  /// All frames are of this size. @throws Error (kOperation).
  Animation(int width, int height);
  ~Animation();
  Animation(const Animation&) = delete;
  Animation& operator=(const Animation&) = delete;

  /// `milliseconds`: how long the frame is shown. @throws Error (kOperation).
  void add(const Canvas& frame, int milliseconds);
  /// The file's bytes; the animation repeats endlessly. @throws Error (kOperation).
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::tools
