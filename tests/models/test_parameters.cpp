#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "contract/parameters.h"

namespace tress::test_parameters {

constexpr Parameter declared[] = {
    {.name = "links",
     .help = "number of links",
     .number = 10,
     .min = 1,
     .max = 1e5,
     .whole = true},
    {.name = "length", .help = "length (m)", .number = 1, .min = 0},
    {.name = "curve", .help = "shape", .choices = "circle|ellipse|helix"},
};

std::string message_of(std::string_view key, std::string_view value) {
  Parameters p(declared, "model chain");
  try {
    p.set(key, value);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Parameters, DefaultsComeFromTheDeclaration) {
  const Parameters p(declared, "model chain");
  EXPECT_EQ(p.whole("links"), 10);
  EXPECT_EQ(p.number("length"), 1.0);
  EXPECT_EQ(p.word("curve"), "circle");
}

TEST(Parameters, SetReplacesADefault) {
  Parameters p(declared, "model chain");
  p.set("links", "25");
  p.set("curve", "helix");
  EXPECT_EQ(p.whole("links"), 25);
  EXPECT_EQ(p.word("curve"), "helix");
}

TEST(Parameters, BadInputNamesPlaceAndRemedy) {
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(message_of("linkz", "3"),
              AllOf(HasSubstr("model chain"), HasSubstr("did you mean 'links'")));
  EXPECT_THAT(message_of("links", "0"), HasSubstr("between 1 and"));
  EXPECT_THAT(message_of("links", "2.5"), HasSubstr("whole number"));
  EXPECT_THAT(message_of("length", "nan"), HasSubstr("not a finite number"));
  EXPECT_THAT(message_of("length", "-1"), HasSubstr("out of range"));
  EXPECT_THAT(message_of("length", "1m"), HasSubstr("not a finite number"));
  EXPECT_THAT(message_of("curve", "square"), HasSubstr("circle, ellipse, helix"));
}

/// Whole numbers from 2^53 on share their double with others: which one was meant is not
/// known any more. Below the least double there is 0; what is beyond the largest is
/// refused.
TEST(Parameters, AreNotRounded) {
  constexpr Parameter any[] = {
      {.name = "seed", .help = "a seed", .whole = true},
      {.name = "x", .help = "a number"},
  };
  Parameters p(any, "test");
  p.set("seed", "9007199254740991");
  EXPECT_EQ(p.number("seed"), 9007199254740991);
  for (const char* rounded : {"9007199254740993", "9007199254740992", "-1e300"}) {
    try {
      p.set("seed", rounded);
      ADD_FAILURE() << rounded;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("is too large"));
      EXPECT_THAT(error.what(), testing::HasSubstr("at most 9007199254740991"));
    }
  }
  p.set("x", "1e-400");
  EXPECT_EQ(p.number("x"), 0);
  EXPECT_THROW(p.set("x", "1e400"), InputError);
}

}  // namespace tress::test_parameters
