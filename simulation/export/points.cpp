#include <gsl/gsl_spline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "contract/input_error.h"
#include "math/quaternion.h"
#include "simulation/scene/directions.h"
#include "simulation/scene/shapes.h"

namespace tress::simulation {
namespace {

constexpr double least = 1e-9;        // m between two points
constexpr std::size_t most = 10'000;  // points
constexpr int fine = 16;  // steps of a numerical integral between two points or joints

/// Natural cubic splines of the three components over the length of the polyline.
class Curve {
 public:
  Curve(std::span<const double> points, const std::string& where) {
    const std::size_t n = points.size() / 3;
    if (n < 3 || n > most) {
      throw InputError("a curve through " + std::to_string(n) + " points", where,
                       "give 3 to " + std::to_string(most) + " points");
    }
    std::array<std::vector<double>, 3> x;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec step = i == 0 ? Vec{} : load3(&points[3 * i]) - load3(&points[3 * i - 3]);
      u_.push_back(i == 0 ? 0 : u_.back() + norm(step));
      if (i > 0 && !(u_[i] - u_[i - 1] >= least)) {
        throw InputError("points " + std::to_string(i) + " and " + std::to_string(i + 1) +
                             " are less than 1 nm apart",
                         where, "leave one of them out");
      }
      for (std::size_t k = 0; k < 3; ++k) x[k].push_back(points[3 * i + k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      spline_[k].reset(gsl_spline_alloc(gsl_interp_cspline, n));
      gsl_spline_init(spline_[k].get(), u_.data(), x[k].data(), n);
    }
  }

  const std::vector<double>& knots() const { return u_; }
  Vec position(double u) const { return by(gsl_spline_eval, u); }
  Vec rate(double u) const { return by(gsl_spline_eval_deriv, u); }
  Vec tangent(double u) const {
    const Vec r = rate(u);
    return 1 / norm(r) * r;
  }

 private:
  Vec by(double (*evaluate)(const gsl_spline*, double, gsl_interp_accel*),
         double u) const {
    u = std::clamp(u, u_.front(), u_.back());
    return {evaluate(spline_[0].get(), u, nullptr),
            evaluate(spline_[1].get(), u, nullptr),
            evaluate(spline_[2].get(), u, nullptr)};
  }

  struct Free {
    void operator()(gsl_spline* s) const { gsl_spline_free(s); }
  };
  std::vector<double> u_;
  std::array<std::unique_ptr<gsl_spline, Free>, 3> spline_;
};

/// Arc length at some parameters of a curve (Simpson's rule between them).
struct Lengths {
  std::vector<double> u, s{0};

  explicit Lengths(const Curve& curve) {
    const std::vector<double>& knots = curve.knots();
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      for (int j = 0; j < fine; ++j) {
        u.push_back(std::lerp(knots[i], knots[i + 1], static_cast<double>(j) / fine));
      }
    }
    u.push_back(knots.back());
    for (std::size_t i = 1; i < u.size(); ++i) {
      const double middle = norm(curve.rate((u[i - 1] + u[i]) / 2));
      const double ends = norm(curve.rate(u[i - 1])) + norm(curve.rate(u[i]));
      s.push_back(s.back() + (u[i] - u[i - 1]) * (ends + 4 * middle) / 6);
    }
  }

  double parameter(double length) const {
    const auto after =
        std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(s, length) - s.begin(), 1,
                                   static_cast<std::ptrdiff_t>(s.size()) - 1);
    const auto j = static_cast<std::size_t>(after), i = j - 1;
    return std::lerp(u[i], u[j], (length - s[i]) / (s[j] - s[i]));
  }
};

/// e1 carried from one point of a curve to the next by reflecting it twice.
Vec carried(const Vec& e1, const Vec& step, const Vec& tangent, const Vec& next) {
  const auto reflected = [](const Vec& x, const Vec& normal) {
    const double square = dot(normal, normal);
    return square > 0 ? x - 2 * dot(normal, x) / square * normal : x;
  };
  return across(next, reflected(reflected(e1, step), next - reflected(tangent, step)));
}

/// The rotation vector from frame f to g, in components of either.
Vec turn(const Frame& f, const Frame& g) {
  Quaternion q = quaternion_of({f.back(g.e0), f.back(g.e1), f.back(g.e2)});
  if (q.w < 0) q = -1.0 * q;
  const double sine = norm(q.v);
  return sine > 0 ? 2 * std::atan2(sine, q.w) / sine * q.v : Vec{};
}

}  // namespace

PointCurve through_points(std::span<const double> points, int elements, double grading,
                          Vec normal, const std::string& where) {
  const Curve curve(points, where);
  const Lengths lengths(curve);
  PointCurve made;
  made.length = lengths.s.back();
  made.position = curve.position(0);
  const Vec start = curve.tangent(0);
  const Vec e1 = across(start, normal);
  if (!is_finite(start) || dot(e1, e1) == 0) {
    throw InputError("normal is along the curve at its first point", where,
                     "give another normal");
  }
  made.frame = frame_of(start, e1);

  // Joints of a straight strand with the same discretisation.
  const Strand cut =
      make_strand({}, {}, {elements, made.length, grading}, [](double) { return Vec{}; });
  std::vector<double> ends;
  std::vector<Vec> darboux;
  Frame frame = made.frame;
  double from = 0, u = 0;
  for (const Segment& segment : cut.segments) {
    const double to = from + segment.length;
    Frame at = frame;
    double wound = 0;
    for (int j = 1; j <= fine; ++j) {
      const double next =
          lengths.parameter(std::lerp(from, to, static_cast<double>(j) / fine));
      const Vec tangent = curve.tangent(next);
      wound += std::acos(std::clamp(dot(at.e0, tangent), -1.0, 1.0));
      at = frame_of(tangent, carried(at.e1, curve.position(next) - curve.position(u),
                                     at.e0, tangent));
      u = next;
    }
    if (!(wound < std::numbers::pi)) {
      throw InputError("the points wind by more than half a turn in one element", where,
                       "give more elements, or fewer points");
    }
    darboux.push_back(1 / segment.length * turn(frame, at));
    ends.push_back(to);
    frame = at;
    from = to;
  }
  made.shape = [ends, darboux](double s) {
    const auto i =
        static_cast<std::size_t>(std::ranges::upper_bound(ends, s) - ends.begin());
    return darboux[std::min(i, darboux.size() - 1)];
  };
  return made;
}

}  // namespace tress::simulation
