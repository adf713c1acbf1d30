// Records in files: the written data are read back, full disks leave whole rows, and a damaged file
// never yields more than it contains.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/record.h"
#include "palpate/render/tick_state.h"
#include "support/temp_file.h"

namespace palpate::devices {
namespace {

using testing::TempFolder;

/// Random bits for everything in a tick; row n has the number n.
RecordedTick randomTick(std::mt19937& random, std::uint64_t number) {
  const auto any = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
  const auto vector = [&] { return Vec3(any(), any(), any()); };
  RecordedTick out;
  SessionTick& tick = out.tick;
  tick.number = number;
  tick.reading = {any(), vector(), vector(), static_cast<std::uint32_t>(random())};
  tick.dt = any();
  tick.hip = {vector(), vector(), tick.dt};
  tick.result.force = vector();
  tick.result.proxy = vector();
  tick.result.region = static_cast<RegionId>(random() % 65536);
  tick.result.contact = random() % 2 == 0;
  tick.result.settled = random() % 2 == 0;
  tick.result.event_count = static_cast<std::uint8_t>(random() % 33);
  for (PortId& port : tick.result.events) port = static_cast<PortId>(random() % 65536);
  tick.unlimited = vector();
  tick.force = vector();
  tick.renderer_ns = static_cast<std::int64_t>(random());
  tick.is_held = random() % 2 == 0;
  out.turn = {vector(),         any(), random() % 2 == 0, random() % 2 == 0, random() % 2 == 0,
              random() % 2 == 0};
  out.entry_count = static_cast<std::uint32_t>(random() % 600);
  return out;
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<TickRecord> rowsOf(RecordReader& reader) {
  std::vector<TickRecord> rows;
  TickRecord row;
  while (reader.next(row)) rows.push_back(row);
  return rows;
}

bool isSame(const TickRecord& a, const TickRecord& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(RecordFile, WhatIsWrittenIsReadBack) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const TempFolder folder;
    const std::string file = folder.path("r.npy");
    std::vector<TickRecord> written;
    std::uint64_t number = 0;
    {
      RowFile rows(file, file);
      EXPECT_EQ(RecordReader(file).size(), 0U);
      const std::size_t count = random() % 9000;
      for (std::size_t n = 0; n < count; ++n, ++number) {
        if (random() % 500 == 0) number += random() % 9;  // ticks that were dropped
        const RecordedTick tick = randomTick(random, number);
        rows.add(tick, {});
        written.push_back(rowOf(tick));
        if (random() % 1000 != 0) continue;
        rows.flush();
        // At any time the file can be read completely.
        RecordReader now(file);
        EXPECT_EQ(now.promised(), now.size());
        ASSERT_EQ(now.size(), written.size());
      }
      rows.flush();
    }
    RecordReader reader(file);
    ASSERT_EQ(reader.size(), written.size());
    const std::vector<TickRecord> read = rowsOf(reader);
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t n = 0; n < read.size(); ++n) ASSERT_TRUE(isSame(read[n], written[n])) << n;
    for (int i = 0; i < 50; ++i) {
      const std::uint64_t tick = random() % (number + 2);
      const auto wanted = std::find_if(written.begin(), written.end(),
                                       [&](const TickRecord& row) { return row.tick >= tick; });
      reader.seek(tick);
      TickRecord row;
      ASSERT_EQ(reader.next(row), wanted != written.end()) << tick;
      if (wanted != written.end()) {
        EXPECT_TRUE(isSame(row, *wanted));
      }
    }
  }
}

/// While this exists, no file of this process can grow beyond `bytes`.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    before_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, before_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit old_{};
  void (*before_)(int) = nullptr;
};

TEST(RecordFile, AFullDiskLeavesWholeRowsAndIsReported) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const TempFolder folder;
    const std::string file = folder.path("r.npy");
    const rlim_t room = 3000 + random() % 3000000;
    std::vector<TickRecord> written;
    bool is_told = false;
    {
      const SmallDisk disk(room);
      RowFile rows(file, "the record");
      try {
        for (std::uint64_t n = 0; n < 12000; ++n) {
          const RecordedTick tick = randomTick(random, n);
          written.push_back(rowOf(tick));
          rows.add(tick, {});
        }
        rows.flush();
      } catch (const Error& error) {
        is_told = true;
        EXPECT_EQ(error.kind(), ErrorKind::kOperation);
        EXPECT_EQ(error.problem().file, "the record");
      }
    }
    EXPECT_TRUE(is_told) << seed;
    RecordReader reader(file);
    EXPECT_EQ(reader.size(), reader.promised());
    const std::uint64_t header = bytesOf(file).size() - reader.size() * sizeof(TickRecord);
    EXPECT_EQ(reader.size(), (room - header) / sizeof(TickRecord)) << "all that there was room for";
    const std::vector<TickRecord> read = rowsOf(reader);
    for (std::size_t n = 0; n < read.size(); ++n) ASSERT_TRUE(isSame(read[n], written[n])) << n;
  }
}

