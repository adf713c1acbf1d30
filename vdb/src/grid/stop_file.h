#pragma once
/// A file buffer that stops reading when the user asks to stop, whatever library reads from it.

#include <fstream>

#include "palpate/core/stop.h"

namespace palpate::vdb {

/// A stream over it must have its exceptions enabled, so that the Error of pollStop() comes
/// through.
class StopBuffer final : public std::filebuf {
 protected:
  int_type underflow() override {
    pollStop();
    return std::filebuf::underflow();
  }
  std::streamsize xsgetn(char* out, std::streamsize count) override {
    pollStop();
    return std::filebuf::xsgetn(out, count);
  }
};

}  // namespace palpate::vdb
