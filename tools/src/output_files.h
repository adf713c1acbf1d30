#pragma once
/// Files that a run writes: all of them or none, never over an existing one unasked.

#include <string>
#include <string_view>
#include <vector>

#include "options.h"

namespace palpate::tools {

/// Checked before the work, written beside their names after it, renamed together at the end.
/// Whatever is not committed is removed. A file that is replaced keeps its mode (and owner, if this
/// process may give it), and a symbolic link stays and leads to what is new. What is not a regular
/// file is never replaced: devices and pipes are written directly, after the files, and "-" is
/// standard output. The files written meanwhile have names that nobody can foresee, and are opened
/// exclusively.
class OutputFiles {
 public:
  /// Whether an output may be "-". Only what is written from front to back can be streamed.
  enum class Streams { kNo, kYes };

  explicit OutputFiles(const GeneralOptions& general)
      : overwrite_(general.force), json_(general.json) {}
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Announces an output. @throws Error: kOperation if it exists (and --force is not given), its
  /// folder is missing or cannot be written to, or it is neither file, pipe nor character device;
  /// kUsage if it is one of `inputs` or was announced before, or is "-" and cannot be (with --json,
  /// for one).
  void announce(const std::string& path, const std::vector<std::string>& inputs,
                Streams streams = Streams::kNo);

  /// Where to write the announced file `path`: a file of ours, beside it or in the folder for
  /// temporary files.
  [[nodiscard]] const std::string& temporary(const std::string& path) const;
  /// Writes `text` to the temporary of `path`. @throws Error (kOperation).
  void write(const std::string& path, std::string_view text) const;

  /// Gives the announced file `path` its name now, before it is written whole: for a record, of
  /// which what is there should have its name whatever ends the run. @throws Error: kOperation as
  /// commit(); kUsage if it is a pipe or a device.
  void place(const std::string& path);

  /// The same for what a run that failed has to keep; nothing for a pipe or a device, or if `path`
  /// is empty.
  void keep(const std::string& path);

  /// Gives all announced files their names. @throws Error (kOperation).
  void commit();

 private:
  struct File {
    std::string path;
    std::string temporary;
    std::string target;      ///< what is replaced: `path`, or where a link there leads
    bool is_direct = false;  ///< a pipe, a device or standard output: copied to, not renamed
  };
  bool overwrite_;
  bool json_;  ///< standard output is for one object and nothing else
  std::vector<File> files_;
};

/// True once a run has been asked to write a file to standard output: its summary then goes to
/// stderr.
[[nodiscard]] bool standardOutputIsTaken() noexcept;

/// "-" as a name that opens standard input; any other name as it is.
[[nodiscard]] std::string inputName(const std::string& path);

}  // namespace palpate::tools
