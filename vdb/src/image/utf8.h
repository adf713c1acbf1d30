#pragma once
/// Text from files of unknown encoding, as UTF-8.

#include <string>
#include <string_view>

namespace palpate::vdb {

/// The text itself if it is UTF-8; otherwise each byte is read as a Latin-1 character: old programs
/// and Windows programs write such names.
[[nodiscard]] std::string asUtf8(std::string_view text);

}  // namespace palpate::vdb
