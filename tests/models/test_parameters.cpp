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

}  // namespace tress::test_parameters
