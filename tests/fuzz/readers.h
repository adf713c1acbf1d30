#pragma once
// Every reader of strangers' files under one name each, for fuzzing and for damaged files.

#include <span>
#include <string>
#include <string_view>

namespace palpate::fuzz {

struct Reader {
  const char* name;
  const char* extension;
  /// Reads the whole file. @throws whatever the reader throws: palpate::Error for what it refuses.
  void (*read)(const std::string& path);
};

[[nodiscard]] std::span<const Reader> readers();
/// @throws std::out_of_range for a name that is none.
[[nodiscard]] const Reader& readerNamed(std::string_view name);

enum class Outcome { kRead, kRefused };

/// Gives `bytes` to the reader as a file. palpate::Error is an answer; anything else that is thrown
/// comes through, and is a fault.
Outcome readBytes(const Reader& reader, std::string_view bytes);

}  // namespace palpate::fuzz
