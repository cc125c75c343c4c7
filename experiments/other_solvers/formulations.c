/* Formulations of the problems, and the entry points that the packages call.
 *
 *     ode      y = (q, v)                q' = v, v' = a; multipliers eliminated
 *     index1   y = (q, v, lambda)        q' = v, M v' = f + G^T lambda, G v' + bias = 0
 *     index2   y = (q, v, lambda, mu)    q' = v + G^T mu, M v' = f + G^T lambda,
 *                                        G v + rate = 0, g = 0 (Gear, Gupta, Leimkuhler
 * 1985) index3   y = (q, v, lambda)        q' = v, M v' = f + G^T lambda, g = 0 mass y =
 * (q, v, w, lambda)     q' = v, v' = w, 0 = M w - f - G^T lambda, 0 = g; index 3 with a
 * constant mass matrix
 *
 * A problem of first order is y = q, y' = f in every formulation.
 */
#include <math.h>
#include <string.h>

#include "problems.h"

enum { ode, index1, index2, index3, mass_form };
enum { most = max_coordinates + max_constraints, most_y = 3 * max_coordinates };

static const Problem* p = &beam;
static int form;
static long evaluations, jacobians;

void no_rate(double t, const double* q, double* rate) {
  (void)t, (void)q;
  memset(rate, 0, max_constraints * sizeof *rate);
}

/* Selects problem and formulation and sets the counters to zero. */
void choose(const int* problem, const int* formulation) {
  const Problem* const all[] = {&andrews_squeezer, &slider_crank, &car_axis, &beam,
                                &filament};
  p = all[*problem];
  form = *formulation;
  evaluations = jacobians = 0;
}

void counts(double* both) {
  both[0] = (double)evaluations;
  both[1] = (double)jacobians;
}

void sizes(int* n_m_y, double* t_end) {
  const int tails[] = {0, p->m, 2 * p->m, p->m, p->n + p->m};
  n_m_y[0] = p->n;
  n_m_y[1] = p->m;
  n_m_y[2] = p->first_order ? p->n : 2 * p->n + tails[form];
  *t_end = p->t_end;
}

/* Gaussian elimination with row exchanges; 0: the matrix is singular. */
static int eliminate(int n, double* a, double* b) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (fabs(a[n * i + k]) > fabs(a[n * best + k])) best = i;
    if (!(fabs(a[n * best + k]) > 0)) return 0;
    for (int j = k; j < n && best != k; ++j) {
      const double swap = a[n * k + j];
      a[n * k + j] = a[n * best + j];
      a[n * best + j] = swap;
    }
    const double swap = b[k];
    b[k] = b[best];
    b[best] = swap;
    for (int i = k + 1; i < n; ++i) {
      const double ratio = a[n * i + k] / a[n * k + k];
      if (ratio == 0) continue;
      for (int j = k; j < n; ++j) a[n * i + j] -= ratio * a[n * k + j];
      b[i] -= ratio * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= a[n * k + j] * b[j];
    b[k] /= a[n * k + k];
  }
  return 1;
}

/* Accelerations and multipliers from (M, -G^T; G, 0) (a, lambda) = (f, -bias). */
static void accelerate(double t, const double* q, const double* v, double* a,
                       double* lambda) {
  const int n = p->n, m = p->m, all = n + m;
  if (m == 0) {
    p->force(t, q, v, a);
    return;
  }
  double mass[max_coordinates * max_coordinates], g[max_coordinates * max_constraints];
  double matrix[most * most], x[most];
  p->mass(q, mass);
  p->gradient(t, q, g);
  p->force(t, q, v, x);
  p->bias(t, q, v, x + n);
  memset(matrix, 0, sizeof(double) * (size_t)(all * all));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) matrix[all * i + j] = mass[n * i + j];
  for (int k = 0; k < m; ++k) {
    x[n + k] = -x[n + k];
    for (int j = 0; j < n; ++j) {
      matrix[all * (n + k) + j] = g[n * k + j];
      matrix[all * j + n + k] = -g[n * k + j];
    }
  }
  if (!eliminate(all, matrix, x)) x[0] = NAN;
  memcpy(a, x, sizeof(double) * (size_t)n);
  memcpy(lambda, x + n, sizeof(double) * (size_t)m);
}

/* y and y' at the start, consistent, and the size of every entry of y. */
void start(double* y, double* yp, double* size) {
  const int n = p->n, m = p->m;
  double a[max_coordinates], lambda[max_constraints];
  if (p->first_order) {
    p->start(y, 0);
    p->force(0, y, 0, yp);
    memcpy(size, p->q_size, sizeof(double) * (size_t)n);
    return;
  }
  p->start(y, y + n);
  accelerate(0, y, y + n, a, lambda);
  double *const tail = y + 2 * n, *const tail_size = size + 2 * n;
  const int offset = form == mass_form ? n : 0;
  int ny[3];
  double t_end;
  sizes(ny, &t_end);
  memset(yp, 0, sizeof(double) * (size_t)ny[2]);
  for (int i = 0; i < n; ++i) {
    yp[i] = y[n + i];
    yp[n + i] = a[i];
    size[i] = p->q_size[i];
    size[n + i] = p->v_size[i];
    if (form != mass_form) continue;
    tail[i] = a[i];
    tail_size[i] = p->v_size[i] * p->rate;
  }
  for (int k = 0; k < m && form != ode; ++k) {
    tail[offset + k] = lambda[k];
    tail_size[offset + k] = p->lambda_size;
    if (form != index2) continue;
    tail[m + k] = 0;
    tail_size[m + k] = p->lambda_size;
  }
}

