#pragma once
/// Runs tests/vdb/nifti_oracle.py with Debian's Python.

#include <string>
#include <vector>

namespace palpate::vdb::test {

/// The numbers that `nifti_oracle.py command arguments...` prints, a row for each line.
/// @throws std::runtime_error if it fails; python3-nibabel and python3-scipy are test dependencies.
[[nodiscard]] std::vector<std::vector<double>> askPython(const std::string& command,
                                                         const std::vector<std::string>& arguments);

}  // namespace palpate::vdb::test
