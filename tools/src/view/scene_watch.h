#pragma once
/// SceneWatch: notices changes of a scene's file, and of the files that it names.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpate::tools {

/// Identifies a file and its state.
struct FileStamp {
  std::uint64_t device = 0;
  std::uint64_t number = 0;
  std::int64_t size = -1;     ///< -1: there is no file
  std::int64_t written = 0;   ///< [ns]
  std::int64_t replaced = 0;  ///< [ns] status change: also when renamed, or its time was set back
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

struct SceneSight {
  std::optional<std::string> text;  ///< of the scene's file; none: there is no file
  std::vector<FileStamp> named;     ///< of the files that it names
  friend bool operator==(const SceneSight&, const SceneSight&) = default;
};

/// Never waits; its owner calls look() a few times a second. A change counts when two looks in a
/// row see the same, so that a file is not read half-written. A missing file counts after kGone
/// looks, because an editor that saves by renaming may remove it for a moment.
class SceneWatch {
 public:
  static constexpr int kGone = 5;

  /// Takes the first look.
  explicit SceneWatch(std::string file);

  /// The result of the first look.
  [[nodiscard]] const SceneSight& first() const noexcept { return first_; }
  /// The present state, if it counts and differs from the one reported last.
  [[nodiscard]] std::optional<SceneSight> look();

 private:
  [[nodiscard]] std::vector<FileStamp> stamps() const;
  void follow(const std::string& text);

  std::string file_;
  std::vector<std::filesystem::path> named_;
  SceneSight first_;
  SceneSight told_;
  SceneSight last_;
  int gone_ = 0;  ///< looks in a row that found no file
};

}  // namespace palpate::tools
