#include "palpate/render/trace.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <random>

#include "support/alloc_guard.h"

namespace palpate {
namespace {

const std::string kHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,"
    "region,contact,event,tick_ns\n";
const std::vector<std::string> kRegions{"outside", "skin", "Thalamus, left"};
const std::vector<std::string> kPorts{"mouth", "cut", "a \"b\""};

std::string csv(const TraceRow& row) { return traceCsv(std::span(&row, 1), kRegions, kPorts); }

std::string body(const TraceRow& row) { return csv(row).substr(kHeader.size()); }

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t start = 0;
  while (true) {
    const std::size_t stop = line.find(',', start);
    fields.push_back(line.substr(start, stop - start));
    if (stop == std::string::npos) return fields;
    start = stop + 1;
  }
}

TEST(TraceCsv, NoRowsIsTheHeaderAlone) { EXPECT_EQ(traceCsv({}, kRegions, kPorts), kHeader); }

TEST(TraceCsv, OneRowInFull) {
  TraceRow row;
  row.t = 0.001;
  row.hip = Vec3(0.1, -0.2, 3.0);
  row.result.proxy = Vec3(0.0, -0.0, 1e-7);
  row.result.force = Vec3(1.5, 0.0, -2.0);
  row.result.region = 1;
  row.result.contact = true;
  row.result.events = {1};
  row.result.event_count = 1;
  row.tick_ns = 312;
  EXPECT_EQ(csv(row), kHeader + "0.001,0.1,-0.2,3,0,-0,1e-07,1.5,0,-2,skin,1,cut,312\n");
}

TEST(TraceCsv, EventsAreJoinedInPathOrder) {
  TraceRow row;
  row.result.events = {1, 0, 1};
  row.result.event_count = 3;
  EXPECT_EQ(body(row), "0,0,0,0,0,0,0,0,0,0,outside,0,cut;mouth;cut,0\n");
}

TEST(TraceCsv, NamesThatWouldBreakARowAreQuoted) {
  TraceRow row;
  row.result.region = 2;
  row.result.events = {2, 0};
  row.result.event_count = 2;
  EXPECT_EQ(body(row), "0,0,0,0,0,0,0,0,0,0,\"Thalamus, left\",0,\"a \"\"b\"\";mouth\",0\n");
}

TEST(TraceCsv, BrokenSensorsAreShown) {
  TraceRow row;
  row.hip = Vec3(std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity);
  EXPECT_EQ(body(row), "0,nan,inf,-inf,0,0,0,0,0,0,outside,0,,0\n");
}

TEST(TraceCsv, AnIdWithoutANameIsAnError) {
  TraceRow row;
  row.result.region = 3;
  EXPECT_THROW(static_cast<void>(csv(row)), Error);
  row.result.region = 0;
  row.result.events = {7};
  row.result.event_count = 1;
  EXPECT_THROW(static_cast<void>(csv(row)), Error);
}

TEST(TraceCsv, EveryNumberReadsBackExactly) {
  // All bit patterns that are finite numbers: subnormal, largest, smallest, negative zero.
  std::mt19937_64 random(7);
  std::vector<TraceRow> rows(2000);
  std::vector<double> numbers;
  for (TraceRow& row : rows) {
    const auto any = [&] {
      double value = 0.0;
      do {
        value = std::bit_cast<double>(random());
      } while (!std::isfinite(value));
      numbers.push_back(value);
      return value;
    };
    row.t = any();
    for (Vec3* v : {&row.hip, &row.result.proxy, &row.result.force}) {
      for (int i = 0; i < 3; ++i) (*v)[i] = any();
    }
    row.tick_ns = static_cast<std::int64_t>(random());
  }
  const std::string text = traceCsv(rows, kRegions, kPorts);

  std::size_t at = kHeader.size();
  std::size_t k = 0;
  for (const TraceRow& row : rows) {
    const std::size_t stop = text.find('\n', at);
    const std::vector<std::string> fields = split(text.substr(at, stop - at));
    ASSERT_EQ(fields.size(), 14U);
    for (int i = 0; i < 10; ++i, ++k) {
      const std::string& field = fields[static_cast<std::size_t>(i)];
      double value = 0.0;
      ASSERT_EQ(std::from_chars(field.data(), field.data() + field.size(), value).ptr,
                field.data() + field.size());
      ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(numbers[k]));
    }
    EXPECT_EQ(fields[13], std::to_string(row.tick_ns));
    at = stop + 1;
  }
  EXPECT_EQ(at, text.size());
}

TEST(Trace, AddsWithoutAllocatingAndCountsWhatItDrops) {
  Trace trace(100);
  const testing::AllocGuard guard;
  for (int i = 0; i < 103; ++i) trace.add({.t = static_cast<double>(i)});
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_EQ(trace.rows().size(), 100U);
  EXPECT_EQ(trace.dropped(), 3U);
  EXPECT_EQ(trace.rows()[99].t, 99.0);
}

}  // namespace
}  // namespace palpate