/* Right side: y' of `ode`, or K y' of `mass`. */
void right_side(double t, const double* y, double* dy) {
  const int n = p->n, m = p->m;
  double lambda[max_constraints];
  ++evaluations;
  if (p->first_order) {
    p->force(t, y, 0, dy);
    return;
  }
  memcpy(dy, y + n, sizeof(double) * (size_t)n);
  if (form != mass_form) {
    accelerate(t, y, y + n, dy + n, lambda);
    return;
  }
  const double *const w = y + 2 * n, *const multipliers = y + 3 * n;
  double mass[max_coordinates * max_coordinates], g[max_coordinates * max_constraints];
  memcpy(dy + n, w, sizeof(double) * (size_t)n);
  p->mass(y, mass);
  p->gradient(t, y, g);
  p->force(t, y, y + n, dy + 2 * n);
  for (int i = 0; i < n; ++i) {
    double sum = -dy[2 * n + i];
    for (int j = 0; j < n; ++j) sum += mass[n * i + j] * w[j];
    for (int k = 0; k < m; ++k) sum -= g[n * k + i] * multipliers[k];
    dy[2 * n + i] = sum;
  }
  p->constraint(t, y, dy + 3 * n);
}

/* F(t, y, y') = 0. */
void residual(double t, const double* y, const double* yp, double* r) {
  const int n = p->n, m = p->m;
  double mass[max_coordinates * max_coordinates], g[max_coordinates * max_constraints];
  if (form == ode || m == 0) {
    right_side(t, y, r);
    for (int i = 0; i < (p->first_order ? n : 2 * n); ++i) r[i] = yp[i] - r[i];
    return;
  }
  ++evaluations;
  const double *const v = y + n, *const lambda = y + 2 * n;
  p->mass(y, mass);
  p->gradient(t, y, g);
  p->force(t, y, v, r + n);
  for (int i = 0; i < n; ++i) {
    double balance = -r[n + i], kinematics = yp[i] - v[i];
    for (int j = 0; j < n; ++j) balance += mass[n * i + j] * yp[n + j];
    for (int k = 0; k < m; ++k) {
      balance -= g[n * k + i] * lambda[k];
      if (form == index2) kinematics -= g[n * k + i] * lambda[m + k];
    }
    r[n + i] = balance;
    r[i] = kinematics;
  }
  double* const tail = r + 2 * n;
  if (form == index3) p->constraint(t, y, tail);
  if (form == index2) p->constraint_rate(t, y, tail), p->constraint(t, y, tail + m);
  if (form == index1) p->bias(t, y, v, tail);
  if (form == index3) return;
  const double* const rate = form == index1 ? yp + n : v;
  for (int k = 0; k < m; ++k)
    for (int j = 0; j < n; ++j) tail[k] += g[n * k + j] * rate[j];
}

/* dF/dy + shift dF/dy' by one-sided differences, row-major. */
void jacobian(double t, const double* y, const double* yp, double shift, double* matrix) {
  int ny[3];
  double t_end, x[most_y], xp[most_y], at[most_y], moved[most_y], unused[most_y],
      size[most_y];
  sizes(ny, &t_end);
  const int count = ny[2];
  start(x, unused, size);
  memcpy(x, y, sizeof(double) * (size_t)count);
  memcpy(xp, yp, sizeof(double) * (size_t)count);
  residual(t, x, xp, at);
  for (int j = 0; j < count; ++j) {
    const double by = 1.5e-8 * fmax(fabs(y[j]), size[j]);
    x[j] += by;
    xp[j] += shift * by;
    residual(t, x, xp, moved);
    for (int i = 0; i < count; ++i) matrix[count * i + j] = (moved[i] - at[i]) / by;
    x[j] = y[j];
    xp[j] = yp[j];
  }
  ++jacobians;
}

/* a - acceleration(t, q, v), and its derivative with v = shift_v q, a = shift_a q. */
void second_order(double t, const double* q, const double* v, const double* a,
                  double* r) {
  double lambda[max_constraints];
  ++evaluations;
  accelerate(t, q, v, r, lambda);
  for (int i = 0; i < p->n; ++i) r[i] = a[i] - r[i];
}

void second_order_jacobian(double t, const double* q, const double* v, const double* a,
                           double shift_v, double shift_a, double* matrix) {
  const int n = p->n;
  double x[most_y], y[most_y], z[most_y], at[most_y], moved[most_y];
  memcpy(x, q, sizeof(double) * (size_t)n);
  memcpy(y, v, sizeof(double) * (size_t)n);
  memcpy(z, a, sizeof(double) * (size_t)n);
  second_order(t, x, y, z, at);
  for (int j = 0; j < n; ++j) {
    const double by = 1.5e-8 * fmax(fabs(q[j]), p->q_size[j]);
    x[j] += by;
    y[j] += shift_v * by;
    z[j] += shift_a * by;
    second_order(t, x, y, z, moved);
    for (int i = 0; i < n; ++i) matrix[n * i + j] = (moved[i] - at[i]) / by;
    x[j] = q[j];
    y[j] = v[j];
    z[j] = a[j];
  }
  ++jacobians;
}

/* Largest constraint in modulus. */
double drift(double t, const double* q) {
  double g[max_constraints], largest = 0;
  if (p->m > 0) p->constraint(t, q, g);
  for (int k = 0; k < p->m; ++k) largest = fmax(largest, fabs(g[k]));
  return largest;
}

/* The entry points of compiled models of deSolve. */
void derivs(int* count, double* t, double* y, double* dy, double* out, int* ip) {
  (void)count, (void)out, (void)ip;
  right_side(*t, y, dy);
}

void res(double* t, double* y, double* yp, double* cj, double* delta, int* ires,
         double* out, int* ip) {
  (void)cj, (void)ires, (void)out, (void)ip;
  residual(*t, y, yp, delta);
}
