/* Source: Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem crank;
 * differences from it: models/published/slider_crank.cpp. */
#include <math.h>
#include <string.h>

#include "problems.h"

static double square(double x) { return x * x; }

/* Slider crank with a flexible connecting rod. */
#define PI 3.14159265358979323846
static const double l1 = .15, l2 = .30, crank_inertia = .002727,
                    rod_inertia = .0045339259;
static const double rod_mass2 = .151104, block_mass = .075552, youngs_modulus = .20e12,
                    section = .0080 * .0080, height = .0080, density = 7870,
                    drive_rate = 150;

/* Elastic mass (kg), stiffness (N/m), gyroscopic coupling (m^3) and the vectors of the
 * rod. */
typedef struct {
  double mass[4][4], stiffness[4][4], gyroscopic[4][4], c1[4], c2[4], c12[4], c21[4];
} Rod;

static Rod rod(void) {
  const double volume = section * l2, mass = density * volume;
  const double axial = youngs_modulus * section / l2;
  const double slender = square(height / l2) * PI * PI * PI * PI, pi3 = PI * PI * PI;
  const double b13 = -volume * 16 / pi3, b14 = volume * (8 / pi3 - 1 / PI),
               b24 = volume * .5 / PI;
  const Rod r = {
      {{mass * .5}, {0, mass * .5}, {0, 0, mass * 8, mass}, {0, 0, mass, mass * 2}},
      {{axial * slender / 24},
       {0, axial * slender * 2 / 3},
       {0, 0, axial * 16 / 3, -axial * 8 / 3},
       {0, 0, -axial * 8 / 3, axial * 7 / 3}},
      {{0, 0, b13, b14}, {0, 0, 0, b24}, {-b13}, {-b14, -b24}},
      {0, 0, volume * 2 / 3, volume / 6},
      {volume * 2 / PI},
      {0, 0, l2 * volume / 3, l2 * volume / 6},
      {l2 * volume / PI, -l2 * volume * .5 / PI}};
  return r;
}

static double dot4(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static void start(double* q, double* v) {
  const double q0[7] = {0, 0, 0, 0, 0, .103339863e-4, .169327969e-4};
  const double v0[7] = {drive_rate,    0, 0, .444896105, .463434311e-2, -.178591076e-5,
                        -.268938672e-5};
  memcpy(q, q0, sizeof q0);
  memcpy(v, v0, sizeof v0);
  q[2] = l1 + l2 + q[6];
  v[1] = -l1 * drive_rate / (l2 + q[6]);
  v[2] = v[6];
}

static void mass(const double* q, double* m) {
  const Rod b = rod();
  const double *x = q + 3, c = cos(q[0] - q[1]), s = sin(q[0] - q[1]);
  memset(m, 0, 49 * sizeof *m);
  m[0] = crank_inertia + rod_mass2 * l1 * l1;
  m[1] = m[7] = (.5 * l1 * l2 * rod_mass2 + density * l1 * dot4(b.c1, x)) * c +
                density * l1 * dot4(b.c2, x) * s;
  m[8] = rod_inertia + 2 * density * dot4(b.c12, x);
  m[16] = block_mass;
  for (int i = 0; i < 4; ++i) {
    m[8] += x[i] * dot4(b.mass[i], x);
    m[3 + i] = m[7 * (3 + i)] = density * l1 * (b.c2[i] * c - b.c1[i] * s);
    m[10 + i] = m[7 * (3 + i) + 1] = density * (b.c21[i] - dot4(b.gyroscopic[i], x));
    for (int j = 0; j < 4; ++j) m[7 * (3 + i) + 3 + j] = b.mass[i][j];
  }
}

static void force(double t, const double* q, const double* v, double* f) {
  const Rod b = rod();
  const double *x = q + 3, *y = v + 3, c = cos(q[0] - q[1]), s = sin(q[0] - q[1]);
  const double lever = (.5 * l1 * l2 * rod_mass2 + density * l1 * dot4(b.c1, x)) * s -
                       density * l1 * dot4(b.c2, x) * c;
  double growth = density * dot4(b.c12, y);
  (void)t;
  for (int i = 0; i < 4; ++i) growth += y[i] * dot4(b.mass[i], x);
  f[0] = -v[1] * v[1] * lever -
         2 * density * l1 * v[1] * (c * dot4(b.c1, y) + s * dot4(b.c2, y));
  f[1] = -2 * v[1] * growth + v[0] * v[0] * lever;
  f[2] = 0;
  for (int i = 0; i < 4; ++i) {
    f[3 + i] = v[1] * v[1] * (dot4(b.mass[i], x) + density * b.c12[i]) +
               density * (l1 * v[0] * v[0] * (b.c1[i] * c + b.c2[i] * s) +
                          2 * v[1] * dot4(b.gyroscopic[i], y)) -
               dot4(b.stiffness[i], x);
  }
}

static void constraint(double t, const double* q, double* g) {
  const double reach = l2 + q[6];
  g[0] = l1 * sin(q[0]) + reach * sin(q[1]);
  g[1] = q[2] - l1 * cos(q[0]) - reach * cos(q[1]);
  g[2] = q[0] - drive_rate * t;
}

static void gradient(double t, const double* q, double* g) {
  const double reach = l2 + q[6];
  (void)t;
  memset(g, 0, 21 * sizeof *g);
  g[0] = l1 * cos(q[0]);
  g[1] = reach * cos(q[1]);
  g[6] = sin(q[1]);
  g[7] = l1 * sin(q[0]);
  g[8] = reach * sin(q[1]);
  g[9] = 1;
  g[13] = -cos(q[1]);
  g[14] = 1;
}

static void drive(double t, const double* q, double* rate) {
  (void)t, (void)q;
  rate[0] = rate[1] = 0;
  rate[2] = -drive_rate;
}

static void bias(double t, const double* q, const double* v, double* r) {
  const double reach = l2 + q[6];
  (void)t;
  r[0] = -l1 * sin(q[0]) * v[0] * v[0] - reach * sin(q[1]) * v[1] * v[1] +
         2 * cos(q[1]) * v[1] * v[6];
  r[1] = l1 * cos(q[0]) * v[0] * v[0] + reach * cos(q[1]) * v[1] * v[1] +
         2 * sin(q[1]) * v[1] * v[6];
  r[2] = 0;
}

static const double q_size[7] = {1, .5, .3, 2e-4, 2e-5, 2e-5, 2e-5};
static const double v_size[7] = {150, 75, 50, .5, .01, 2e-3, 2e-3};

const Problem slider_crank = {"slider_crank", 7,      3,     .1,   100,   150,
                              q_size,         v_size, start, mass, force, constraint,
                              gradient,       drive,  bias};
