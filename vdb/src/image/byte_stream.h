#pragma once
/// A file read front to back, gzip or plain, with every gzip checksum verified.

#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace palpate::vdb {

/// libnifti and zlib's gz* calls both hand out data whose checksum is wrong or whose end is
/// missing; this reader does neither. Errors carry codes "nifti.*", since NIfTI files are what it
/// is for.
class ByteStream {
 public:
  /// @throws Error (kInput): missing, a directory, empty, not readable.
  explicit ByteStream(std::string path);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Fills `out` as far as the content goes; returns how many bytes that was.
  /// @throws Error (kInput) for damaged gzip data. A gzip stream that breaks off just ends.
  std::size_t read(std::span<unsigned char> out);

  /// Reads on to the end of gzip data, so that its checksum is verified; nothing to do for plain
  /// files.
  /// @throws Error (kInput) if the data break off or the checksum is wrong.
  void verifyEnd();

  [[nodiscard]] bool isGzip() const noexcept { return gzip_; }
  /// True once reading came to where gzip data end before their proper end.
  [[nodiscard]] bool brokeOff() const noexcept { return broken_off_; }
  [[nodiscard]] std::uint64_t fileSize() const noexcept { return file_size_; }
  /// The most bytes that the content can have (a deflate stream grows by less than 1032 times).
  [[nodiscard]] std::uint64_t contentLimit() const noexcept {
    return gzip_ ? file_size_ * 1032 : file_size_;
  }

 private:
  std::size_t refill();
  void startNextMember();
  [[noreturn]] void failDamaged() const;

  std::string path_;
  std::ifstream file_;
  std::uint64_t file_size_ = 0;
  bool gzip_ = false;
  bool ended_ = false;       ///< the last gzip member came to its proper end
  bool broken_off_ = false;  ///< the file ended within a gzip member
  z_stream zlib_{};
  std::vector<unsigned char> buffer_;
};

}  // namespace palpate::vdb
