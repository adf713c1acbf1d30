#pragma once
/// The files that a run writes: all of them or none, and never over an existing file without
/// --force.

#include <string>
#include <string_view>
#include <vector>

#include "options.h"

namespace palpate::tools {

/// Names are checked before the work, files are written under temporary names after it, and all are
/// renamed together at the end. Files that are not committed are removed. A file that is replaced
/// keeps its mode (and owner, if this process may set it), and a symbolic link stays and points to
/// the new file. Devices and pipes are never replaced: they are written directly, after the files,
/// and "-" is standard output. Temporary files have unpredictable names, and are opened
/// exclusively.
class OutputFiles {
 public:
  /// Whether an output may be "-". Only a file that is written from front to back can be streamed.
  enum class Streams { kNo, kYes };

  explicit OutputFiles(const GeneralOptions& general)
      : overwrite_(general.force), json_(general.json) {}
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Announces an output. @throws Error: kOperation if it exists (and --force is not given), its
  /// folder is missing or cannot be written to, or it is neither file, pipe nor character device;
  /// kUsage if it is one of `inputs` or was announced before, or is "-" where that is not possible
  /// (with --json, for example).
  void announce(const std::string& path, const std::vector<std::string>& inputs,
                Streams streams = Streams::kNo);

  /// The file to write for the announced `path`: a temporary one, beside it or in the folder for
  /// temporary files.
  [[nodiscard]] const std::string& temporary(const std::string& path) const;
  /// Writes `text` to the temporary of `path`. @throws Error (kOperation).
  void write(const std::string& path, std::string_view text) const;

  /// Gives the announced file `path` its name now, before it is complete: for a record, whose ticks
  /// so far should be kept under its name however the run ends. @throws Error: kOperation as
  /// commit(); kUsage if it is a pipe or a device.
  void place(const std::string& path);

  /// The same for a file that a failed run has to keep; does nothing for a pipe or a device, or if
  /// `path` is empty.
  void keep(const std::string& path);

  /// Gives all announced files their names. @throws Error (kOperation).
  void commit();

 private:
  struct File {
    std::string path;
    std::string temporary;
    std::string target;      ///< the file to replace: `path`, or the target of a link there
    bool is_direct = false;  ///< a pipe, a device or standard output: copied to, not renamed
  };
  bool overwrite_;
  bool json_;  ///< standard output carries one JSON object and nothing else
  std::vector<File> files_;
};

/// True once a run writes a file to standard output: its summary then goes to stderr.
[[nodiscard]] bool standardOutputIsTaken() noexcept;

/// For "-" a name that opens standard input; any other name unchanged.
[[nodiscard]] std::string inputName(const std::string& path);

}  // namespace palpate::tools
