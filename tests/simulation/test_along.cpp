// Properties that vary along a strand: frequency and sag of tapered cantilevers against a
// Ritz method and integrals that share no code with the models, and what is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "contract/input_error.h"
#include "experiments/numerics/dense_algebra.h"
#include "models/catalogue.h"
#include "simulation/head/no_head.h"
#include "simulation/scene/scene.h"
#include "tests/support/refusal.h"
#include "tests/support/small_motion.h"

namespace tress::test_along {

using namespace simulation;
using testing_support::frequency;
using testing_support::refusal;
using testing_support::system_of;
using testing_support::tip_moved;

constexpr double length = 0.1, radius = 1e-4, youngs = 3e9, density = 1300;

std::string text_of(const std::string& model, int elements, const std::string& strand,
                    const std::string& rest = "") {
  return "title = \"taper\"\n[model]\nid = \"" + model +
         "\"\n[integrator]\nid = \"backward_euler\"\n[material]\nname = \"custom\"\n"
         "radius_m = 1e-4\nyoungs_modulus_pa = 3e9\npoisson_ratio = 0.45\n"
         "density_kg_m3 = 1300\n[strand]\nlength_m = 0.1\nelements = " +
         std::to_string(elements) + "\n" + strand + "\n" + rest;
}
Scene scene_of(const std::string& text) { return parse_scene(text, "along.toml"); }

/// A cantilever whose properties vary along it, as a scene and as functions of the share
/// of its length.
struct Varied {
  std::string name, keys;
  double (*radius)(double);   // over that of the root
  double (*modulus)(double);  // likewise
  double (*density)(double);  // likewise
  double within = 3e-3;       // error with 48 elements
};
constexpr double one(double) { return 1; }
const Varied cases[] = {
    {"taper", "radius_along = [[0, 1], [1, 0.3]]", [](double x) { return 1 - 0.7 * x; },
     one, one},
    {"soft heavy end",
     "modulus_along = [[0, 1], [1, 0.5]]\ndensity_along = [[0, 1], [1, 3]]", one,
     [](double x) { return 1 - 0.5 * x; }, [](double x) { return 1 + 2 * x; }},
    {"two pieces",
     "radius_along = [[0, 1], [0.5, 1], [0.5, 0.6]]\nmodulus_along = [[0.5, 1], [0.5, "
     "2]]",
     [](double x) { return x < 0.5 ? 1 : 0.6; },
     [](double x) { return x < 0.5 ? 1.0 : 2; }, one},
    // A cone. Its curvature is uniform, and the section in the middle of the last element
    // is not 0. At x from the tip, elements of length h have sections that are wrong by a
    // part (h/x)^2: an error of order 2 that is large near the tip.
    {"tip without section", "radius_along = [[0, 1], [1, 0]]",
     [](double x) { return 1 - x; }, one, one, 2.5e-2}};

double bending(const Varied& v, double x) {
  return youngs * v.modulus(x) * std::numbers::pi / 4 * std::pow(radius * v.radius(x), 4);
}
double line_density(const Varied& v, double x) {
  return density * v.density(x) * std::numbers::pi * std::pow(radius * v.radius(x), 2);
}

/// Integral over [from, 1] by the midpoint rule, whose error is below 1e-6 of it: jumps
/// of the cases lie between its points.
template <class F>
double integral(double from, F f) {
  constexpr int points = 2000;
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double x = from + (1 - from) * (i + 0.5) / points;
    sum += f(x) * (1 - from) / points;
  }
  return sum;
}

/// The first frequency (rad/s) of an Euler-Bernoulli cantilever by Ritz's method with
/// x^2 .. x^7 on each half, joined in value and slope; from above.
double ritz(const Varied& v) {
  // w = sum over k of c_k x^(k+2), and (x - 1/2)_+^(k+2): smooth to the first derivative.
  constexpr int powers = 5, n = 2 * powers;
  const auto at = [](int i, double x, int derivative) {
    const double base = i < powers ? x : std::max(0.0, x - 0.5);
    const int p = i % powers + 2;
    return derivative == 0 ? std::pow(base, p)
           : base == 0     ? (i < powers && p == 2 ? 2.0 : 0.0)
                           : p * (p - 1) * std::pow(base, p - 2);
  };
  Eigen::Matrix<double, n, n> k, m;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      k(i, j) = integral(0, [&](double x) {
        return bending(v, x) * at(i, x, 2) * at(j, x, 2) / std::pow(length, 3);
      });
      m(i, j) = integral(0, [&](double x) {
        return line_density(v, x) * at(i, x, 0) * at(j, x, 0) * length;
      });
    }
  }
  return std::sqrt(experiments::symmetric_eigenpairs(k, m).values[0]);
}

