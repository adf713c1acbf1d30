#include "image/byte_stream.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>

#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 16U;
constexpr int kLargestWindow = 15;
constexpr int kGzipOnly = kLargestWindow + 16;  // zlib: gzip's wrapper with its checksum
constexpr const char* kFetchAgain = "fetch or write the file again";

}  // namespace

Error ByteStream::fail(const char* what, std::string message, std::string hint) const {
  return inputError(format_ + "." + what, std::move(message), std::move(hint), path_);
}

void ByteStream::open() {
  namespace fs = std::filesystem;
  std::error_code failure;
  const fs::file_status status = fs::status(path_, failure);
  if (!fs::exists(status)) throw fail("missing", "no such file");
  if (fs::is_directory(status)) {
    throw fail("directory", "this is a directory, not an image", "name the image file in it");
  }
  if (!fs::is_regular_file(status)) {  // a pipe would keep its reader waiting for ever
    throw fail("unreadable", "this is not a file", "write the data to a file first");
  }
  file_.open(path_, std::ios::binary);
  if (!file_) throw fail("unreadable", "the file cannot be opened for reading");
  file_.seekg(0, std::ios::end);
  file_size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
  file_.seekg(0);
  if (file_size_ == 0) throw fail("empty", "the file is empty");
}

void ByteStream::startUnpacking() {
  if (packing_ == Packing::kNone) return;
  buffer_.resize(kBufferSize);
  if (inflateInit2(&zlib_, packing_ == Packing::kGzip ? kGzipOnly : kLargestWindow) != Z_OK) {
    throw Error(ErrorKind::kOperation,
                {format_ + ".memory", "zlib could not be started", "free some memory", path_});
  }
}

ByteStream::ByteStream(std::string path, std::string format)
    : path_(std::move(path)), format_(std::move(format)) {
  open();
  unsigned char magic[2] = {0, 0};
  file_.read(reinterpret_cast<char*>(magic), 2);
  file_.clear();
  file_.seekg(0);
  if (magic[0] == 0x1f && magic[1] == 0x8b) packing_ = Packing::kGzip;
  startUnpacking();
}

ByteStream::ByteStream(std::string path, std::string format, std::uint64_t offset, Packing packing)
    : path_(std::move(path)), format_(std::move(format)), packing_(packing) {
  open();
  offset_ = std::min(offset, file_size_);
  file_.seekg(static_cast<std::streamoff>(offset_));
  startUnpacking();
}

ByteStream::~ByteStream() {
  if (isPacked()) inflateEnd(&zlib_);
}

std::size_t ByteStream::refill() {
  pollStop();
  file_.read(reinterpret_cast<char*>(buffer_.data()), static_cast<std::streamsize>(buffer_.size()));
  const auto got = static_cast<std::size_t>(file_.gcount());
  zlib_.next_in = buffer_.data();
  zlib_.avail_in = static_cast<uInt>(got);
  taken_ += got;
  return got;
}

void ByteStream::failDamaged() const {
  const std::string_view reason = zlib_.msg != nullptr ? zlib_.msg : "";
  const std::string kind = packing_ == Packing::kGzip ? "gzip" : "zlib";
  if (reason == "incorrect data check" || reason == "incorrect length check") {
    throw fail("checksum", "the " + kind + " checksum does not match: the data are damaged",
               kFetchAgain);
  }
  throw fail("damaged", "the " + kind + " data are damaged (" + std::string(reason) + ")",
             kFetchAgain);
}

// A gzip file may be several members one after the other; zeros after the last are padding.
void ByteStream::startNextMember() {
  if (packing_ == Packing::kZlib) {
    ended_ = true;
    return;
  }
  for (;;) {
    if (zlib_.avail_in == 0 && refill() == 0) {
      ended_ = true;
      return;
    }
    if (*zlib_.next_in != 0) break;
    ++zlib_.next_in;
    --zlib_.avail_in;
  }
  if (*zlib_.next_in != 0x1f) {  // the rest is not a gzip member; gzip -t ignores it too
    ended_ = true;
    return;
  }
  inflateReset(&zlib_);
}

std::size_t ByteStream::read(std::span<unsigned char> out) {
  if (!isPacked()) {
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

std::uint64_t ByteStream::verifyEnd(std::uint64_t most) {
  if (!isPacked()) return 0;
  std::vector<unsigned char> rest(kBufferSize);
  std::uint64_t passed = 0;
  for (std::size_t got = 0; (got = read(rest)) > 0;) {
    pollStop();  // highly compressed data yield much output without a refill
    passed += got;
    if (passed > most) return passed;
  }
  if (broken_off_) {
    throw fail("truncated",
               std::string("the ") + (packing_ == Packing::kGzip ? "gzip" : "zlib") +
                   " data are cut short",
               kFetchAgain);
  }
  return passed;
}

void ByteStream::failShort(std::uint64_t voxels, std::uint64_t wanted) const {
  throw fail("truncated",
             "the file is cut short: it holds " + std::to_string(voxels) + " of " +
                 std::to_string(wanted) + " voxels",
             kFetchAgain);
}

void ByteStream::requireContent(double bytes) const {
  if (bytes <= static_cast<double>(contentLimit())) return;
  char needs[32];
  std::snprintf(needs, sizeof needs, "%.0f", bytes);
  throw fail(
      "truncated",
      "the file is cut short: it has " + std::to_string(file_size_ - offset_) +
          (isPacked() ? packing_ == Packing::kGzip ? " bytes of gzip data" : " bytes of zlib data"
                      : " bytes") +
          (offset_ > 0 ? " of voxels" : "") + ", its header asks for " + needs +
          (isPacked() ? " unpacked" : ""),
      kFetchAgain);
}

}  // namespace palpate::vdb
