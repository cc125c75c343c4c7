/* Source: Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem beam;
 * differences from it: models/published/beam.cpp. */
#include <math.h>
#include <string.h>

#include "problems.h"

/* The Beam: 40 rigid segments. Accelerations follow from two sweeps, so M = 1 and f = a
 * here. */
enum { n = 40 };
static const double load = 1.5, half_turn = 3.14159265358979323846;

static void start(double* q, double* v) {
  memset(q, 0, n * sizeof *q);
  memset(v, 0, n * sizeof *v);
}

static void mass(const double* q, double* m) {
  (void)q;
  memset(m, 0, n * n * sizeof *m);
  for (int l = 0; l < n; ++l) m[n * l + l] = 1;
}

static double diagonal(int l) { return 2.0 - (l == 0) + (l + 1 == n); }

/* Sum of the entries before and after entry l. */
static double neighbours(const double* x, int l) {
  return (l > 0 ? x[l - 1] : 0) + (l + 1 < n ? x[l + 1] : 0);
}

/* Internal forces N_l over s^2: their part across each segment follows from the balance
 * of torques, their axial part from a tridiagonal system. */
static void force(double t, const double* q, const double* v, double* a) {
  const double s = 1.0 / n, push = t > half_turn ? 0 : load * sin(t) * sin(t);
  double c[n], sn[n], nx[n], ny[n], axial[n], pivot[n];
  for (int l = 0; l < n; ++l) {
    c[l] = cos(q[l]);
    sn[l] = sin(q[l]);
    const double bend = 2.0 + (l == 0) - (l + 1 == n);
    const double torque = (bend * q[l] - neighbours(q, l)) / s;
    const double across = (push * (sn[l] + c[l]) - torque / s) / (s * s);
    nx[l] = -across * sn[l];
    ny[l] = across * c[l];
  }
  for (int l = 0; l < n; ++l) {
    axial[l] = -v[l] * v[l] + c[l] * neighbours(nx, l) + sn[l] * neighbours(ny, l);
    pivot[l] = diagonal(l);
  }
  for (int l = 1; l < n; ++l) {
    const double overlap = c[l] * c[l - 1] + sn[l] * sn[l - 1],
                 ratio = overlap / pivot[l - 1];
    pivot[l] -= ratio * overlap;
    axial[l] += ratio * axial[l - 1];
  }
  for (int l = n - 1; l >= 0; --l) {
    if (l + 1 < n) axial[l] += (c[l] * c[l + 1] + sn[l] * sn[l + 1]) * axial[l + 1];
    axial[l] /= pivot[l];
  }
  for (int l = 0; l < n; ++l) {
    nx[l] += axial[l] * c[l];
    ny[l] += axial[l] * sn[l];
  }
  for (int l = 0; l < n; ++l) {
    const double dx = diagonal(l) * nx[l] - neighbours(nx, l);
    const double dy = diagonal(l) * ny[l] - neighbours(ny, l);
    a[l] = -sn[l] * dx + c[l] * dy;
  }
}

#define ONES 1, 1, 1, 1, 1, 1, 1, 1, 1, 1
static const double q_size[n] = {ONES, ONES, ONES, ONES};
static const double v_size[n] = {ONES, ONES, ONES, ONES};

const Problem beam = {"beam", 40,   0,     5, 1, 1, q_size, v_size,
                      start,  mass, force, 0, 0, 0, 0};
