#pragma once
/// Text of strangers as UTF-8.

#include <string>
#include <string_view>

namespace palpate::vdb {

/// The text itself if it is UTF-8; else each of its bytes taken for a Latin-1 character: names that
/// were written by old or Windows programs.
[[nodiscard]] std::string asUtf8(std::string_view text);

}  // namespace palpate::vdb
