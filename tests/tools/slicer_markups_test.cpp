// Slicer's Markups files: written files are read back, units and coordinate systems are understood,
// and damage never crashes the reader.

#include "slicer_markups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "palpate/core/error.h"
#include "support/error_of.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

using tools::Markup;
using tools::markupsText;
using tools::readMarkups;
using tools::thinned;

Vec3 anyPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-0.3, 0.3);
  return {any(random), any(random), any(random)};
}

TEST(SlicerMarkups, AreReadAsTheyWereWritten) {
  std::mt19937 random(5);
  const TempFolder folder;
  for (int round = 0; round < 50; ++round) {
    std::vector<Markup> written(random() % 4);
    for (Markup& markup : written) {
      markup.type = std::array{"Fiducial", "Line", "Curve"}[random() % 3];
      markup.name = "a \"name\"\né " + std::to_string(random());
      for (std::size_t n = random() % 5; n > 0; --n) {
        markup.points.push_back({std::to_string(n), anyPoint(random)});
      }
    }
    const std::vector<Markup> read = readMarkups(folder.file("a.mrk.json", markupsText(written)));
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t m = 0; m < read.size(); ++m) {
      EXPECT_EQ(read[m].type, written[m].type);
      EXPECT_EQ(read[m].name, written[m].name);
      ASSERT_EQ(read[m].points.size(), written[m].points.size());
      for (std::size_t n = 0; n < read[m].points.size(); ++n) {
        EXPECT_EQ(read[m].points[n].label, written[m].points[n].label);
        // Millimeters round once on the way out and once on the way in.
        EXPECT_LT(glm::length(read[m].points[n].position - written[m].points[n].position), 1e-15);
      }
    }
  }
}

TEST(SlicerMarkups, SayInWhichSpaceAndUnitTheyAre) {
  const TempFolder folder;
  const auto first = [&](const std::string& keys) {
    const std::string text = R"({"markups": [{"type": "Fiducial", )" + keys +
                             R"("controlPoints": [
      {"label": "not yet", "positionStatus": "undefined", "position": [9, 9, 9]},
      {"label": "A", "position": [10, -20, 30]}]}]})";
    const std::vector<Markup> read = readMarkups(folder.file("a.mrk.json", text));
    EXPECT_EQ(read.at(0).points.size(), 1U);
    return read.at(0).points.at(0).position;
  };
  const auto expect_at = [](const Vec3& got, const Vec3& mm) {
    EXPECT_LT(glm::length(got - 1e-3 * mm), 1e-15);
  };
  expect_at(first(""), Vec3(-10, 20, 30));
  expect_at(first(R"("coordinateSystem": "LPS", )"), Vec3(-10, 20, 30));
  expect_at(first(R"("coordinateSystem": "RAS", )"), Vec3(10, -20, 30));
  expect_at(first(R"("coordinateUnits": "cm", )"), Vec3(-100, 200, 300));
  expect_at(first(R"("coordinateUnits": ["mm", "UCUM", "millimeter"], )"), Vec3(-10, 20, 30));
  const auto code = [&](const std::string& text) {
    return errorOf([&] { (void)readMarkups(folder.file("b.mrk.json", text)); }).problem().message;
  };
  EXPECT_EQ(code(R"({"markups": [{"coordinateSystem": "XYZ", "controlPoints": []}]})"),
            R"(the coordinate system of markup 1 is "XYZ", permitted are "LPS" and "RAS")");
  EXPECT_EQ(code(R"({"markups": [{"coordinateUnits": "in", "controlPoints": []}]})"),
            R"(the unit of markup 1 is "in", permitted are "mm", "cm", "m" and "um")");
  EXPECT_EQ(code(R"({"markups": [{"controlPoints": [{"position": [1, 2]}]}]})"),
            "the position of point 1 of markup 1 is not three numbers");
  EXPECT_EQ(code(R"({"markups": [{"controlPoints": [{"label": "A"}]}]})"),
            "point 1 of markup 1 has no 'position'");
}

TEST(SlicerMarkups, DamageIsAnErrorOrOtherPointsNeverACrash) {
  std::mt19937 random(6);
  const TempFolder folder;
  const std::string whole =
      markupsText({{"Line", "way", {{"entry", Vec3(0.01)}, {"t", Vec3(0.0)}}}});
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string text = whole;
    for (std::size_t n = 1 + random() % 3; n > 0; --n) {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    if (random() % 4 == 0) text.resize(random() % text.size());
    const std::string file = folder.file("a.mrk.json", text);
    try {
      for (const Markup& markup : readMarkups(file)) {
        for (const auto& point : markup.points) ASSERT_TRUE(isFinite(point.position));
      }
    } catch (const Error& error) {
      ++refused;
      ASSERT_EQ(error.kind(), ErrorKind::kInput);
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(SlicerMarkups, NestedAHundredThousandDeepTheyAreRefused) {
  const TempFolder folder;
  const std::string file = folder.file("a.mrk.json", std::string(100'000, '['));
  EXPECT_EQ(errorOf([&] { (void)readMarkups(file); }).problem().code, "markups.syntax");
}

TEST(SlicerMarkups, AThinnedPathStaysWithinItsTolerance) {
  std::mt19937 random(7);
  std::normal_distribution<double> any(0.0, 1e-4);
  for (int round = 0; round < 30; ++round) {
    std::vector<Vec3> path = {anyPoint(random)};
    const std::size_t count = 1 + random() % 400;
    while (path.size() < count) {
      const bool rests = random() % 5 == 0;
      path.push_back(path.back() +
                     (rests ? Vec3(0.0) : Vec3(any(random), any(random), any(random))));
    }
    constexpr double kTolerance = 2e-4;
    const std::vector<Vec3> few = thinned(path, kTolerance);
    ASSERT_EQ(few.front(), path.front());
    ASSERT_EQ(few.back(), path.back());
    for (const Vec3& p : path) {
      double nearest = glm::length(p - few.front());
      for (std::size_t n = 1; n < few.size(); ++n) {
        const Vec3 along = few[n] - few[n - 1];
        const double square = glm::dot(along, along);
        const double share =
            square > 0.0 ? std::clamp(glm::dot(p - few[n - 1], along) / square, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(p - few[n - 1] - share * along));
      }
      ASSERT_LE(nearest, kTolerance * (1.0 + 1e-9));
    }
  }
  // On a straight line the ends are enough.
  EXPECT_EQ(thinned({Vec3(0.0), Vec3(1.0), Vec3(2.0), Vec3(3.0)}, 1e-6).size(), 2U);
}

TEST(SlicerMarkups, ATraceBecomesACurve) {
  const TempFolder folder;
  const CommandResult touch = runPalpate({"touch", scenePath("slab.yaml"), "--insert", "0,0,5",
                                          "0,0,-25", "--speed", "50", "--trace", "t.csv"},
                                         folder.path());
  ASSERT_EQ(touch.exit_code, 0) << touch.err;
  const CommandResult result =
      runPalpate({"convert", "t.csv", "-o", "t.mrk.json", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<Markup> read = readMarkups(folder.path("t.mrk.json"));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].type, "Curve");
  EXPECT_EQ(read[0].points.size(), parseOnly(result)["points"].get<std::size_t>());
  EXPECT_GE(read[0].points.size(), 2U);
  EXPECT_EQ(
      runPalpate({"convert", scenePath("slab.yaml"), "-o", "x.mrk.json"}, folder.path()).exit_code,
      2);
}

}  // namespace
}  // namespace palpate::testing
