#include "image/voxels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

template <typename T>
void convertAs(std::span<const unsigned char> raw, const VoxelCoding& coding, float* out,
               Oddities& odd) {
  const std::size_t count = raw.size() / sizeof(T);
  for (std::size_t i = 0; i < count; ++i) {
    T stored;
    std::memcpy(&stored, raw.data() + i * sizeof(T), sizeof(T));
    auto value = static_cast<double>(stored);
    if (coding.scaled) value = value * coding.slope + coding.intercept;
    out[i] = static_cast<float>(value);
    if constexpr (std::is_floating_point_v<T>) {
      odd.not_finite += std::isfinite(out[i]) ? 0U : 1U;
    } else if constexpr (sizeof(T) >= 4) {
      odd.rounded += !coding.scaled && std::abs(value) > 16777216.0 ? 1U : 0U;
    }
  }
}

}  // namespace

void Oddities::tell(std::vector<std::string>& notes) const {
  if (not_finite > 0) {
    notes.push_back(std::to_string(not_finite) +
                    " voxels are NaN or infinite: NaN is taken as background");
  }
  if (rounded > 0) {
    notes.push_back(std::to_string(rounded) +
                    " voxels hold integers beyond 16777216 (2^24) and were rounded");
  }
}

void convertVoxels(std::span<unsigned char> raw, const VoxelCoding& coding, float* out,
                   Oddities& odd) {
  const std::size_t bytes = bytesOf(coding.type);
  if (coding.swapped && bytes > 1) {
    for (std::size_t at = 0; at + bytes <= raw.size(); at += bytes) {
      std::reverse(raw.begin() + static_cast<std::ptrdiff_t>(at),
                   raw.begin() + static_cast<std::ptrdiff_t>(at + bytes));
    }
  }
  withKind(coding.type, [&](auto zero) { convertAs<decltype(zero)>(raw, coding, out, odd); });
}

std::vector<float> readVoxels(ByteStream& stream, std::uint64_t count, const VoxelCoding& coding,
                              Oddities& odd) {
  // Memory grows as voxels arrive, not by the size that the header promises.
  std::vector<float> values;
  values.reserve(count);
  const std::size_t bytes = bytesOf(coding.type);
  std::vector<unsigned char> raw(std::size_t{1} << 16U);  // a multiple of every voxel size
  for (std::uint64_t done = 0; done < count;) {
    pollStop();
    const auto here =
        static_cast<std::size_t>(std::min<std::uint64_t>(raw.size() / bytes, count - done));
    const std::size_t got = stream.read(std::span(raw).first(here * bytes));
    if (got < here * bytes) stream.failShort(done + got / bytes, count);
    values.resize(done + here);
    convertVoxels(std::span(raw).first(got), coding, values.data() + done, odd);
    done += here;
  }
  return values;
}

void skipBytes(ByteStream& stream, std::uint64_t bytes, std::uint64_t count) {
  std::vector<unsigned char> scratch(std::size_t{1} << 16U);
  while (bytes > 0) {
    pollStop();
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, scratch.size()));
    const std::size_t got = stream.read(std::span(scratch).first(step));
    if (got == 0) stream.failShort(0, count);
    bytes -= got;
  }
}

}  // namespace palpate::vdb
