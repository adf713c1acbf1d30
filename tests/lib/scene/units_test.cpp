#include "palpate/scene/units.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace palpate {
namespace {

TEST(Numbers, PlainDecimalsAreRead) {
  EXPECT_EQ(parseNumber("0"), 0.0);
  EXPECT_EQ(parseNumber("-0"), 0.0);
  EXPECT_EQ(parseNumber("40"), 40.0);
  EXPECT_EQ(parseNumber("+1.5"), 1.5);
  EXPECT_EQ(parseNumber("-2.50"), -2.5);
  EXPECT_EQ(parseNumber(".5"), 0.5);
  EXPECT_EQ(parseNumber("5."), 5.0);
  EXPECT_EQ(parseNumber("0.25e-3"), 0.25e-3);
  EXPECT_EQ(parseNumber("1E+2"), 100.0);
}

TEST(Numbers, WhatReadersDisagreeAboutIsNot) {
  for (const char* text :
       {"",      " 1",  "1 ",  "010",  "00",    "-01", "0x1F", "0o17", "0b1",
        "1_000", "1,5", "inf", ".inf", "-.inf", "nan", ".nan", ".NaN", "Infinity",
        "1e",    "e1",  "1e+", "--1",  "+-1",   "+",   "-",    ".",    "1.2.3",
        "1:30",  "1f",  "yes", "~",    "1e999", "1 2"}) {
    EXPECT_EQ(parseNumber(text), std::nullopt) << text;
  }
}

TEST(Numbers, EveryDoublePrintedWith17DigitsReadsBackExactly) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-300, 300);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::ldexp(mantissa(random), exponent(random));
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.17g", value);
    EXPECT_EQ(parseNumber(text.data()), value) << text.data();
  }
}

struct Case {
  const char* text;
  Dimension dimension;
  double si;
};

TEST(Quantities, EveryUnitInSi) {
  for (const Case& c : {
           Case{"3 m", Dimension::kLength, 3.0},
           Case{"3 mm", Dimension::kLength, 0.003},
           Case{"3 cm", Dimension::kLength, 0.03},
           Case{"30 um", Dimension::kLength, 30e-6},
           Case{"2 in", Dimension::kLength, 0.0508},
           Case{"2.8 N", Dimension::kForce, 2.8},
           Case{"5 mN", Dimension::kForce, 0.005},
           Case{"1 kN", Dimension::kForce, 1000.0},
           Case{"1500 N/m", Dimension::kStiffness, 1500.0},
           Case{"1.5 N/mm", Dimension::kStiffness, 1500.0},
           Case{"15 N/cm", Dimension::kStiffness, 1500.0},
           Case{"1.5 kN/m", Dimension::kStiffness, 1500.0},
           Case{"4 N.s/m", Dimension::kDamping, 4.0},
           Case{"0.5 Ns/m", Dimension::kDamping, 0.5},
           Case{"2 N.s/mm", Dimension::kDamping, 2000.0},
           Case{"2 Ns/mm", Dimension::kDamping, 2000.0},
           Case{"20 mm/s", Dimension::kVelocity, 0.02},
           Case{"-1 m/s", Dimension::kVelocity, -1.0},
           Case{"3 cm/s", Dimension::kVelocity, 0.03},
           Case{"2 s", Dimension::kTime, 2.0},
           Case{"20 ms", Dimension::kTime, 0.02},
           Case{"5 us", Dimension::kTime, 5e-6},
           Case{"50 Hz", Dimension::kFrequency, 50.0},
           Case{"1 kHz", Dimension::kFrequency, 1000.0},
           Case{"7 N/m^2", Dimension::kStiffness2, 7.0},
           Case{"7 N/cm^2", Dimension::kStiffness2, 7e4},
           Case{"7 N/mm^2", Dimension::kStiffness2, 7e6},
           Case{"7 N.s/m^2", Dimension::kDamping2, 7.0},
           Case{"7 Ns/m^2", Dimension::kDamping2, 7.0},
           Case{"7 N.s/mm^2", Dimension::kDamping2, 7e6},
           // No space, several spaces, a sign, an exponent.
           Case{"3mm", Dimension::kLength, 0.003},
           Case{"3   mm", Dimension::kLength, 0.003},
           Case{"+3 mm", Dimension::kLength, 0.003},
           Case{"-3e-1 mm", Dimension::kLength, -0.0003},
       }) {
    const Quantity quantity = parseQuantity(c.text, c.dimension);
    EXPECT_EQ(quantity.status, Quantity::Status::kOk) << c.text;
    EXPECT_DOUBLE_EQ(quantity.si, c.si) << c.text;
  }
}

