#pragma once
// All readers of untrusted files, each under a name, for fuzzing and for damaged files.

#include <span>
#include <string>
#include <string_view>

namespace palpate::fuzz {

struct Reader {
  const char* name;
  const char* extension;
  /// Reads the whole file. @throws whatever the reader throws: palpate::Error for files that it
  /// refuses.
  void (*read)(const std::string& path);
};

[[nodiscard]] std::span<const Reader> readers();
/// @throws std::out_of_range for an unknown name.
[[nodiscard]] const Reader& readerNamed(std::string_view name);

enum class Outcome { kRead, kRefused };

/// Gives `bytes` to the reader as a file. A palpate::Error counts as an answer; any other exception
/// is passed on, and is a fault.
Outcome readBytes(const Reader& reader, std::string_view bytes);

}  // namespace palpate::fuzz
