#pragma once
/// A file read front to back, packed or plain, with every checksum verified.

#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "palpate/core/error.h"

namespace palpate::vdb {

enum class Packing {
  kNone,
  kGzip,  ///< gzip, with a CRC-32 and the length at the end of each member
  kZlib,  ///< one zlib stream, with an Adler-32 at its end
};

/// libnifti, NrrdIO and zlib's gz* calls all return data even if their checksum is wrong or their
/// end is missing; this reader does not.
class ByteStream {
 public:
  /// Starts at the front of the file, which is unpacked if it begins as gzip data do. `format` is
  /// the prefix of error codes ("nifti").
  /// @throws Error (kInput): missing, a directory, empty, not readable.
  ByteStream(std::string path, std::string format);
  /// Starts at byte `offset`.
  ByteStream(std::string path, std::string format, std::uint64_t offset, Packing packing);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Fills `out` as far as the content goes; returns the number of bytes.
  /// @throws Error (kInput) for damaged packed data. Packed data that break off early just end.
  std::size_t read(std::span<unsigned char> out);

  /// Reads on to the end of packed data, so that their checksum is verified; does nothing for plain
  /// files. Returns how many bytes of content that was. Stops after more than `most` bytes: a
  /// caller that allows no more will refuse the file, and four megabytes may unpack to four
  /// gigabytes.
  /// @throws Error (kInput) if the data break off or the checksum is wrong.
  std::uint64_t verifyEnd(std::uint64_t most);

  [[nodiscard]] bool isPacked() const noexcept { return packing_ != Packing::kNone; }
  /// True once reading has met packed data that end before their proper end.
  [[nodiscard]] bool brokeOff() const noexcept { return broken_off_; }
  [[nodiscard]] std::uint64_t fileSize() const noexcept { return file_size_; }
  /// The most bytes that the content can have (a deflate stream grows by less than 1032 times).
  [[nodiscard]] std::uint64_t contentLimit() const noexcept {
    return isPacked() ? (file_size_ - offset_) * 1032 : file_size_ - offset_;
  }
  /// @throws Error (kInput, "<format>.truncated"): the content ends after `voxels` of `wanted`.
  [[noreturn]] void failShort(std::uint64_t voxels, std::uint64_t wanted) const;
  /// Refuses, before memory is taken, a header that asks for more bytes than can be there.
  /// @throws Error (kInput, "<format>.truncated")
  void requireContent(double bytes) const;
  /// Bytes of packed data up to their end; valid after verifyEnd().
  [[nodiscard]] std::uint64_t packedBytes() const noexcept { return taken_ - zlib_.avail_in; }

 private:
  void open();
  void startUnpacking();
  std::size_t refill();
  void startNextMember();
  [[nodiscard]] Error fail(const char* what, std::string message, std::string hint = {}) const;
  [[noreturn]] void failDamaged() const;

  std::string path_;
  std::string format_;
  std::ifstream file_;
  std::uint64_t file_size_ = 0;
  std::uint64_t offset_ = 0;
  std::uint64_t taken_ = 0;  ///< [bytes] packed data taken
  Packing packing_ = Packing::kNone;
  bool ended_ = false;       ///< the packed data reached their proper end
  bool broken_off_ = false;  ///< the file ended before that end
  z_stream zlib_{};
  std::vector<unsigned char> buffer_;
};

}  // namespace palpate::vdb
