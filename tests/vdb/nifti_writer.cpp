#include "vdb/nifti_writer.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "support/temp_file.h"

namespace palpate::vdb::test {
namespace {

class Writer {
 public:
  Writer(std::size_t size, bool big_endian) : bytes_(size), big_endian_(big_endian) {}

  template <typename T>
  void put(std::size_t at, T value) {
    unsigned char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian_ == (std::endian::native == std::endian::little))
      std::reverse(raw, raw + sizeof(T));
    if (bytes_.size() < at + sizeof(T)) bytes_.resize(at + sizeof(T));
    std::copy(raw, raw + sizeof(T), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  void text(std::size_t at, const std::string& value) {
    std::copy(value.begin(), value.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
  bool big_endian_;
};

int bytesPer(int datatype) {
  switch (datatype) {
    case 2:
    case 256:
      return 1;
    case 4:
    case 512:
      return 2;
    case 8:
    case 16:
    case 768:
      return 4;
    case 64:
    case 1024:
    case 1280:
    case 32:
      return 8;
    case 128:
      return 3;
    default:
      throw std::invalid_argument("datatype");
  }
}

void putValue(Writer& out, std::size_t at, int datatype, double value) {
  switch (datatype) {
    case 2:
      return out.put(at, static_cast<std::uint8_t>(value));
    case 256:
      return out.put(at, static_cast<std::int8_t>(value));
    case 4:
      return out.put(at, static_cast<std::int16_t>(value));
    case 512:
      return out.put(at, static_cast<std::uint16_t>(value));
    case 8:
      return out.put(at, static_cast<std::int32_t>(value));
    case 768:
      return out.put(at, static_cast<std::uint32_t>(value));
    case 1024:
      return out.put(at, static_cast<std::int64_t>(value));
    case 1280:
      return out.put(at, static_cast<std::uint64_t>(value));
    case 16:
      return out.put(at, static_cast<float>(value));
    case 64:
      return out.put(at, value);
    default:
      return;  // complex and color: zeros suffice
  }
}

// Byte offsets of the fields in the two header layouts (nifti1.h and nifti2.h of the standard).
void putHeader1(Writer& out, const NiftiFile& f, double offset) {
  out.put<std::int32_t>(0, 348);
  out.put<std::int16_t>(40, static_cast<std::int16_t>(f.dim.size()));
  for (std::size_t i = 0; i < 7; ++i) {
    out.put<std::int16_t>(42 + 2 * i,
                          i < f.dim.size() ? static_cast<std::int16_t>(f.dim[i]) : std::int16_t{1});
  }
  out.put<std::int16_t>(68, static_cast<std::int16_t>(f.intent));
  out.put<std::int16_t>(70, static_cast<std::int16_t>(f.datatype));
  out.put<std::int16_t>(72, static_cast<std::int16_t>(8 * bytesPer(f.datatype)));
  for (std::size_t i = 0; i < 4; ++i) out.put(76 + 4 * i, static_cast<float>(f.pixdim[i]));
  out.put(108, static_cast<float>(offset));
  out.put(112, static_cast<float>(f.slope));
  out.put(116, static_cast<float>(f.intercept));
  out.put<std::uint8_t>(123, static_cast<std::uint8_t>(f.units));
  out.put<std::int16_t>(252, static_cast<std::int16_t>(f.qform_code));
  out.put<std::int16_t>(254, static_cast<std::int16_t>(f.sform_code));
  for (std::size_t i = 0; i < 3; ++i) {
    out.put(256 + 4 * i, static_cast<float>(f.quaternion[i]));
    out.put(268 + 4 * i, static_cast<float>(f.q_offset[i]));
    for (std::size_t j = 0; j < 4; ++j) {
      out.put(280 + 16 * i + 4 * j, static_cast<float>(f.sform[i][j]));
    }
  }
  out.text(344, f.magic.empty() ? std::string("n+1") : f.magic);
}

void putHeader2(Writer& out, const NiftiFile& f, double offset) {
  out.put<std::int32_t>(0, 540);
  out.text(4, f.magic.empty() ? std::string("n+2\0\r\n\x1a\n", 8) : f.magic);
  out.put<std::int16_t>(12, static_cast<std::int16_t>(f.datatype));
  out.put<std::int16_t>(14, static_cast<std::int16_t>(8 * bytesPer(f.datatype)));
  out.put<std::int64_t>(16, static_cast<std::int64_t>(f.dim.size()));
  for (std::size_t i = 0; i < 7; ++i) {
    out.put<std::int64_t>(24 + 8 * i, i < f.dim.size() ? f.dim[i] : 1);
  }
  for (std::size_t i = 0; i < 4; ++i) out.put(104 + 8 * i, f.pixdim[i]);
  out.put(168, static_cast<std::int64_t>(offset));
  out.put(176, f.slope);
  out.put(184, f.intercept);
  out.put<std::int32_t>(344, f.qform_code);
  out.put<std::int32_t>(348, f.sform_code);
  for (std::size_t i = 0; i < 3; ++i) {
    out.put(352 + 8 * i, f.quaternion[i]);
    out.put(376 + 8 * i, f.q_offset[i]);
    for (std::size_t j = 0; j < 4; ++j) out.put(400 + 32 * i + 8 * j, f.sform[i][j]);
  }
  out.put<std::int32_t>(500, f.units);
  out.put<std::int32_t>(504, f.intent);
}

}  // namespace

Bytes bytesOf(const NiftiFile& f) {
  // An extension consists of its size, its code and its text, padded to a multiple of 16 bytes.
  const std::size_t extended = f.extension.empty() ? 0 : (8 + f.extension.size() + 15) / 16 * 16;
  const std::size_t plain = f.version == 1 ? 352 : 544;
  const std::size_t header = plain + extended;
  const double offset = f.data_offset > 0.0 ? f.data_offset : static_cast<double>(header);
  std::size_t count = 1;
  for (const std::int64_t n : f.dim)
    count *= static_cast<std::size_t>(std::max<std::int64_t>(n, 0));
  const auto begin = static_cast<std::size_t>(offset);
  const auto bytes = static_cast<std::size_t>(bytesPer(f.datatype));
  Writer out(std::max(header, begin + count * bytes), f.big_endian);
  if (f.version == 1) {
    putHeader1(out, f, offset);
  } else {
    putHeader2(out, f, offset);
  }
  if (extended > 0) {
    out.put<std::uint8_t>(plain - 4, 1);
    out.put<std::int32_t>(plain, static_cast<std::int32_t>(extended));
    out.put<std::int32_t>(plain + 4, f.extension_code);
    out.text(plain + 8, f.extension);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double value = f.values.empty() ? static_cast<double>(i % 100) : f.values.at(i);
    putValue(out, begin + i * bytes, f.datatype, value);
  }
  return out.take();
}

Bytes gzipped(const Bytes& content) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("deflateInit2");
  }
  Bytes out(deflateBound(&stream, static_cast<uLong>(content.size())));
  stream.next_in = const_cast<unsigned char*>(content.data());  // zlib does not write to it
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw std::runtime_error("deflate");
  return out;
}

std::string writeTemporary(const std::string& name, const Bytes& content) {
  return writeTemporary(name, std::string(content.begin(), content.end()));
}

std::string writeTemporary(const std::string& name, const std::string& content) {
  static const palpate::testing::TempFolder folder;
  return folder.file(name, content);
}

}  // namespace palpate::vdb::test
