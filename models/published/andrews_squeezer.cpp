// Andrews' squeezing mechanism: seven planar bodies, a spring, and a drive of constant
// torque, closed by three loops that meet in one moving joint.
//
//     M(q) a - f(q, v) - G(q)^T lambda = 0,   g(q) = 0,   n = 7, m = 6
//
// q = (beta, Theta, gamma, Phi, delta, Omega, epsilon) in rad; g in m (two components of
// each closure); lambda in N, with the opposite sign to the Test Set's. Published end
// values at t = 0.03 s in references.h. Jacobian::elastic keeps M and the spring.
// Source: Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem "andrews";
// Hairer & Wanner, Solving Ordinary Differential Equations II, section VII.7.
#include <algorithm>
#include <array>
#include <cmath>

#include "contract/forms/energetics.h"
#include "contract/jacobian_choice.h"
#include "models/entry.h"
#include "models/published/dense_system.h"
#include "models/published/loop_closure.h"

namespace tress::models {
namespace {

enum Coordinate { beta, theta, gamma_angle, phi, delta, omega, epsilon, coordinates };

// Data of the Test Set, problem "andrews": masses (kg), moments of inertia (kg m^2),
// lengths (m), spring (N/m, m), drive (N m). Names are the Test Set's.
constexpr double m1 = .04325, m2 = .00365, m3 = .02373, m4 = .00706, m5 = .07050,
                 m6 = .00706, m7 = .05498;
constexpr double i1 = 2.194e-6, i2 = 4.410e-7, i3 = 5.255e-6, i4 = 5.667e-7,
                 i5 = 1.169e-5, i6 = 5.667e-7, i7 = 1.912e-5;
constexpr double xa = -.06934, ya = -.00227, xb = -.03635, yb = .03273, xc = .014,
                 yc = .072;
constexpr double d = .028, da = .0115, e = .02, ea = .01421, rr = .007, ra = .00092,
                 ss = .035, sa = .01874, sb = .01043, sc = .018, sd = .02, ta = .02308,
                 tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04,
                 fa = .01421;
constexpr double spring_stiffness = 4530, spring_length = .07785, drive_torque = .033;

constexpr double square(double x) { return x * x; }

// Two bodies hinged together, the outer one carried by `outer` and turned by `inner`:
// T = h(q_inner) (v_outer^2 + v_inner v_outer), h = c cos + s sin. The only variable part
// of the mass matrix.
struct Elbow {
  int inner;
  int outer;
  double c;
  double s;
};
constexpr std::array<Elbow, 3> elbows = {{{theta, beta, -m2* da* rr, 0},
                                          {phi, delta, 0, m4* zt*(e - ea)},
                                          {omega, epsilon, 0, -m6* u*(zf - fa)}}};

// Constant part: the diagonal, and the entry that couples each elbow's pair.
constexpr std::array<double, coordinates> diagonal = {
    m1 * square(ra) + m2 * (square(rr) + square(da)) + i1 + i2,
    m2* square(da) + i2,
    m3*(square(sa) + square(sb)) + i3,
    m4* square(e - ea) + i4,
    m4*(square(zt) + square(e - ea)) + m5*(square(ta) + square(tb)) + i4 + i5,
    m6* square(zf - fa) + i6,
    m6*(square(zf - fa) + square(u)) + m7*(square(ua) + square(ub)) + i6 + i7};

struct Mechanism {
  template <class Q, class X>
  void inertia(const Q* q, const X* x, X* r) const {
    using std::cos, std::sin;
    for (int k = 0; k < coordinates; ++k) r[k] = diagonal[k] * x[k];
    for (const Elbow& b : elbows) {
      const Q h = b.c * cos(q[b.inner]) + b.s * sin(q[b.inner]);
      r[b.outer] += 2.0 * (h * x[b.outer]) + (h + diagonal[b.inner]) * x[b.inner];
      r[b.inner] += (h + diagonal[b.inner]) * x[b.outer];
    }
  }

  template <class T>
  T spring_stretch(const T* q, T& x, T& y, T& length) const {
    using std::cos, std::sin, std::sqrt;
    x = sd * cos(q[gamma_angle]) + sc * sin(q[gamma_angle]) + (xb - xc);
    y = sd * sin(q[gamma_angle]) - sc * cos(q[gamma_angle]) + (yb - yc);
    length = sqrt(x * x + y * y);
    return length - spring_length;
  }

