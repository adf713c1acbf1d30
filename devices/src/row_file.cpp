#include <array>
#include <bit>
#include <string>
#include <utility>

#include "palpate/devices/record.h"
#include "row_format.h"

namespace palpate::devices {
namespace {

static_assert(std::endian::native == std::endian::little, "rows are written as they lie in memory");

struct Column {
  const char* name;
  const char* type;
  std::size_t offset;
  std::size_t count = 1;
};

#define PALPATE_COLUMN(name, type) \
  Column { #name, type, offsetof(TickRecord, name) }
#define PALPATE_COLUMNS(name, type, count) \
  Column { #name, type, offsetof(TickRecord, name), count }

constexpr std::array kColumns = {
    PALPATE_COLUMN(t, "<f8"),
    PALPATE_COLUMN(dt, "<f8"),
    PALPATE_COLUMNS(device_position, "<f8", 3),
    PALPATE_COLUMNS(device_velocity, "<f8", 3),
    PALPATE_COLUMNS(hip, "<f8", 3),
    PALPATE_COLUMNS(hip_velocity, "<f8", 3),
    PALPATE_COLUMNS(proxy, "<f8", 3),
    PALPATE_COLUMNS(unlimited_force, "<f8", 3),
    PALPATE_COLUMNS(force, "<f8", 3),
    PALPATE_COLUMNS(device_force, "<f8", 3),
    PALPATE_COLUMNS(written_force, "<f8", 3),
    PALPATE_COLUMN(share, "<f8"),
    PALPATE_COLUMN(tick_ns, "<i8"),
    PALPATE_COLUMN(tick, "<u8"),
    PALPATE_COLUMN(buttons, "<u4"),
    PALPATE_COLUMN(region, "<u2"),
    PALPATE_COLUMN(event_count, "|u1"),
    PALPATE_COLUMN(entry_count, "|u1"),
    PALPATE_COLUMNS(events, "<u2", TickRecord::kEvents),
    PALPATE_COLUMN(contact, "|b1"),
    PALPATE_COLUMN(settled, "|b1"),
    PALPATE_COLUMN(clutch, "|b1"),
    PALPATE_COLUMN(checkpoint, "|b1"),
    PALPATE_COLUMN(stale, "|b1"),
    PALPATE_COLUMN(zeroed, "|b1"),
    PALPATE_COLUMN(shortened, "|b1"),
    PALPATE_COLUMN(late, "|b1"),
};

#undef PALPATE_COLUMN
#undef PALPATE_COLUMNS

/// [bytes] of one value of a column: the last character of its type states it.
constexpr std::size_t widthOf(const Column& column) {
  return static_cast<std::size_t>(column.type[2] - '0') * column.count;
}

constexpr bool areWithoutGaps() {
  std::size_t at = 0;
  for (const Column& column : kColumns) {
    if (column.offset != at) return false;
    at += widthOf(column);
  }
  return at == sizeof(TickRecord);
}
static_assert(areWithoutGaps(), "columns are all of the row, in its order");

RowHeader makeHeader() {
  std::string dictionary = "{'descr': [";
  for (const Column& column : kColumns) {
    dictionary += std::string("('") + column.name + "', '" + column.type + "'";
    if (column.count > 1) dictionary += ", (" + std::to_string(column.count) + ",)";
    dictionary += "), ";
  }
  dictionary += "], 'fortran_order': False, 'shape': (";
  RowHeader header;
  constexpr std::size_t kPrefix = 10;  // magic, version and length of the header
  header.count_at = kPrefix + dictionary.size();
  dictionary += countDigits(0) + ",), }";
  constexpr std::size_t kAlignment = 64;
  while ((kPrefix + dictionary.size() + 1) % kAlignment != 0) dictionary += ' ';
  dictionary += '\n';
  header.text = std::string("\x93NUMPY\x01\x00", 8);
  header.text += static_cast<char>(dictionary.size() & 0xffU);
  header.text += static_cast<char>(dictionary.size() >> 8U);
  header.text += dictionary;
  return header;
}

constexpr std::size_t kRowsAtOnce = (std::size_t{1} << 20U) / sizeof(TickRecord);

}  // namespace

const RowHeader& emptyRowHeader() {
  static const RowHeader header = makeHeader();
  return header;
}

std::string countDigits(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  return std::string(kCountDigits - digits.size(), ' ') + digits;
}

RowFile::RowFile(const std::string& file, std::string name) : out_(file, std::move(name)) {
  const std::string& header = emptyRowHeader().text;
  out_.append(header.data(), header.size(), header.size());
  rows_.reserve(kRowsAtOnce);
}

void RowFile::add(const RecordedTick& tick, std::span<const RegionEntry>) {
  rows_.push_back(rowOf(tick));
  if (rows_.size() == kRowsAtOnce) flush();
}

void RowFile::flush() {
  if (rows_.empty()) return;
  const RowHeader& header = emptyRowHeader();
  const auto promise = [&] {
    const std::uint64_t count = (out_.size() - header.text.size()) / sizeof(TickRecord);
    out_.overwrite(header.count_at, countDigits(count));
  };
  try {
    out_.append(rows_.data(), rows_.size() * sizeof(TickRecord), sizeof(TickRecord));
  } catch (const Error&) {
    promise();  // counts the rows for which there was room
    throw;
  }
  rows_.clear();
  promise();
}

}  // namespace palpate::devices
