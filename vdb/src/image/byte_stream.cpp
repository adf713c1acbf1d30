#include "image/byte_stream.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>

#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18U;
constexpr int kGzipOnly = 15 + 16;  // zlib: largest window, gzip wrapper with its checksum

}  // namespace

ByteStream::ByteStream(std::string path) : path_(std::move(path)) {
  namespace fs = std::filesystem;
  std::error_code failure;
  const fs::file_status status = fs::status(path_, failure);
  if (!fs::exists(status)) throw inputError("nifti.missing", "no such file", {}, path_);
  if (fs::is_directory(status)) {
    throw inputError("nifti.directory", "this is a directory, not an image",
                     "name the .nii or .nii.gz file in it", path_);
  }
  file_.open(path_, std::ios::binary);
  if (!file_)
    throw inputError("nifti.unreadable", "the file cannot be opened for reading", {}, path_);
  file_.seekg(0, std::ios::end);
  file_size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
  file_.seekg(0);
  if (file_size_ == 0) throw inputError("nifti.empty", "the file is empty", {}, path_);

  unsigned char magic[2] = {0, 0};
  file_.read(reinterpret_cast<char*>(magic), 2);
  file_.clear();
  file_.seekg(0);
  gzip_ = magic[0] == 0x1f && magic[1] == 0x8b;
  if (gzip_) {
    buffer_.resize(kBufferSize);
    if (inflateInit2(&zlib_, kGzipOnly) != Z_OK) {
      throw Error(ErrorKind::kOperation,
                  {"nifti.memory", "zlib could not be started", "free some memory", path_});
    }
  }
}

ByteStream::~ByteStream() {
  if (gzip_) inflateEnd(&zlib_);
}

std::size_t ByteStream::refill() {
  file_.read(reinterpret_cast<char*>(buffer_.data()), static_cast<std::streamsize>(buffer_.size()));
  const auto got = static_cast<std::size_t>(file_.gcount());
  zlib_.next_in = buffer_.data();
  zlib_.avail_in = static_cast<uInt>(got);
  return got;
}

void ByteStream::failDamaged() const {
  const std::string_view reason = zlib_.msg != nullptr ? zlib_.msg : "";
  if (reason == "incorrect data check" || reason == "incorrect length check") {
    throw inputError("nifti.checksum", "the gzip checksum does not match: the data are damaged",
                     "fetch or write the file again", path_);
  }
  throw inputError("nifti.damaged", "the gzip data are damaged (" + std::string(reason) + ")",
                   "fetch or write the file again", path_);
}

// A gzip file may be several members one after the other; zeros after the last are padding.
void ByteStream::startNextMember() {
  for (;;) {
    if (zlib_.avail_in == 0 && refill() == 0) {
      ended_ = true;
      return;
    }
    if (*zlib_.next_in != 0) break;
    ++zlib_.next_in;
    --zlib_.avail_in;
  }
  if (*zlib_.next_in != 0x1f) {  // what follows is no gzip member; gzip -t ignores it too
    ended_ = true;
    return;
  }
  inflateReset(&zlib_);
}

std::size_t ByteStream::read(std::span<unsigned char> out) {
  if (!gzip_) {
    file_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
    return static_cast<std::size_t>(file_.gcount());
  }
  std::size_t done = 0;
  while (done < out.size() && !ended_ && !broken_off_) {
    if (zlib_.avail_in == 0 && refill() == 0) {
      broken_off_ = true;
      break;
    }
    const auto room = std::min<std::size_t>(out.size() - done, std::numeric_limits<uInt>::max());
    zlib_.next_out = out.data() + done;
    zlib_.avail_out = static_cast<uInt>(room);
    const int result = inflate(&zlib_, Z_NO_FLUSH);
    done += room - zlib_.avail_out;
    if (result == Z_STREAM_END) {
      startNextMember();
    } else if (result != Z_OK && result != Z_BUF_ERROR) {
      failDamaged();
    }
  }
  return done;
}

void ByteStream::verifyEnd() {
  if (!gzip_) return;
  std::vector<unsigned char> rest(kBufferSize);
  while (read(rest) > 0) {
  }
  if (broken_off_) {
    throw inputError("nifti.truncated", "the gzip data break off before their end",
                     "fetch or write the file again", path_);
  }
}

}  // namespace palpate::vdb
