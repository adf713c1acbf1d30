#pragma once
/// Files whose end says what they are, and of what content.

#include <string>

namespace palpate::vdb {

/// Adds a line to the file's end: `key`, and the hash of all before. False if that failed.
[[nodiscard]] bool seal(const std::string& path, const std::string& key);

/// Whether the file ends with the line that seal() gives it for that key and content.
[[nodiscard]] bool isSealed(const std::string& path, const std::string& key);

/// [bytes] of that line.
[[nodiscard]] std::size_t sealBytes(const std::string& key);

}  // namespace palpate::vdb
