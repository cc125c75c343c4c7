// Messages and numbers of the contract, from any bytes whatever.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "contract/decimal.h"
#include "contract/input_error.h"

namespace tress::test_printable {

TEST(Printable, IsOneLineOfValidUtf8) {
  EXPECT_EQ(printable("Größe 髪 😀"), "Größe 髪 😀");
  EXPECT_EQ(printable("a\tb\r\nc"), "a b  c");
  EXPECT_EQ(printable(std::string_view("a\0b\x1b[1m\x7f", 8)), "a\\x00b\\x1b[1m\\x7f");
  // Stray and missing continuations, overlong forms, surrogates, control characters and
  // what is beyond Unicode.
  EXPECT_EQ(printable("\xff\x80z"), "\\xff\\x80z");
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");
  EXPECT_EQ(printable("\xe0\x9f\xbf"), "\\xe0\\x9f\\xbf");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

/// The middle is lost, whole characters of it.
TEST(Printable, IsShortenedInItsMiddle) {
  const std::string text = "begin" + std::string(4000, 'x') + "end";
  const std::string line = shortened(text, 100);
  EXPECT_LE(line.size(), 100u);
  EXPECT_TRUE(line.starts_with("begin"));
  EXPECT_TRUE(line.ends_with("end"));
  std::string wide;
  for (int i = 0; i < 100; ++i) wide += "ü";
  for (std::size_t longest = 10; longest < 30; ++longest) {
    const std::string cut = shortened(wide, longest);
    EXPECT_LE(cut.size(), longest);
    EXPECT_EQ(printable(cut), cut);
  }
  EXPECT_EQ(shortened("short", 100), "short");
}

TEST(InputErrors, AreReadable) {
  const InputError error("unknown key '" + std::string(4000, 'k') + "'",
                         std::string("a\0b:1:1", 7), "use \xff");
  const std::string said = error.what();
  EXPECT_LT(said.size(), 450u);
  EXPECT_TRUE(said.ends_with("k' (a\\x00b:1:1): use \\xff")) << said;
}

TEST(Decimal, ReadsNumbersOfAnyLengthAndSize) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(decimal("0.1" + std::string(1000, '0')), 0.1);
  EXPECT_EQ(decimal(std::string(400, '0') + "7"), 7);
  EXPECT_EQ(decimal("5e-324"), 5e-324);
  EXPECT_EQ(decimal("1e-320"), 1e-320);
  EXPECT_EQ(decimal("1e-400"), 0);
  EXPECT_TRUE(std::signbit(*decimal("-1e-400")));
  EXPECT_EQ(decimal("0." + std::string(500, '0') + "1"), 0);
  EXPECT_EQ(decimal("1" + std::string(500, '0') + "e-900"), 0);
  EXPECT_EQ(decimal("1e-99999999999999999999"), 0);
  EXPECT_EQ(decimal("1e400"), infinite);
  EXPECT_EQ(decimal("-1e400"), -infinite);
  EXPECT_EQ(decimal("1" + std::string(500, '0') + "e-10"), infinite);
  EXPECT_EQ(decimal("0." + std::string(500, '0') + "1e900"), infinite);
  EXPECT_EQ(decimal("1e99999999999999999999"), infinite);
  for (const char* other : {"", "-", "1 ", "1,5", "0x1", "1e", "e1", "--1"}) {
    EXPECT_EQ(decimal(other), std::nullopt) << other;
  }
}

}  // namespace tress::test_printable
