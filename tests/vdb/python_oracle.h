#pragma once
/// Runs the tests' Python programs with Debian's Python.

#include <string>
#include <vector>

namespace palpate::vdb::test {

/// The numbers that `script command arguments...` prints, one row for each line; `script` is
/// relative to tests.
/// @throws std::runtime_error if it fails; python3-nibabel and python3-scipy are needed for the
/// tests.
[[nodiscard]] std::vector<std::vector<double>> askScript(const std::string& script,
                                                         const std::string& command,
                                                         const std::vector<std::string>& arguments);
/// The same with vdb/nifti_oracle.py.
[[nodiscard]] std::vector<std::vector<double>> askPython(const std::string& command,
                                                         const std::vector<std::string>& arguments);

}  // namespace palpate::vdb::test
