#include "../../devices/src/servo_schedule.h"

#include <gtest/gtest.h>

namespace palpate::devices {
namespace {

constexpr std::int64_t kPeriod = 1000;

TEST(ServoSchedule, PunctualTicksAreOnePeriodApartForGood) {
  ServoSchedule schedule(500, kPeriod);
  for (std::int64_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(schedule.due(), 500 + k * kPeriod);
    schedule.begin(schedule.due() + k % 10);  // late, but that does not delay the next tick
    schedule.end(schedule.due() + 700);
  }
  EXPECT_EQ(schedule.overruns(), 0U);
  EXPECT_EQ(schedule.worstLateness(), 9);
}

TEST(ServoSchedule, EndingJustWhenTheNextIsDueIsNoOverrun) {
  ServoSchedule schedule(0, kPeriod);
  schedule.begin(0);
  schedule.end(kPeriod);
  EXPECT_EQ(schedule.overruns(), 0U);
  EXPECT_EQ(schedule.due(), kPeriod);
}

TEST(ServoSchedule, AnOverrunSkipsToTheNextTickOfTheOldRaster) {
  for (const auto& [end, next] :
       {std::pair{1001, 2000}, {1999, 2000}, {2000, 2000}, {2001, 3000}, {2500, 3000}}) {
    ServoSchedule schedule(0, kPeriod);
    schedule.begin(0);
    schedule.end(end);
    EXPECT_EQ(schedule.overruns(), 1U) << end;
    EXPECT_EQ(schedule.due(), next) << end;
  }
}

TEST(ServoSchedule, ALongOverrunIsOneOverrunAndNoBurst) {
  ServoSchedule schedule(0, kPeriod);
  schedule.begin(0);
  schedule.end(123456);
  EXPECT_EQ(schedule.overruns(), 1U);
  EXPECT_EQ(schedule.due(), 124000);
}

TEST(ServoSchedule, LatenessIsTheWorstStart) {
  ServoSchedule schedule(0, kPeriod);
  for (const std::int64_t late : {3, 70, 12}) {
    schedule.begin(schedule.due() + late);
    schedule.end(schedule.due() + late + 1);
  }
  EXPECT_EQ(schedule.worstLateness(), 70);
}

}  // namespace
}  // namespace palpate::devices
