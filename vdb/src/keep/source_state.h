#pragma once
/// Files that something is made of, as they were when it was begun.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::vdb {

class ContentKey;

class SourceState {
 public:
  SourceState() = default;
  /// Of files and folders as they are, whose bytes nobody asks for.
  explicit SourceState(const std::vector<std::string>& files);
  /// Adds to `key` the bytes of the files, and their names within their folders where there are
  /// several: they may mean something. isKnown() is false if one cannot be read. A file that comes
  /// into one of `folders`, or leaves it, is a change.
  SourceState(const std::vector<std::string>& files, ContentKey& key,
              const std::vector<std::string>& folders = {});

  [[nodiscard]] bool isKnown() const noexcept { return is_known_; }
  /// Whether both are of the same files as they were then.
  [[nodiscard]] bool isOfTheSame(const SourceState& other) const { return files_ == other.files_; }
  /// Whether no file was written to or replaced since: what was made of them is of the bytes that
  /// were looked at.
  [[nodiscard]] bool isUnchanged() const;

 private:
  struct File {
    std::string path;
    std::uint64_t device = 0;
    std::uint64_t node = 0;
    std::int64_t bytes = 0;
    std::array<std::int64_t, 4> times{};  ///< [s, ns] of its content, and of its node
    bool operator==(const File&) const = default;
  };
  [[nodiscard]] static File look(const std::string& path);

  std::vector<File> files_;
  bool is_known_ = false;
};

}  // namespace palpate::vdb
