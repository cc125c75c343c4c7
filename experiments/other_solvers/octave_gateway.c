/* What Octave calls: the functions of formulations.c as one MEX function. Prototypes are
 * declared here, so that no headers of Octave are needed.
 *
 *     gateway(problem, formulation, 0, 0)  [n; t_end; y; y'; size]
 *     gateway(t, y)                            right side
 *     gateway(t, y, y')                        residual
 *     gateway()                                evaluations
 */
#include <stddef.h>

typedef struct mxArray mxArray;
double* mxGetPr(const mxArray* array);
double mxGetScalar(const mxArray* array);
mxArray* mxCreateDoubleMatrix(size_t rows, size_t columns, int complexity);

void choose(const int* problem, const int* formulation);
void counts(double* both);
void sizes(int* n_m_y, double* t_end);
void start(double* y, double* yp, double* size);
void right_side(double t, const double* y, double* dy);
void residual(double t, const double* y, const double* yp, double* r);

void mexFunction(int results, mxArray** result, int count, const mxArray** argument) {
  int three[3];
  double t_end, both[2];
  (void)results;
  if (count == 0) {
    counts(both);
    result[0] = mxCreateDoubleMatrix(1, 1, 0);
    mxGetPr(result[0])[0] = both[0];
    return;
  }
  if (count == 4) {
    const int problem = (int)mxGetScalar(argument[0]),
              form = (int)mxGetScalar(argument[1]);
    choose(&problem, &form);
    sizes(three, &t_end);
    result[0] = mxCreateDoubleMatrix((size_t)(2 + 3 * three[2]), 1, 0);
    double* const out = mxGetPr(result[0]);
    out[0] = three[0];
    out[1] = t_end;
    start(out + 2, out + 2 + three[2], out + 2 + 2 * three[2]);
    return;
  }
  sizes(three, &t_end);
  result[0] = mxCreateDoubleMatrix((size_t)three[2], 1, 0);
  const double t = mxGetScalar(argument[0]), *const y = mxGetPr(argument[1]);
  if (count == 2) right_side(t, y, mxGetPr(result[0]));
  if (count == 3) residual(t, y, mxGetPr(argument[2]), mxGetPr(result[0]));
}
