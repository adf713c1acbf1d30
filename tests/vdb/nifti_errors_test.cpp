// Images that cannot be used: each gives one clear error, and no voxels.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

using test::Bytes;
using test::bytesOf;
using test::gzipped;
using test::NiftiFile;
using test::writeTemporary;

void expectRefused(const std::string& path, const std::string& code, const std::string& says) {
  try {
    (void)readNifti(path);
    ADD_FAILURE() << "read without complaint; expected " << code;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().code, code) << error.what();
    EXPECT_EQ(error.problem().file, path);
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

struct BadCase {
  const char* name;
  const char* code;
  const char* says;
  std::function<void(NiftiFile&)> spoil;
};

class NiftiHeaderErrors : public testing::TestWithParam<BadCase> {};

TEST_P(NiftiHeaderErrors, AreToldByFileInfoAndReaderAlike) {
  NiftiFile file;
  GetParam().spoil(file);
  const std::string path = writeTemporary("bad.nii", bytesOf(file));
  testing::internal::CaptureStderr();
  expectRefused(path, GetParam().code, GetParam().says);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "libnifti must not talk";
  EXPECT_THROW((void)readNiftiInfo(path), Error);
  file.big_endian = true;
  expectRefused(writeTemporary("bad_be.nii", bytesOf(file)), GetParam().code, GetParam().says);
}

INSTANTIATE_TEST_SUITE_P(
    All, NiftiHeaderErrors,
    testing::Values(
        BadCase{"TimeSeries", "nifti.dimensions", "4 x 5 x 6 x 7",
                [](auto& f) {
                  f.dim = {4, 5, 6, 7};
                }},
        BadCase{"Vectors", "nifti.dimensions", "4 x 5 x 6 x 1 x 3",
                [](auto& f) {
                  f.dim = {4, 5, 6, 1, 3};
                  f.intent = 1007;
                }},
        BadCase{"Plane", "nifti.dimensions", "4 x 5;",
                [](auto& f) {
                  f.dim = {4, 5};
                }},
        BadCase{"OneSlice", "nifti.dimensions", "at least two voxels",
                [](auto& f) {
                  f.dim = {4, 5, 1};
                }},
        BadCase{"NegativeSize", "nifti.dimensions", "-5",
                [](auto& f) {
                  f.dim = {4, -5, 6};
                }},
        BadCase{"ZeroSize", "nifti.dimensions", "cannot be",
                [](auto& f) {
                  f.dim = {4, 0, 6};
                }},
        BadCase{"Complex", "nifti.data_type", "COMPLEX", [](auto& f) { f.datatype = 32; }},
        BadCase{"Color", "nifti.data_type", "RGB", [](auto& f) { f.datatype = 128; }},
        BadCase{"NoForm", "nifti.no_affine", "sform", [](auto& f) { f.sform_code = 0; }},
        BadCase{"Conflict", "nifti.affine_conflict", "qform (code 1)",
                [](auto& f) {
                  f.qform_code = 1;
                  f.q_offset = {-3, -4, -4.5};
                }},
        BadCase{"Mirrored", "nifti.affine_conflict", "sform (code 1)",
                [](auto& f) {
                  f.qform_code = 1;
                  f.q_offset = {-3, -4, -5};
                  f.pixdim[0] = -1;
                }},
        BadCase{"FlatSform", "nifti.singular", "sform",
                [](auto& f) {
                  f.sform = {{{1, 0, 1, 0}, {0, 1, 1, 0}, {0, 0, 0, 0}}};
                }},
        BadCase{"NaNSform", "nifti.singular", "sform",
                [](auto& f) { f.sform[1][3] = std::numeric_limits<double>::quiet_NaN(); }},
        BadCase{"ZeroSpacing", "nifti.spacing", "pixdim[2]",
                [](auto& f) {
                  f.sform_code = 0;
                  f.qform_code = 1;
                  f.pixdim[2] = 0;
                }},
        BadCase{"NegativeSpacing", "nifti.spacing", "pixdim[3]",
                [](auto& f) {
                  f.sform_code = 0;
                  f.qform_code = 1;
                  f.pixdim[3] = -2;
                }},
        BadCase{"StrangeUnit", "nifti.unit", "code 5", [](auto& f) { f.units = 5; }},
        BadCase{"Pair", "nifti.pair", ".hdr / .img", [](auto& f) { f.magic = "ni1"; }},
        BadCase{"Analyze", "nifti.analyze", "Analyze",
                [](auto& f) { f.magic = std::string(4, '\0'); }}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(NiftiErrors, FilesThatAreNoImages) {
  const std::string folder = testing::TempDir();
  expectRefused(folder + "/there_is_no_such_image.nii", "nifti.missing", "no such file");
  expectRefused(folder, "nifti.directory", "directory");
  expectRefused(writeTemporary("empty.nii", Bytes{}), "nifti.empty", "empty");
  expectRefused(writeTemporary("one_byte.nii", Bytes{1}), "nifti.format", "not a NIfTI");
  expectRefused(writeTemporary("text.nii", std::string(5000, 'x')), "nifti.format", "not a NIfTI");
  expectRefused(writeTemporary("text.nii.gz", gzipped(Bytes(5000, 'x'))), "nifti.format",
                "not a NIfTI");
  expectRefused(writeTemporary("nothing.nii.gz", gzipped({})), "nifti.format", "not a NIfTI");
  Bytes nii2(540, 0);
  nii2[0] = 0x1c;
  nii2[1] = 0x02;
  expectRefused(writeTemporary("magic2.nii", nii2), "nifti.format", "not a NIfTI");
}

// Truncated after every 37th byte: header, gap, voxels. libnifti would fill up with zeros.
TEST(NiftiErrors, PlainFileCutAnywhere) {
  const Bytes whole = bytesOf({});
  for (std::size_t length = 4; length < whole.size(); length += 37) {
    const std::string path =
        writeTemporary("cut.nii", Bytes(whole.begin(), whole.begin() + static_cast<long>(length)));
    expectRefused(path, "nifti.truncated", length < 348 ? "within its header" : "cut short");
  }
  const std::string path = writeTemporary("cut.nii", Bytes(whole.begin(), whole.end() - 1));
  expectRefused(path, "nifti.truncated", "471 bytes");
  EXPECT_THROW((void)readNiftiInfo(path), Error);
}

TEST(NiftiErrors, GzipFileCutAnywhere) {
  NiftiFile file;
  file.dim = {30, 30, 30};
  for (int i = 0; i < 27000; ++i) file.values.push_back((i * 7919) % 251);
  const Bytes whole = gzipped(bytesOf(file));
  for (std::size_t length = 40; length < whole.size(); length += whole.size() / 23) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<long>(length));
    try {
      (void)readNifti(writeTemporary("cut.nii.gz", cut));
      ADD_FAILURE() << length << " of " << whole.size() << " bytes were read without complaint";
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "nifti.truncated") << error.what();
    }
  }
  // All voxels are there, but the checksum behind them is not.
  for (const long missing : {1L, 4L, 8L}) {
    expectRefused(writeTemporary("tail.nii.gz", Bytes(whole.begin(), whole.end() - missing)),
                  "nifti.truncated", "data are cut short");
  }
}

