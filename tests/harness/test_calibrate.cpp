#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/calibrate/oscillation_fit.h"
#include "experiments/calibrate/records.h"
#include "experiments/numerics/tip_signal.h"
#include "simulation/files/files.h"
#include "simulation/fit/least_squares.h"

namespace tress::test_calibrate {

using namespace experiments;
using namespace experiments::calibrate;

using testing::AllOf;
using testing::HasSubstr;

// ---- records ----------------------------------------------------------------------

TEST(Records, ALabelThatChangesBeginsAnother) {
  const Records records = parse_records(
      "t_s,amplitude_m,sigma_m,length_m,record\n"
      "0,1,0.1,0.06,a\n1,2,0.1,0.06,a\n2,3,0.1,0.06,a\n3,4,0.1,0.06,a\n4,5,0.1,0.06,a\n"
      "0,6,0.2,0.06,b\n1,7,0.2,0.06,b\n2,8,0.2,0.06,b\n3,9,0.2,0.06,b\n4,-1,0.2,0.06,b\n",
      "x.csv", Observed::displacement);
  ASSERT_EQ(records.all.size(), 2u);
  EXPECT_EQ(records.points(), 10u);
  const Record& second = records.all[1];
  EXPECT_EQ(second.t, (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(second.value, (std::vector<double>{6, 7, 8, 9, -1}));
  EXPECT_EQ(second.sigma, std::vector<double>(5, 0.2));
  ASSERT_EQ(second.of_strand.size(), 1u);
  EXPECT_EQ(second.of_strand[0].key, "length_m");
  EXPECT_EQ(second.of_strand[0].value, "0.06");
  EXPECT_EQ(second.of_strand[0].where, "x.csv:7:9");
}

struct BadRecords {
  std::string name, text, problem, place, remedy;
  Observed observed = Observed::displacement;
};
void PrintTo(const BadRecords& bad, std::ostream* out) { *out << bad.name; }

class BadRecordsTest : public testing::TestWithParam<BadRecords> {};

/// All that reading does before anything runs.
void read(const BadRecords& bad) {
  const Records records = parse_records(bad.text, "x.csv", bad.observed);
  const ModelEntry& model = find_model("super_helix");
  const Parameters parameters(setup_parameters(model), "model super_helix");
  static_cast<void>(strands_of(records, model, parameters, Fitted::both));
}

TEST_P(BadRecordsTest, AreRefusedWithPlaceAndRemedy) {
  const BadRecords& bad = GetParam();
  try {
    read(bad);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(bad.problem), HasSubstr(bad.place),
                                    HasSubstr(bad.remedy)));
  }
}

std::string five(const std::string& header, const std::string& tail = "") {
  std::string text = header + '\n';
  for (const char* t : {"0", "1", "2", "3", "4"}) text += t + (",1" + tail) + '\n';
  return text;
}

const BadRecords bad_records[] = {
    {"Empty", "", "empty", "(x.csv:1:1)", "give t_s,amplitude_m"},
    {"NoTime", five("t,amplitude_m"), "no column 't_s'", "(x.csv:1:1)", "give t_s"},
    {"NoAmplitude", five("t_s,x_m"), "no column 'amplitude_m'", "(x.csv:1:1)", "give"},
    {"NoPoints", "t_s,amplitude_m\n", "no points", "(x.csv:1:1)", "one line per point"},
    {"ColumnTwice", "t_s,amplitude_m,t_s\n", "twice", "(x.csv:1)", "RFC 4180"},
    {"NotANumber", "t_s,amplitude_m\n0,1\n1,nan\n", "'nan'", "(x.csv:3:3)", "a number"},
    {"Infinite", "t_s,amplitude_m\n0,1\n1,-inf\n", "finite", "(x.csv:3:3)", "a number"},
    {"Word", "t_s,amplitude_m\nzero,1\n", "'zero'", "(x.csv:2:1)", "give a number"},
    {"NoCell", "t_s,amplitude_m\n0,1\n1,\n", "''", "(x.csv:3:3)", "leave out the line"},
    {"UnitInCell", "t_s,amplitude_m\n0,1 mm\n", "'1 mm'", "(x.csv:2:3)", "a number"},
    {"CellTooMany", "t_s,amplitude_m\n0,1,2\n", "3 cells", "(x.csv:2:1)",
     "one cell for each column"},
    {"OpenQuote", "t_s,amplitude_m\n0,\"1\n", "quote", "(x.csv:3:1)", "repair"},
    {"TimeStands", "t_s,amplitude_m\n0,1\n0,1\n", "does not follow", "(x.csv:3:1)",
     "ascending"},
    {"TimeGoesBack", "t_s,amplitude_m\n1,1\n0.5,1\n", "does not follow", "(x.csv:3:1)",
     "ascending"},
    {"TimeBeforeStart", "t_s,amplitude_m\n-1,1\n", "before the start", "(x.csv:2:1)",
     "since the start"},
    {"FewPoints", "t_s,amplitude_m\n0,1\n1,1\n2,1\n3,1\n", "4 points", "(x.csv:5:1)",
     "at least 5"},
    {"FewPointsOfTheFirst",
     "t_s,amplitude_m,record\n0,1,a\n1,1,a\n0,1,b\n1,1,b\n2,1,b\n3,1,b\n4,1,b\n",
     "2 points", "(x.csv:3:1)", "at least 5"},
    {"ErrorOfZero", five("t_s,amplitude_m,sigma_m", ",0"), "not positive", "(x.csv:2:5)",
     "above 0"},
    {"EnvelopeBelowZero", "t_s,amplitude_m\n0,1\n1,-1\n", "not positive", "(x.csv:3:3)",
     "above 0", Observed::envelope},
    {"UnknownParameter", five("t_s,amplitude_m,lenght_m", ",0.1"), "lenght_m",
     "(x.csv:2:5)", "length_m"},
    {"ParameterOutOfRange", five("t_s,amplitude_m,length_m", ",-0.1"), "out of range",
     "(x.csv:2:5)", "between"},
    {"FittedAndGiven", five("t_s,amplitude_m,drag_kg_m_s", ",0.1"), "is fitted",
     "(x.csv:2:5)", "leave out the column"},
};

INSTANTIATE_TEST_SUITE_P(Calibrate, BadRecordsTest, testing::ValuesIn(bad_records),
                         [](const auto& run) { return run.param.name; });

TEST(Calibrate, BadDataIsExitCodeTwoBeforeAnyWork) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "tress_calibrate_bad";
  std::filesystem::create_directories(folder);
  const std::string data = (folder / "bad.csv").string();
  const std::string table = (folder / "table.csv").string();
  const std::string messages = (folder / "err").string();
  replace_file(data, "t_s,amplitude_m\n0,1\n1,nan\n");
  const std::string command = std::string(CALIBRATE) + " --set data=" + data + " --out " +
                              table + " 2> " + messages;
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2);
  EXPECT_THAT(read_file(messages), HasSubstr("bad.csv:3:3"));
  EXPECT_FALSE(std::filesystem::exists(table));
  std::filesystem::remove_all(folder);
}

