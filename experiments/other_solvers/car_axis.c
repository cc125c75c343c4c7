/* Source: Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem caraxis;
 * differences from it: models/published/car_axis.cpp. */
#include <math.h>
#include <string.h>

#include "problems.h"

/* Car axis. */
static const double axle_mass = 1e-2 * 1e-2 * 10 / 2, spring = .5, bump = .1,
                    frequency = 10;

/* Right end of the road and two derivatives: x, y, x', y', x'', y''. */
static void road(double t, double* r) {
  r[1] = bump * sin(frequency * t);
  r[3] = bump * frequency * cos(frequency * t);
  r[5] = -frequency * frequency * r[1];
  r[0] = sqrt(1 - r[1] * r[1]);
  r[2] = -r[1] * r[3] / r[0];
  r[4] = -(r[3] * r[3] + r[1] * r[5] + r[2] * r[2]) / r[0];
}

static void start(double* q, double* v) {
  const double q0[4] = {0, spring, 1, spring};
  memcpy(q, q0, sizeof q0);
  memset(v, 0, sizeof q0);
  v[0] = v[2] = -spring * bump * frequency;
}

static void mass(const double* q, double* m) {
  (void)q;
  memset(m, 0, 16 * sizeof *m);
  for (int i = 0; i < 4; ++i) m[5 * i] = axle_mass;
}

static void force(double t, const double* q, const double* v, double* f) {
  double r[6];
  road(t, r);
  const double left = hypot(q[0], q[1]), dx = q[2] - r[0], dy = q[3] - r[1];
  const double right = hypot(dx, dy);
  (void)v;
  f[0] = (spring - left) / left * q[0];
  f[1] = (spring - left) / left * q[1] - axle_mass;
  f[2] = (spring - right) / right * dx;
  f[3] = (spring - right) / right * dy - axle_mass;
}

static void constraint(double t, const double* q, double* g) {
  double r[6];
  road(t, r);
  const double dx = q[0] - q[2], dy = q[1] - q[3];
  g[0] = q[0] * r[0] + q[1] * r[1];
  g[1] = dx * dx + dy * dy - 1;
}

static void gradient(double t, const double* q, double* g) {
  double r[6];
  road(t, r);
  g[0] = r[0];
  g[1] = r[1];
  g[2] = g[3] = 0;
  g[4] = 2 * (q[0] - q[2]);
  g[5] = 2 * (q[1] - q[3]);
  g[6] = -g[4];
  g[7] = -g[5];
}

static void constraint_rate(double t, const double* q, double* rate) {
  double r[6];
  road(t, r);
  rate[0] = r[2] * q[0] + r[3] * q[1];
  rate[1] = 0;
}

static void bias(double t, const double* q, const double* v, double* b) {
  double r[6];
  road(t, r);
  const double dx = v[0] - v[2], dy = v[1] - v[3];
  b[0] = 2 * (r[2] * v[0] + r[3] * v[1]) + r[4] * q[0] + r[5] * q[1];
  b[1] = 2 * (dx * dx + dy * dy);
}

static const double q_size[4] = {.05, .5, 1, .5};
static const double v_size[4] = {.5, .1, .5, 1};

const Problem car_axis = {
    "car_axis", 4,     2,    3,     5e-3,       10,       q_size,
    v_size,     start, mass, force, constraint, gradient, constraint_rate,
    bias};