/// Truncates, changes, appends or moves bytes.
std::string damaged(std::string bytes, std::mt19937& random, std::size_t most_at) {
  const auto at = [&] { return random() % std::min(bytes.size(), most_at); };
  switch (random() % 5) {
    case 0:
      bytes.resize(random() % bytes.size());
      break;
    case 1:
      for (unsigned i = 1 + random() % 8; i > 0; --i)
        bytes[at()] ^= static_cast<char>(1 + random() % 255);
      break;
    case 2:
      for (std::size_t i = at(), end = std::min(bytes.size(), i + 24); i < end; ++i) bytes[i] = '9';
      break;
    case 3:
      bytes.insert(at(), 1 + random() % 40, static_cast<char>(random()));
      break;
    default:
      bytes.erase(at(), 1 + random() % 40);
      break;
  }
  return bytes;
}

TEST(RecordFile, NoDamageMakesMoreOfARecordThanIsInIt) {
  std::mt19937 random(5);
  const TempFolder folder;
  const std::string file = folder.path("r.npy");
  {
    RowFile rows(file, file);
    for (std::uint64_t n = 0; n < 40; ++n) rows.add(randomTick(random, n), {});
    rows.flush();
  }
  const std::string good = bytesOf(file);
  const std::size_t header = good.size() - 40 * sizeof(TickRecord);
  int refused = 0;
  int read = 0;
  for (int i = 0; i < 800; ++i) {
    const std::string bytes = damaged(good, random, i % 2 == 0 ? header : good.size());
    const std::string bad = folder.file("bad.npy", bytes);
    try {
      RecordReader reader(bad);
      ASSERT_LE(reader.size(), (bytes.size() - header) / sizeof(TickRecord));
      ASSERT_LE(reader.size(), reader.promised());
      ASSERT_EQ(rowsOf(reader).size(), reader.size());
      reader.seek(random() % 50);
      ++read;
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::kInput);
      ASSERT_EQ(error.problem().file, bad);
      ASSERT_FALSE(error.problem().hint.empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, 250);
  EXPECT_GT(read, 120);
}

TEST(RecordFile, OnlyWholeStatesOfThisBuildAndRecordAreGiven) {
  std::mt19937 random(6);
  const TempFolder folder;
  const std::string file = folder.path("r.states");
  std::vector<std::string> written;
  const auto state = std::make_unique<SessionState>();
  const auto bits_of = [](const SessionState& of) {
    return std::string(reinterpret_cast<const char*>(&of), sizeof of);
  };
  {
    StateFile states(file, file, "about");
    for (std::uint64_t n = 1; n <= 5; ++n) {
      state->ticks = 100 * n;
      state->last_time = static_cast<double>(random());
      TickState tick = TickState::of(state->renderer);
      tick.hip = Vec3(static_cast<double>(random()));
      state->renderer = tick.sealed();
      states.addState(*state);
      written.push_back(bits_of(*state));
    }
  }
  StateReader reader(file, "about");
  EXPECT_EQ(reader.ticks(), (std::vector<std::uint64_t>{100, 200, 300, 400, 500}));
  EXPECT_FALSE(reader.before(99));
  for (const std::uint64_t tick : {100U, 199U, 200U, 450U, 500U, 99999U}) {
    const auto got = reader.before(tick);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->ticks, std::min<std::uint64_t>(tick / 100, 5) * 100);
    EXPECT_EQ(bits_of(*got), written[got->ticks / 100 - 1]);
  }
  EXPECT_THROW(StateReader(file, "about another"), Error);

  const std::string good = bytesOf(file);
  int refused = 0;
  int fewer = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string bad =
        folder.file("bad.states", damaged(good, random, i % 2 == 0 ? 400 : good.size()));
    try {
      StateReader tried(bad, "about");
      const auto got = tried.before(random() % 600);
      if (!got) {
        ++fewer;
        continue;
      }
      ASSERT_NE(std::find(written.begin(), written.end(), bits_of(*got)), written.end());
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::kInput);
      ++refused;
    }
  }
  EXPECT_GT(refused, 60);
  EXPECT_GT(fewer, 20);
  // From another build: the error names both builds.
  std::string other = good;
  other.replace(other.find("palpate "), 9, "palpate 9");
  const std::uint64_t sum = checksum({other.data(), 208});
  std::memcpy(other.data() + 208, &sum, sizeof sum);
  try {
    StateReader tried(folder.file("other.states", other), "about");
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().message.find("another build, 'palpate 9"), std::string::npos)
        << error.what();
    EXPECT_NE(error.problem().message.find(stateBuild()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::devices
