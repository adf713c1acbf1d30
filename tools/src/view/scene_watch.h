#pragma once
/// SceneWatch: notices when a scene's file, or a file that it names, is another than before.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpate::tools {

/// Which file it is, and which state of it.
struct FileStamp {
  std::uint64_t device = 0;
  std::uint64_t number = 0;
  std::int64_t size = -1;     ///< -1: there is none
  std::int64_t written = 0;   ///< [ns]
  std::int64_t replaced = 0;  ///< [ns] or renamed, or written with its time set back
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

struct SceneSight {
  std::optional<std::string> text;  ///< of the scene's file; none: it is not there
  std::vector<FileStamp> named;     ///< of the files that it names
  friend bool operator==(const SceneSight&, const SceneSight&) = default;
};

/// Looks only, and waits for nobody: whoever has it looks a few times a second. What two looks in a
/// row see counts, so that a file that is being written is left in peace; one that is gone counts
/// after kGone looks, as an editor that saves by renaming may take it away for a moment.
class SceneWatch {
 public:
  static constexpr int kGone = 5;

  /// Looks at once.
  explicit SceneWatch(std::string file);

  /// What there was at first.
  [[nodiscard]] const SceneSight& first() const noexcept { return first_; }
  /// What there is now, if it is not what the last report said.
  [[nodiscard]] std::optional<SceneSight> look();

 private:
  [[nodiscard]] std::vector<FileStamp> stamps() const;
  void follow(const std::string& text);

  std::string file_;
  std::vector<std::filesystem::path> named_;
  SceneSight first_;
  SceneSight told_;
  SceneSight last_;
  int gone_ = 0;  ///< looks in a row
};

}  // namespace palpate::tools
