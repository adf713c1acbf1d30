#pragma once
/// The state of source files at the time when a result was begun.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::vdb {

class ContentKey;

class SourceState {
 public:
  SourceState() = default;
  /// The present state of files and folders, without reading their bytes.
  explicit SourceState(const std::vector<std::string>& files);
  /// Adds to `key` the bytes of the files, and, if there are several, their names within their
  /// folders, which may have a meaning. isKnown() is false if one cannot be read. A file that is
  /// added to one of `folders`, or removed, counts as a change.
  SourceState(const std::vector<std::string>& files, ContentKey& key,
              const std::vector<std::string>& folders = {});

  [[nodiscard]] bool isKnown() const noexcept { return is_known_; }
  /// Whether both describe the same files in the same state.
  [[nodiscard]] bool isOfTheSame(const SourceState& other) const { return files_ == other.files_; }
  /// Whether no file was written to or replaced since: then a result made from them belongs to the
  /// bytes that were read.
  [[nodiscard]] bool isUnchanged() const;

 private:
  struct File {
    std::string path;
    std::uint64_t device = 0;
    std::uint64_t node = 0;
    std::int64_t bytes = 0;
    /// [s, ns] of the last write, and of the last change of metadata
    std::array<std::int64_t, 4> times{};
    bool operator==(const File&) const = default;
  };
  [[nodiscard]] static File look(const std::string& path);

  std::vector<File> files_;
  bool is_known_ = false;
};

}  // namespace palpate::vdb