TEST(Quantities, WholeMillimetersAreTheDoubleNearestToTheMeters) {
  // 35 * 0.001 is not 0.035: a third of the whole numbers would be wrong in the last digit.
  for (int i = 0; i < 20000; ++i) {
    std::array<char, 32> meters{};
    std::snprintf(meters.data(), meters.size(), "%d.%03d", i / 1000, i % 1000);
    const std::string millimeters = std::to_string(i) + " mm";
    EXPECT_EQ(parseQuantity(millimeters, Dimension::kLength).si, *parseNumber(meters.data()));
  }
}

TEST(Quantities, PrintedValuesReadBack) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-60, 60);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::ldexp(mantissa(random), exponent(random));
    std::array<char, 60> text{};
    std::snprintf(text.data(), text.size(), "%.17g N/m", value);
    EXPECT_EQ(parseQuantity(text.data(), Dimension::kStiffness).si, value) << text.data();
    std::snprintf(text.data(), text.size(), "%.17g N/mm", value);
    EXPECT_DOUBLE_EQ(parseQuantity(text.data(), Dimension::kStiffness).si, 1000.0 * value);
  }
}

TEST(Quantities, WhatIsWrongIsTold) {
  using Status = Quantity::Status;
  EXPECT_EQ(parseQuantity("1500", Dimension::kStiffness).status, Status::kMissingUnit);
  EXPECT_EQ(parseQuantity("1500 ", Dimension::kStiffness).status, Status::kMissingUnit);
  EXPECT_EQ(parseQuantity("1500 N", Dimension::kStiffness).status, Status::kWrongDimension);
  EXPECT_EQ(parseQuantity("1500 n/m", Dimension::kStiffness).status, Status::kUnknownUnit);
  EXPECT_EQ(parseQuantity("1500 n/m", Dimension::kStiffness).unit, "n/m");
  EXPECT_EQ(parseQuantity("N/m", Dimension::kStiffness).status, Status::kNotANumber);
  EXPECT_EQ(parseQuantity("010 N/m", Dimension::kStiffness).status, Status::kNotANumber);
  EXPECT_EQ(parseQuantity("", Dimension::kStiffness).status, Status::kNotANumber);
  EXPECT_EQ(parseQuantity("1e308 kN/m", Dimension::kStiffness).status, Status::kNotANumber);
  for (const char* text : {"0x1F", "0b1", "1_000 m", "1,5 m", "1.2.3 m", "5\xC2\xA0m"}) {
    EXPECT_EQ(parseQuantity(text, Dimension::kLength).status, Status::kNotANumber) << text;
  }
  EXPECT_EQ(parseQuantity("1.5 N/m x", Dimension::kStiffness).status, Status::kUnknownUnit);
}

TEST(Units, LengthsAndHelp) {
  EXPECT_EQ(metersPer("mm"), 1e-3);
  EXPECT_EQ(metersPer("cm"), 1e-2);
  EXPECT_EQ(metersPer("m"), 1.0);
  EXPECT_EQ(metersPer("um"), 1e-6);
  EXPECT_EQ(metersPer("in"), 0.0254);
  EXPECT_EQ(metersPer("N"), std::nullopt);
  EXPECT_EQ(metersPer("MM"), std::nullopt);
  EXPECT_EQ(metersPer(""), std::nullopt);
  EXPECT_EQ(unitHelp(Dimension::kStiffness), "N/m (also N/mm, N/cm, kN/m)");
  EXPECT_EQ(unitHelp(Dimension::kLength), "m (also mm, cm, um, in)");
}

}  // namespace
}  // namespace palpate
