#pragma once
// Whether this is a build with sanitizers: some twenty times slower, it is there to see memory and
// races, and what is measured by long runs is seen by the release build.

namespace palpate::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace palpate::test
