/* The five published problems as plain functions, for every solver package.
 *
 *     M(q) a = f(t, q, v) + G(t, q)^T lambda,   g(t, q) = 0
 *
 * Data and signs are those of models/published. Matrices are row-major. A problem of
 * first order is q' = f(t, q), without v. */
#ifndef TRESS_OTHER_SOLVERS_PROBLEMS_H
#define TRESS_OTHER_SOLVERS_PROBLEMS_H

enum { max_coordinates = 42, max_constraints = 6 };

typedef struct {
  const char* name;
  int n;        /* coordinates */
  int m;        /* constraints */
  double t_end; /* s */
  double lambda_size;
  double rate; /* size of accelerations over size of velocities (1/s) */
  const double *q_size, *v_size;
  void (*start)(double* q, double* v);
  void (*mass)(const double* q, double* mass);
  void (*force)(double t, const double* q, const double* v, double* f);
  void (*constraint)(double t, const double* q, double* g);
  void (*gradient)(double t, const double* q, double* gradient);
  /* d g/dt = G v + rate, d^2 g/dt^2 = G a + bias */
  void (*constraint_rate)(double t, const double* q, double* rate);
  void (*bias)(double t, const double* q, const double* v, double* bias);
  int first_order;
} Problem;

extern const Problem andrews_squeezer, slider_crank, car_axis, beam, filament;

void no_rate(double t, const double* q, double* rate);

#endif
