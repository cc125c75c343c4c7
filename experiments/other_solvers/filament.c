/* Source: SciMLBenchmarks.jl, commit 054ed767, benchmarks/MOLPDE/Filament.jmd; its field
 * is planar, and so are the joints here. */
#include <math.h>
#include <string.h>

#include "problems.h"

/* The Filament: y holds x and y of 21 joints, y' = P (B y + F(t)). Equations of first
 * order: `force` is the right side, and there are no velocities. */
enum { segments = 20, joints = segments + 1, n = 2 * joints };
static const double magnetic = 32, field_rate = 200;

static void start(double* q, double* v) {
  (void)v;
  for (int i = 0; i < joints; ++i) {
    q[2 * i] = (double)i / segments;
    q[2 * i + 1] = 0;
  }
}

static void mass(const double* q, double* m) {
  (void)q;
  memset(m, 0, n * n * sizeof *m);
  for (int i = 0; i < n; ++i) m[n * i + i] = 1;
}

/* B = -(N + 1)^4 D^T D with second differences D. P removes changes of length by the
 * tensions, from a tridiagonal system. */
static void force(double t, const double* q, const double* v, double* f) {
  (void)v;
  const double stiffness = pow(joints, 4), push = joints * magnetic;
  double side[segments][2], tension[segments], pivot[segments];
  memset(f, 0, n * sizeof *f);
  f[n - 2] = push * cos(field_rate * t);
  f[n - 1] = push * sin(field_rate * t);
  f[0] = -f[n - 2];
  f[1] = -f[n - 1];
  for (int i = 0; i < segments; ++i)
    for (int k = 0; k < 2; ++k) side[i][k] = q[2 * i + 2 + k] - q[2 * i + k];
  for (int i = 1; i < segments; ++i) {
    for (int k = 0; k < 2; ++k) {
      const double turn = stiffness * (side[i][k] - side[i - 1][k]);
      f[2 * i - 2 + k] -= turn;
      f[2 * i + k] += 2 * turn;
      f[2 * i + 2 + k] -= turn;
    }
  }
  for (int i = 0; i < segments; ++i) {
    const double* const u = side[i];
    pivot[i] = 2 * (u[0] * u[0] + u[1] * u[1]);
    tension[i] = u[0] * (f[2 * i + 2] - f[2 * i]) + u[1] * (f[2 * i + 3] - f[2 * i + 1]);
    if (i == 0) continue;
    const double beside = -(u[0] * side[i - 1][0] + u[1] * side[i - 1][1]);
    const double ratio = beside / pivot[i - 1];
    pivot[i] -= ratio * beside;
    tension[i] -= ratio * tension[i - 1];
  }
  for (int i = segments - 1; i >= 0; --i) {
    if (i + 1 < segments) {
      tension[i] +=
          (side[i][0] * side[i + 1][0] + side[i][1] * side[i + 1][1]) * tension[i + 1];
    }
    tension[i] /= pivot[i];
  }
  for (int i = 0; i < segments; ++i) {
    for (int k = 0; k < 2; ++k) {
      f[2 * i + k] += tension[i] * side[i][k];
      f[2 * i + 2 + k] -= tension[i] * side[i][k];
    }
  }
}

#define ONES 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1
static const double size[n] = {ONES, ONES, ONES};

const Problem filament = {.name = "filament",
                          .n = n,
                          .t_end = .01,
                          .rate = 1,
                          .first_order = 1,
                          .q_size = size,
                          .v_size = size,
                          .start = start,
                          .mass = mass,
                          .force = force};
