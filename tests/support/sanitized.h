#pragma once
// Whether this is a build with sanitizers. Such a build is some twenty times slower and serves to
// find faults of memory and races; long measurements are left to the release build.

namespace palpate::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace palpate::test
