#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "palpate/devices/record.h"
#include "row_format.h"

namespace palpate::devices {
namespace {

constexpr const char* kRemedy = "a record is written by palpate touch SCENE ... --record FILE.npy";

/// Parses the digits of a count; false if there is anything else, or if the number is too large.
bool parseCount(const std::string& digits, std::uint64_t& count) {
  const std::size_t first = digits.find_first_not_of(' ');
  if (first == std::string::npos) return false;
  count = 0;
  for (std::size_t i = first; i < digits.size(); ++i) {
    if (digits[i] < '0' || digits[i] > '9') return false;
    const auto digit = static_cast<std::uint64_t>(digits[i] - '0');
    if (count > (UINT64_MAX - digit) / 10) return false;
    count = 10 * count + digit;
  }
  return true;
}

}  // namespace

RecordReader::RecordReader(std::string file) : file_(std::move(file)) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file_, failed)) {
    throw inputError("record.unreadable", "there is no such file, or it is not a regular file",
                     "check the path and its spelling", file_);
  }
  const std::uint64_t bytes = std::filesystem::file_size(file_, failed);
  in_.open(file_, std::ios::binary);
  if (failed || !in_) {
    throw inputError("record.unreadable", "the file cannot be opened", "check its permissions",
                     file_);
  }
  const RowHeader& ours = emptyRowHeader();
  std::string header(ours.text.size(), '\0');
  in_.read(header.data(), static_cast<std::streamsize>(header.size()));
  const auto got = static_cast<std::size_t>(in_.gcount());
  constexpr std::size_t kMagic = 6;
  if (got < kMagic || header.compare(0, kMagic, ours.text, 0, kMagic) != 0) {
    throw inputError("record.magic", "this is not a record: it does not begin as a .npy file does",
                     kRemedy, file_);
  }
  const std::string digits = header.substr(ours.count_at, kCountDigits);
  header.replace(ours.count_at, kCountDigits, countDigits(0));
  if (got < ours.text.size() || header != ours.text || !parseCount(digits, promised_)) {
    throw inputError("record.columns",
                     "the header is damaged, or the array's columns are not those of a record of "
                     "this version",
                     kRemedy, file_);
  }
  size_ = std::min(promised_, (bytes - ours.text.size()) / sizeof(TickRecord));
}

void RecordReader::read(std::uint64_t at, TickRecord& row) {
  if (in_at_ != at) {
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(emptyRowHeader().text.size() + at * sizeof(TickRecord)));
  }
  std::array<char, sizeof(TickRecord)> bytes{};
  in_.read(bytes.data(), bytes.size());
  if (!in_) {
    throw inputError("record.unreadable", "reading failed at row " + std::to_string(at),
                     "look at the disk that it is on", file_);
  }
  std::memcpy(&row, bytes.data(), bytes.size());
  in_at_ = at + 1;
}

void RecordReader::seek(std::uint64_t tick) {
  std::uint64_t low = 0;
  std::uint64_t high = size_;
  TickRecord row;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    read(middle, row);
    if (row.tick < tick) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  at_ = low;
}

bool RecordReader::next(TickRecord& row) {
  if (at_ == size_) return false;
  read(at_, row);
  ++at_;
  return true;
}

}  // namespace palpate::devices
