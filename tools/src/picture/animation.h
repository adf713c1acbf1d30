#pragma once
/// Pictures one after the other, as an animated WebP. The only place that knows the encoder.

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

  /// `milliseconds`: how long it is seen. @throws Error (kOperation).
  void add(const Canvas& frame, int milliseconds);
  /// The file's bytes; it begins anew at its end, for ever. @throws Error (kOperation).
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::tools
