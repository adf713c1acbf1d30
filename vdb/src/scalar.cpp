#include "scalar.h"

namespace palpate::vdb {

const char* nameOf(Scalar kind) noexcept {
  switch (kind) {
    case Scalar::kUint8:
      return "uint8";
    case Scalar::kInt8:
      return "int8";
    case Scalar::kUint16:
      return "uint16";
    case Scalar::kInt16:
      return "int16";
    case Scalar::kUint32:
      return "uint32";
    case Scalar::kInt32:
      return "int32";
    case Scalar::kUint64:
      return "uint64";
    case Scalar::kInt64:
      return "int64";
    case Scalar::kFloat32:
      return "float32";
    case Scalar::kFloat64:
      return "float64";
  }
  return "";
}

}  // namespace palpate::vdb
