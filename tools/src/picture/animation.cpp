#include "picture/animation.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <string>

#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

constexpr float kQuality = 80.0F;  // of 100
constexpr int kEffort = 4;         // 0, fast, to 6, small

[[noreturn]] void fail(const std::string& why) {
  throw Error(ErrorKind::kOperation, {"picture.webp", "cannot make the animation: " + why,
                                      "try a smaller picture or fewer frames"});
}

}  // namespace

struct Animation::Impl {
  std::unique_ptr<WebPAnimEncoder, decltype(&WebPAnimEncoderDelete)> encoder = {
      nullptr, &WebPAnimEncoderDelete};
  WebPConfig config = {};
  int time = 0;  // [ms]
};

Animation::Animation(int width, int height) : impl_(std::make_unique<Impl>()) {
  WebPAnimEncoderOptions options;
  const bool is_ready =
      WebPAnimEncoderOptionsInit(&options) != 0 && WebPConfigInit(&impl_->config) != 0;
  if (!is_ready) fail("the library is of another version than its headers");
  options.minimize_size = 1;
  options.anim_params.loop_count = 0;  // endless
  impl_->config.quality = kQuality;
  impl_->config.method = kEffort;
  impl_->encoder.reset(WebPAnimEncoderNew(width, height, &options));
  if (!impl_->encoder) fail("no memory for it, or a size that a WebP cannot have");
}

Animation::~Animation() = default;

void Animation::add(const Canvas& frame, int milliseconds) {
  const Canvas::Bytes bytes = frame.bytes();
  WebPPicture picture;
  if (WebPPictureInit(&picture) == 0) fail("the library is of another version than its headers");
  const std::unique_ptr<WebPPicture, decltype(&WebPPictureFree)> owner(&picture, &WebPPictureFree);
  picture.use_argb = 1;
  picture.width = bytes.width;
  picture.height = bytes.height;
  const bool is_added =
      WebPPictureImportBGRX(&picture, bytes.data, bytes.stride) != 0 &&
      WebPAnimEncoderAdd(impl_->encoder.get(), &picture, impl_->time, &impl_->config) != 0;
  if (!is_added) fail(WebPAnimEncoderGetError(impl_->encoder.get()));
  impl_->time += milliseconds;
}

std::string Animation::finish() {
  WebPData data;
  WebPDataInit(&data);
  const std::unique_ptr<WebPData, decltype(&WebPDataClear)> owner(&data, &WebPDataClear);
  const bool is_done =
      WebPAnimEncoderAdd(impl_->encoder.get(), nullptr, impl_->time, nullptr) != 0 &&
      WebPAnimEncoderAssemble(impl_->encoder.get(), &data) != 0;
  if (!is_done) fail(WebPAnimEncoderGetError(impl_->encoder.get()));
  return {reinterpret_cast<const char*>(data.bytes), data.size};
}

}  // namespace palpate::tools