  template <class T>
  void elastic(const T* q, T* r) const {
    using std::cos, std::sin;
    T x, y, length;
    const T stretch = spring_stretch(q, x, y, length);
    const T pull = spring_stiffness * stretch / length;
    const T dx =
        sc * cos(q[gamma_angle]) - sd * sin(q[gamma_angle]);  // d(x, y) / d gamma
    const T dy = sd * cos(q[gamma_angle]) + sc * sin(q[gamma_angle]);
    r[gamma_angle] += pull * (x * dx + y * dy);
  }

  template <class T>
  void residual(double, const T* q, const T* v, const T* a, T* r) const {
    using std::cos, std::sin;
    inertia(q, a, r);
    for (const Elbow& b : elbows) {
      const T slope = b.s * cos(q[b.inner]) - b.c * sin(q[b.inner]);
      r[b.outer] += slope * v[b.inner] * (v[b.inner] + 2.0 * v[b.outer]);
      r[b.inner] -= slope * v[b.outer] * v[b.outer];
    }
    elastic(q, r);
    r[beta] -= drive_torque;
  }
};

constexpr auto cosine = LoopTerm::Trig::cosine;
constexpr auto sine = LoopTerm::Trig::sine;
constexpr std::array<LoopTerm, 22> closure = {{
    {0, rr, cosine, beta},
    {0, -d, cosine, beta, theta},
    {0, -ss, sine, gamma_angle},
    {1, rr, sine, beta},
    {1, -d, sine, beta, theta},
    {1, ss, cosine, gamma_angle},
    {2, rr, cosine, beta},
    {2, -d, cosine, beta, theta},
    {2, -e, sine, phi, delta},
    {2, -zt, cosine, delta},
    {3, rr, sine, beta},
    {3, -d, sine, beta, theta},
    {3, e, cosine, phi, delta},
    {3, -zt, sine, delta},
    {4, rr, cosine, beta},
    {4, -d, cosine, beta, theta},
    {4, -zf, cosine, omega, epsilon},
    {4, -u, sine, epsilon},
    {5, rr, sine, beta},
    {5, -d, sine, beta, theta},
    {5, -zf, sine, omega, epsilon},
    {5, u, cosine, epsilon},
}};
constexpr std::array<double, 6> closure_targets = {xb, yb, xa, ya, xa, ya};

// Consistent start of the Test Set (rad), at rest.
constexpr std::array<double, coordinates> start = {
    -0.0617138900142764496358948458001, 0,
    0.455279819163070380255912382449,   0.222668390165885884674473185609,
    0.487364979543842550225598953530,   -0.222668390165885884674473185609,
    1.23054744454982119249735015568};
// Sizes seen over the published run, for norms and absolute tolerances.
constexpr std::array<double, coordinates> angle_size = {1, 1, .5, .5, .5, .5, 1};  // rad
constexpr std::array<double, coordinates> speed_size = {1e3, 1e3, 20, 20,
                                                        20,  20,  20};  // rad/s

class AndrewsSqueezer final : public DenseSystem<coordinates, Mechanism>,
                              public Energetics {
 public:
  explicit AndrewsSqueezer(Jacobian jacobian)
      : DenseSystem(Mechanism{}, jacobian),
        closure_(coordinates, closure, closure_targets, /*typical_length=*/ss) {}

  Layout layout() const override { return {coordinates, closure_.count()}; }
  void initial_state(Out q, Out v) const override {
    std::copy(start.begin(), start.end(), q.begin());
    std::fill(v.begin(), v.end(), 0.0);
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::copy(angle_size.begin(), angle_size.end(), q_typ.begin());
    std::copy(speed_size.begin(), speed_size.end(), v_typ.begin());
  }

  ConstraintForm* constraint_form() override { return &closure_; }
  Energetics* energetics() override { return this; }
  Energy energy(double, In q, In v) override {
    double x, y, length;
    const double stretch = kernel().spring_stretch(q.data(), x, y, length);
    return {kinetic_energy(q, v), 0.5 * spring_stiffness * square(stretch)};
  }
  double power(double, In, In v) override { return drive_torque * v[beta]; }

 private:
  LoopClosure closure_;
};

constexpr std::array<Parameter, 1> andrews_squeezer_table = {{jacobian_parameter}};

std::unique_ptr<System> make_andrews_squeezer(const Parameters& parameters) {
  return std::make_unique<AndrewsSqueezer>(jacobian_choice(parameters));
}

}  // namespace

ModelEntry andrews_squeezer_entry() {
  return {.id = "andrews_squeezer",
          .summary = "7 angles, 6 loop closures; planar mechanism with one spring",
          .source = "Test Set for IVP Solvers 2.4, andrews",
          .parameters = andrews_squeezer_table,
          .make = make_andrews_squeezer};
}

}  // namespace tress::models
