#pragma once
/// Files that a run writes: all of them or none, never over an existing one unasked.

#include <string>
#include <string_view>
#include <vector>

namespace palpate::tools {

/// Checked before the work, written beside their names after it, renamed together at the end.
/// Whatever is not committed is removed.
class OutputFiles {
 public:
  explicit OutputFiles(bool overwrite) : overwrite_(overwrite) {}
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Announces an output. @throws Error: kOperation if it exists (and --force is not given), its folder
  /// is missing or cannot be written to; kUsage if it is one of `inputs` or was announced before.
  void announce(const std::string& path, const std::vector<std::string>& inputs);

  /// Where to write the announced file `path`: a name beside it.
  [[nodiscard]] const std::string& temporary(const std::string& path) const;
  /// Writes `text` to the temporary of `path`. @throws Error (kOperation).
  void write(const std::string& path, std::string_view text) const;

  /// Gives all announced files their names. @throws Error (kOperation).
  void commit();

 private:
  struct File {
    std::string path;
    std::string temporary;
  };
  bool overwrite_;
  std::vector<File> files_;
};

}  // namespace palpate::tools