/// The sag of the tip (m) under a weight of acceleration g, straight beam theory.
double sag(const Varied& v, double g) {
  return integral(0, [&](double x) {
    const double moment = integral(
        x, [&](double u) { return line_density(v, u) * g * (u - x) * length * length; });
    return moment * (1 - x) * length * length / bending(v, x);
  });
}

/// Models without constraints, with derivatives of their own.
bool takes_part(const ModelEntry& model) {
  return model.on_strand != nullptr && model.id != "inextensible_strand" &&
         model.id != "dynamic_spline" && model.id != "force_transport";
}

/// Errors with 24 and 48 elements: small with 48, and order 2 where they exceed 1e-4.
void expect_order_two(double coarse, double fine, const Varied& v,
                      std::string_view model) {
  const std::string what = v.name + ", " + std::string(model);
  std::printf("%s: %.1e with 24, %.1e with 48\n", what.c_str(), coarse, fine);
  EXPECT_LE(std::abs(fine), v.within);
  if (std::abs(fine) > 1e-4) {
    EXPECT_GE(std::abs(coarse / fine), 3) << what;
  }
}

TEST(Along, FrequencyIsThatOfTheVariedBeam) {
  for (const Varied& v : cases) {
    const double expected = ritz(v);
    for (const ModelEntry& model : model_catalogue()) {
      if (!takes_part(model)) continue;
      SCOPED_TRACE(v.name + " " + std::string(model.id));
      const auto off = [&](int elements) {
        const Scene scene = scene_of(text_of(std::string(model.id), elements, v.keys));
        return frequency(*system_of(scene)) / expected - 1;
      };
      expect_order_two(off(24), off(48), v, model.id);
    }
  }
}

TEST(Along, SagIsThatOfTheVariedBeam) {
  for (const Varied& v : cases) {
    const double g = 1e-3, expected = sag(v, g);
    for (const ModelEntry& model : model_catalogue()) {
      if (!takes_part(model)) continue;
      SCOPED_TRACE(v.name + " " + std::string(model.id));
      const auto off = [&](int elements) {
        const Scene scene =
            scene_of(text_of(std::string(model.id), elements, v.keys,
                             "[effects.gravity]\ngravity_m_s2 = [0, 0, -1e-3]\n"));
        return -tip_moved(*system_of(scene)).z / expected - 1;
      };
      expect_order_two(off(24), off(48), v, model.id);
    }
  }
}

/// Internal friction follows the bending stiffness: one damping time for all segments.
TEST(Along, DampingTimeStays) {
  const Scene scene = scene_of(
      text_of("super_helix", 10,
              "radius_along = [[0, 1], [1, 0.2]]\nellipticity_along = [[0, 1], [1, 2]]"));
  const models::Strand& strand = scene.strands.front();
  EXPECT_FALSE(strand.uniform());
  const auto time = [&](const models::Segment& segment) {
    const Vec all = stiffness(strand, segment);
    return segment.factors.friction / (all.y + all.z);
  };
  for (const models::Segment& segment : strand.segments) {
    EXPECT_NEAR(time(segment) / time(strand.segments.front()), 1, 1e-14);
  }
  const models::CrossSection& last = strand.segments.back().section;
  // In the middle of the last of ten: shares 0.95, factors 0.24 and 1.95.
  EXPECT_NEAR(std::sqrt(last.a1 * last.a2), 0.24 * radius, 1e-12 * radius);
  EXPECT_NEAR(last.a1 / last.a2, 1.95, 1e-12);
}

