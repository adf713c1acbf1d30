#pragma once
/// Which way the axes of coordinates in a file run.

namespace palpate::vdb {

/// The library's own is RAS: to the right, the front, up.
enum class Space {
  kStated,  ///< as the file says; if it does not, what its format has by convention
  kRas,
  kLps,  ///< to the left, the back, up: x and y negated
};

}  // namespace palpate::vdb
