#pragma once
/// Files with a last line that holds their key and the hash of their content.

#include <string>

namespace palpate::vdb {

/// Appends a line to the file: `key`, and the hash of everything before. False if that failed.
[[nodiscard]] bool seal(const std::string& path, const std::string& key);

/// Whether the file ends with the line that seal() writes for this key and content.
[[nodiscard]] bool isSealed(const std::string& path, const std::string& key);

/// [bytes] Length of that line.
[[nodiscard]] std::size_t sealBytes(const std::string& key);

}  // namespace palpate::vdb