/// Linear between rows: a segment's mean is the value in its middle, its difference that
/// of the rows.
TEST(Along, NaturalCurvatureFollowsItsRows) {
  const Scene scene = scene_of(
      text_of("super_clothoid", 10,
              "shape = \"along\"\ndarboux_along = [[0, 1, 20, 0], [1, 3, -20, 4]]"));
  double share = 0.05;
  for (const models::Segment& segment : scene.strands.front().segments) {
    EXPECT_NEAR(segment.natural.x, 1 + 2 * share, 1e-12);
    EXPECT_NEAR(segment.natural.y, 20 - 40 * share, 1e-12);
    EXPECT_NEAR(segment.natural.z, 4 * share, 1e-12);
    EXPECT_NEAR(segment.natural_half.y, -2, 1e-12);
    share += 0.1;
  }
}

TEST(Along, RefusesWhatIsNoTable) {
  const struct {
    const char *keys, *reason;
  } bad[] = {{"radius_along = [[0.5, 1], [0.2, 1]]", "not in order along the strand"},
             {"radius_along = [[0, 1], [2, 1]]", "a row at 2 of the length"},
             {"density_along = [[0, 1], [0.5, 0], [1, 0]]", "density_along is 0"},
             {"radius_along = [[0, 1]]\nmesh = \"rest\"",
              "radius_along cannot be combined with"},
             {"modulus_along = [[0, 1]]\ntolerance_m = 1e-3",
              "modulus_along cannot be combined with a tolerance"},
             {"shape = \"along\"\ndarboux_along = []", "has no rows"},
             {"darboux_along = [[0, 0, 1, 0]]", "darboux_along"}};
  for (const auto& [keys, reason] : bad) {
    const std::string said = refusal([&] { scene_of(text_of("super_helix", 4, keys)); });
    EXPECT_NE(said.find(reason), std::string::npos) << keys << ": " << said;
  }
}

/// Kernels of lanes have one section for a strand.
TEST(Along, RunsAsABatchWithoutLanes) {
  const std::string varied = "radius_along = [[0, 1], [1, 0.5]]";
  EXPECT_FALSE(
      no_lanes(scene_of(text_of("super_helix", 4, "")), models::HeadNumber::float64));
  const auto no =
      no_lanes(scene_of(text_of("super_helix", 4, varied)), models::HeadNumber::float64);
  ASSERT_TRUE(no);
  EXPECT_NE(no->reason.find("varies along the strand"), std::string::npos);
  EXPECT_EQ(place_of(*no, "along.toml"), "along.toml:15:16");
}

/// A file of this ending and content, and the scene of its strands.
class FromFile {
 public:
  FromFile(const std::string& ending, const std::string& bytes)
      : folder_(std::filesystem::temp_directory_path() /
                fmt::format("tress_along_{}", getpid())) {
    std::filesystem::create_directories(folder_);
    file_ = folder_ / ("strands" + ending);
    std::ofstream(file_, std::ios::binary) << bytes;
  }
  ~FromFile() { std::filesystem::remove_all(folder_); }
  FromFile(const FromFile&) = delete;
  FromFile& operator=(const FromFile&) = delete;

  Scene scene(const std::string& keys = "widths = \"file\"") const {
    return scene_of(
        "title = \"widths\"\n[model]\nid = \"der\"\n[integrator]\nid = "
        "\"backward_euler\"\n[groom]\nunit = \"m\"\nup = \"z\"\nelements = 4\n"
        "mesh = \"equal\"\nfile = \"" +
        file_.string() + "\"\n" + keys + "\n");
  }

 private:
  std::filesystem::path folder_, file_;
};

double radius_of(const models::Segment& segment) {
  return std::sqrt(segment.section.a1 * segment.section.a2);
}

/// Two straight strands of three points, as a .usda with these widths.
std::string usda(const std::string& widths) {
  return "#usda 1.0\n(metersPerUnit = 1\nupAxis = \"Z\")\ndef BasisCurves \"hair\" {\n"
         "uniform token type = \"linear\"\nint[] curveVertexCounts = [3, 3]\n"
         "point3f[] points = [(0,0,0), (0,0,-0.1), (0,0,-0.2), (1,0,0), (1,0,-0.1), "
         "(1,0,-0.2)]\n" +
         widths + "}\n";
}