// ---- signals ----------------------------------------------------------------------

constexpr double decay = 2, rate = 20, sampling = 1e-3;  // 1/s, rad/s, s

/// exp(-decay t) cos(rate t), and another oscillation on top.
TipSignal damped(double ripple, double ripple_rate) {
  TipSignal signal;
  for (int i = 0; i <= 1000; ++i) {
    const double t = sampling * i, c = std::exp(-decay * t);
    signal.t.push_back(t);
    signal.x.push_back(c * (std::cos(rate * t) + ripple * std::cos(ripple_rate * t)));
    signal.v.push_back(-decay * signal.x.back() -
                       c * (rate * std::sin(rate * t) +
                            ripple * ripple_rate * std::sin(ripple_rate * t)));
  }
  return signal;
}

TEST(TipSignal, DisplacementIsOnTheCubicOfTheStep) {
  const std::vector<double> times{0, 0.0005, 0.1237, 0.5, 1};
  const std::vector<double> x = displacement(damped(0, 0), times);
  // h^4/384 times the fourth derivative, at most |decay + i rate|^4.
  const double bound = std::pow(std::hypot(decay, rate), 4) * std::pow(sampling, 4) / 384;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double t = times[k];
    EXPECT_NEAR(x[k], std::exp(-decay * t) * std::cos(rate * t), bound + 1e-15) << t;
  }
}