TEST(NiftiErrors, GzipChecksumAndLength) {
  const Bytes whole = gzipped(bytesOf({}));
  for (std::size_t back = 1; back <= 8; ++back) {  // four bytes of CRC-32, four of the length
    Bytes bad = whole;
    bad[bad.size() - back] ^= 0x40;
    expectRefused(writeTemporary("crc.nii.gz", bad), "nifti.checksum", "checksum");
  }
}

TEST(NiftiErrors, DamagedGzipDataAreNeverRead) {
  NiftiFile file;
  file.dim = {20, 20, 20};
  for (int i = 0; i < 8000; ++i) file.values.push_back((i * 7919) % 251);
  const Bytes whole = gzipped(bytesOf(file));
  for (std::size_t at = 10; at < whole.size(); at += 61) {
    Bytes bad = whole;
    bad[at] ^= 0x10;
    EXPECT_THROW((void)readNifti(writeTemporary("damaged.nii.gz", bad)), Error) << at;
  }
}

TEST(NiftiErrors, AHeaderThatAsksForMoreThanThereCanBeAllocatesNothing) {
  NiftiFile file;
  Bytes bytes = bytesOf(file);
  for (const std::size_t at : {42U, 44U, 46U}) {
    bytes[at] = 0xff;
    bytes[at + 1] = 0x7f;  // 32767 along each axis: 35 TB
  }
  expectRefused(writeTemporary("huge.nii", bytes), "nifti.truncated", "asks for 35181150962015");
  expectRefused(writeTemporary("huge.nii.gz", gzipped(bytes)), "nifti.truncated", "unpacked");
}

}  // namespace
}  // namespace palpate::vdb
