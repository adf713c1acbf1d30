// Sound files, every file that ever did harm, and some thousand damaged ones: each is either read,
// or refused by an Error.

#include <gtest/gtest.h>

#include <cstdlib>

#include "fuzz/damage.h"
#include "fuzz/readers.h"
#include "fuzz/seeds.h"

namespace palpate::fuzz {
namespace {

class Replay : public ::testing::TestWithParam<Reader> {};

TEST_P(Replay, ReadsWhatTheTestsOwnWritersMake) {
  // Scenes name other files, and need readers that this program does not have.
  const bool may_be_refused = std::string_view(GetParam().name) == "yaml";
  int read = 0;
  for (const std::string& seed : seedsOf(GetParam().name)) {
    const Outcome outcome = readBytes(GetParam(), seed);
    if (!may_be_refused) {
      EXPECT_EQ(outcome, Outcome::kRead);
    }
    read += outcome == Outcome::kRead ? 1 : 0;
  }
  EXPECT_GT(read, 0);
}

TEST_P(Replay, AnswersEveryFind) {
  for (const Find& find : finds()) {
    if (find.reader != GetParam().name) continue;
    SCOPED_TRACE(find.name);
    EXPECT_NO_THROW((void)readBytes(GetParam(), find.bytes));
  }
}

TEST_P(Replay, AnswersEveryKindOfDamage) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int rounds = slow ? 200 : 6;
  const std::vector<std::string> seeds = seedsOf(GetParam().name);
  Random random(13);
  for (const Damage& damage : damages()) {
    for (int round = 0; round < rounds; ++round) {
      std::string bytes = seeds[static_cast<std::size_t>(round) % seeds.size()];
      damage.apply(bytes, random);
      SCOPED_TRACE(std::string(damage.name) + " " + std::to_string(round));
      ASSERT_NO_THROW((void)readBytes(GetParam(), bytes));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Replay, ::testing::ValuesIn(readers().begin(), readers().end()),
                         [](const auto& reader) { return reader.param.name; });

}  // namespace
}  // namespace palpate::fuzz
