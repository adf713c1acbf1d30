// One fuzzer for each reader: PALPATE_FUZZ_READER names it. An exception other than palpate::Error
// ends the fuzzer, and so does any finding of the sanitizers.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const palpate::fuzz::Reader& reader = palpate::fuzz::readerNamed(PALPATE_FUZZ_READER);
  (void)palpate::fuzz::readBytes(reader, {reinterpret_cast<const char*>(data), size});
  return 0;
}
