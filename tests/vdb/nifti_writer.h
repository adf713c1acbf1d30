#pragma once
/// NIfTI files of any kind, good and bad, for tests. Written according to the published header
/// layout, so that the reader is not tested with the library that it uses.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::vdb::test {

struct NiftiFile {
  int version = 1;
  bool big_endian = false;
  std::vector<std::int64_t> dim = {4, 5, 6};
  int datatype = 2;                 ///< DT_UINT8
  std::vector<double> values = {};  ///< empty: 0, 1, 2, ... modulo 100
  double slope = 0.0;
  double intercept = 0.0;
  int qform_code = 0;
  int sform_code = 1;
  std::array<std::array<double, 4>, 3> sform = {{{2, 0, 0, -3}, {0, 2, 0, -4}, {0, 0, 2, -5}}};
  std::array<double, 3> quaternion = {0, 0, 0};  ///< b, c, d
  std::array<double, 3> q_offset = {0, 0, 0};
  std::array<double, 4> pixdim = {1, 2, 2, 2};  ///< qfac, then the spacings
  int units = 2;                                ///< mm
  int intent = 0;
  double data_offset = 0;      ///< 0: directly behind the header and the extension
  std::string extension = {};  ///< its text, if there is one
  int extension_code = 0;
  std::string magic = {};  ///< empty: single file
};

using Bytes = std::vector<unsigned char>;

[[nodiscard]] Bytes bytesOf(const NiftiFile& file);
[[nodiscard]] Bytes gzipped(const Bytes& content);

/// Writes `content` to `name` in a folder that is removed when the tests end; returns its path. A
/// later call with the same name replaces the file.
std::string writeTemporary(const std::string& name, const Bytes& content);
std::string writeTemporary(const std::string& name, const std::string& content);

}  // namespace palpate::vdb::test