TEST(TipSignal, EnvelopeOfOneModeIsItsExponential) {
  // Turning points are pi/rate apart, as are zeros of a velocity exp(-decay t) sin(rate
  // t + phase); only the start of a strand at rest is a turning point of x, not of this
  // x: times begin at the second swing. There x = -+ exp(-decay t) rate/r, r = |decay + i
  // rate|; a swing from t - T/2 to t + T/2 with T = pi/rate is
  // exp(-decay t) rate/r cosh(decay T/2).
  const double quarter = M_PI / rate / 2;
  const double height = rate / std::hypot(decay, rate) * std::cosh(decay * quarter);
  const std::vector<double> times{0.3, 0.4321, 0.6, 0.8};
  const std::vector<double> a = envelope(damped(0, 0), times);
  ASSERT_EQ(a.size(), times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    // The time of a turning point is off by up to h^2/8 of v''/v' = 2 decay there.
    const double bound = decay * 2 * decay * sampling * sampling / 8;
    EXPECT_NEAR(a[k] / (height * std::exp(-decay * times[k])), 1, 2 * bound) << times[k];
  }
}

TEST(TipSignal, RipplesAreNoSwings) {
  const Swings smooth = swings(damped(0, 0)), rippled = swings(damped(0.1, 15 * rate));
  // Behind the last turning point of the swing, those of the ripple are all there is.
  ASSERT_GE(rippled.half.size(), smooth.half.size());
  for (std::size_t i = 1; i < smooth.half.size(); ++i) {
    // The ripple moves both ends of a swing of two by at most a tenth of their size.
    EXPECT_NEAR(rippled.half[i] / smooth.half[i], 1, 0.15);
  }
}

TEST(TipSignal, EnvelopeIsEmptyWithoutSwings) {
  TipSignal creeping;
  for (int i = 0; i < 10; ++i) {
    creeping.t.push_back(i);
    creeping.x.push_back(std::exp(-i));
    creeping.v.push_back(-std::exp(-i));
  }
  EXPECT_TRUE(envelope(creeping, std::vector<double>{1, 2}).empty());
}

// ---- least squares ----------------------------------------------------------------

/// y = 2 - 3 t at ten even times, with normal errors of standard deviation 0.1.
LeastSquares straight_line(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, 0.1);
  std::vector<double> y;
  y.reserve(10);
  for (int k = 0; k < 10; ++k) y.push_back(2 - 3 * (k - 4.5) + error(random));
  const ResidualAt residual = [&](In x, Out r) {
    for (std::size_t k = 0; k < 10; ++k) {
      r[k] = y[k] - x[0] - x[1] * (static_cast<double>(k) - 4.5);
    }
    return true;
  };
  return least_squares(residual, std::vector<double>{0, 0}, 10, 1e-3, 1e-9);
}

// Of a straight line over t - mean(t): variances s^2/10 and s^2/sum (t - mean)^2 =
// s^2/82.5.
TEST(LeastSquares, HalfIntervalsAreStudentsOfAStraightLine) {
  const LeastSquares fit = straight_line(1);
  double squares = 0;
  for (const double r : fit.residual) squares += r * r;
  const double s = std::sqrt(squares / 8);
  constexpr double two_sided_95 = 2.306004, two_sided_99 = 3.355387;  // 8 degrees
  const std::vector<double> half = fit.half_intervals(8, 0.95);
  EXPECT_NEAR(half[0], two_sided_95 * s / std::sqrt(10), 1e-6 * half[0]);
  EXPECT_NEAR(half[1], two_sided_95 * s / std::sqrt(82.5), 1e-6 * half[1]);
  EXPECT_NEAR(fit.half_intervals(8, 0.99)[0], two_sided_99 * s / std::sqrt(10),
              1e-6 * fit.half_intervals(8, 0.99)[0]);
}