/// Widths at points vary linearly between them: elements of a quarter have the mean of
/// their ends. The section keeps its ellipticity.
TEST(Widths, OfAFileAreTheDiametersOfElements) {
  const FromFile points(
      ".usda",
      usda("float[] widths = [2e-4, 1e-4, 1e-4, 2e-4, 2e-4, 4e-4] (interpolation = "
           "\"vertex\")\n"));
  const Scene scene = points.scene();
  ASSERT_EQ(scene.strands.size(), 2U);
  const double expected[2][4] = {{0.875e-4, 0.625e-4, 0.5e-4, 0.5e-4},
                                 {1e-4, 1e-4, 1.25e-4, 1.75e-4}};
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      const models::Segment& segment = scene.strands[k].segments[i];
      EXPECT_NEAR(radius_of(segment) / expected[k][i], 1, 1e-6) << k << " " << i;
      EXPECT_NEAR(segment.section.a1 / segment.section.a2, 1.41, 1e-12);
    }
  }
  EXPECT_TRUE(no_lanes(scene));
  // The material's, unless the scene asks for the file's.
  EXPECT_NEAR(radius_of(points.scene("").strands[0].segments[0]), 36e-6, 1e-12);
}

TEST(Widths, OfACurveOrOfAllApplyToAllElements) {
  const FromFile curves(".usda", usda("float[] widths = [2e-4, 6e-4]\n"));
  EXPECT_NEAR(radius_of(curves.scene().strands[0].segments[3]), 1e-4, 1e-10);
  EXPECT_NEAR(radius_of(curves.scene().strands[1].segments[0]), 3e-4, 1e-10);
  const FromFile all(".usda", usda("float[] widths = [4e-4]\n"));
  EXPECT_NEAR(radius_of(all.scene().strands[1].segments[2]), 2e-4, 1e-10);
}

/// A .hair with one strand, and with an array of widths or a width in its header.
std::string hair(const std::vector<float>& widths, float width) {
  std::string bytes = "HAIR";
  const auto put = [&](auto x) {
    bytes.append(reinterpret_cast<const char*>(&x), sizeof x);  // NOLINT
  };
  const std::uint32_t arrays = widths.empty() ? 2 : 6;
  for (const std::uint32_t x : {1U, 3U, arrays, 2U}) put(x);
  put(width);
  bytes.resize(128);
  for (const float x : {0.F, 0.F, 0.F, 0.F, 0.F, -0.1F, 0.F, 0.F, -0.2F}) put(x);
  for (const float x : widths) put(x);
  return bytes;
}

TEST(Widths, OfAHairFileAreThoseOfItsPointsOrItsHeader) {
  const FromFile points(".hair", hair({2e-4F, 1e-4F, 3e-4F}, 1));
  EXPECT_NEAR(radius_of(points.scene().strands[0].segments[0]) / 0.875e-4, 1, 1e-6);
  EXPECT_NEAR(radius_of(points.scene().strands[0].segments[3]) / 1.25e-4, 1, 1e-6);
  const FromFile header(".hair", hair({}, 3e-4F));
  EXPECT_NEAR(radius_of(header.scene().strands[0].segments[2]) / 1.5e-4, 1, 1e-6);
}

TEST(Widths, AreRefusedWhereThereAreNone) {
  const auto said = [](const FromFile& file) { return refusal([&] { file.scene(); }); };
  EXPECT_NE(said({".usda", usda("")}).find("the file has no widths that can be read"),
            std::string::npos);
  EXPECT_NE(said({".hair", hair({}, 0)}).find("the file has no widths that can be read"),
            std::string::npos);
  EXPECT_NE(said({".hair", hair({1e-4F, -1e-4F, 1e-4F}, 0)}).find("width -0.0001 m"),
            std::string::npos);
  EXPECT_NE(said({".usda", usda("float[] widths = [1e-4, 1e-4, 1e-4]\n")})
                .find("the file has no widths that can be read"),
            std::string::npos);
}

}  // namespace tress::test_along
