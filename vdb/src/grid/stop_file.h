#pragma once
/// A file that stops being read when the user asks for it, whatever library reads it.

#include <fstream>

#include "palpate/core/stop.h"

namespace palpate::vdb {

/// A stream over it must have its exceptions on: the Error of pollStop() then comes through it.
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