// The truth is inside as often as is said: of 2000 fits 1900 +- 9.7 (binomial), within
// four of these. The quantile of one side only would have 1800, four times the variance
// 1998.
TEST(LeastSquares, IntervalsHoldTheTruthAsOftenAsTheySay) {
  int inside[2] = {0, 0};
  constexpr int fits = 2000;
  for (unsigned seed = 1; seed <= fits; ++seed) {
    const LeastSquares fit = straight_line(seed);
    const std::vector<double> half = fit.half_intervals(8, 0.95);
    const double truth[2] = {2, -3};
    for (std::size_t j = 0; j < 2; ++j) {
      inside[j] += std::abs(fit.x[j] - truth[j]) <= half[j] ? 1 : 0;
    }
  }
  for (const int held : inside) EXPECT_NEAR(held, 0.95 * fits, 4 * 9.75);
}

TEST(LeastSquares, AStraightLineIsTheTextbooks) {
  // y = a + b u at u = -1, 0, 1: (J^T J)^-1 = diag(1/3, 1/2).
  const double u[] = {-1, 0, 1}, y[] = {1, 2, 6};
  const ResidualAt residual = [&](In x, Out r) {
    for (std::size_t i = 0; i < 3; ++i) r[i] = y[i] - x[0] - x[1] * u[i];
    return true;
  };
  const LeastSquares fit =
      least_squares(residual, std::vector<double>{1, 1}, 3, 1e-3, 1e-9);
  EXPECT_EQ(fit.failure, "");
  EXPECT_NEAR(fit.x[0], 3, 1e-9);
  EXPECT_NEAR(fit.x[1], 2.5, 1e-9);
  // Differences of a straight line are exact up to 1e-16/1e-3.
  EXPECT_NEAR(fit.covariance[0], 1. / 3, 1e-12);
  EXPECT_NEAR(fit.covariance[1], 0, 1e-12);
  EXPECT_NEAR(fit.covariance[3], 1. / 2, 1e-12);
  EXPECT_NEAR(fit.condition, std::sqrt(1.5), 1e-12);
  const std::vector<double> more{1, 0, 0};  // y_0 is larger by 1
  std::vector<double> r = fit.residual;
  for (std::size_t i = 0; i < 3; ++i) r[i] += more[i];
  EXPECT_NEAR(fit.step(r)[0], 1. / 3, 1e-8);
  EXPECT_NEAR(fit.step(r)[1], -1. / 2, 1e-8);
}

TEST(LeastSquares, StaysOutOfWhereThereIsNothing) {
  // From x = 3 the first step of Newton's, to -3/2 + ..., has no logarithm.
  const ResidualAt residual = [](In x, Out r) {
    r[0] = x[0] > 0 ? std::log(x[0]) : 0;
    r[1] = 0;
    return x[0] > 0;
  };
  const LeastSquares fit = least_squares(residual, std::vector<double>{3}, 2, 1e-4, 1e-9);
  EXPECT_EQ(fit.failure, "");
  EXPECT_NEAR(fit.x[0], 1, 1e-8);
}

TEST(LeastSquares, HasNoCovarianceWithoutFullRank) {
  const ResidualAt residual = [](In x, Out r) {
    for (std::size_t i = 0; i < 3; ++i) r[i] = static_cast<double>(i) - (x[0] + x[1]);
    return true;
  };
  const LeastSquares fit =
      least_squares(residual, std::vector<double>{1, 1}, 3, 1e-3, 1e-9);
  EXPECT_TRUE(fit.covariance.empty());
  EXPECT_TRUE(std::isinf(fit.condition));
}

TEST(LeastSquares, ExceptionsComeThrough) {
  const ResidualAt residual = [](In, Out) -> bool { throw InputError("a", "b", "c"); };
  EXPECT_THROW((void)least_squares(residual, std::vector<double>{1}, 3, 1e-3, 1e-9),
               InputError);
}

}  // namespace tress::test_calibrate
