/* Source: Mazzia & Magherini, Test Set for IVP Solvers, release 2.4, problem andrews;
 * differences from it: models/published/andrews_squeezer.cpp. */
#include <math.h>
#include <string.h>

#include "problems.h"

static double square(double x) { return x * x; }

/* Andrews' squeezing mechanism: 7 angles, 3 loops of 2 closures each. */
static const double m1 = .04325, m2 = .00365, m3 = .02373, m4 = .00706, m5 = .07050,
                    m6 = .00706, m7 = .05498;
static const double i1 = 2.194e-6, i2 = 4.410e-7, i3 = 5.255e-6, i4 = 5.667e-7,
                    i5 = 1.169e-5, i6 = 5.667e-7, i7 = 1.912e-5;
static const double xa = -.06934, ya = -.00227, xb = -.03635, yb = .03273, xc = .014,
                    yc = .072;
static const double d = .028, da = .0115, e = .02, ea = .01421, rr = .007, ra = .00092,
                    ss = .035, sa = .01874, sb = .01043, sc = .018, sd = .02, ta = .02308,
                    tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04,
                    fa = .01421;
static const double spring_stiffness = 4530, spring_length = .07785, drive_torque = .033;

static void start(double* q, double* v) {
  static const double start[7] = {
      -0.0617138900142764496358948458001, 0,
      0.455279819163070380255912382449,   0.222668390165885884674473185609,
      0.487364979543842550225598953530,   -0.222668390165885884674473185609,
      1.23054744454982119249735015568};
  memcpy(q, start, sizeof start);
  memset(v, 0, sizeof start);
}

static void mass(const double* q, double* m) {
  const double h1 = -m2 * da * rr * cos(q[1]), h2 = m4 * zt * (e - ea) * sin(q[3]),
               h3 = -m6 * u * (zf - fa) * sin(q[5]);
  memset(m, 0, 49 * sizeof *m);
  m[0] = m1 * square(ra) + m2 * (square(rr) + square(da)) + i1 + i2 + 2 * h1;
  m[8] = m2 * square(da) + i2;
  m[1] = m[7] = m[8] + h1;
  m[16] = m3 * (square(sa) + square(sb)) + i3;
  m[24] = m4 * square(e - ea) + i4;
  m[25] = m[31] = m[24] + h2;
  m[32] = m4 * (square(zt) + square(e - ea)) + m5 * (square(ta) + square(tb)) + i4 + i5 +
          2 * h2;
  m[40] = m6 * square(zf - fa) + i6;
  m[41] = m[47] = m[40] + h3;
  m[48] = m6 * (square(zf - fa) + square(u)) + m7 * (square(ua) + square(ub)) + i6 + i7 +
          2 * h3;
}

static void force(double t, const double* q, const double* v, double* f) {
  const double x = sd * cos(q[2]) + sc * sin(q[2]) + xb - xc;
  const double y = sd * sin(q[2]) - sc * cos(q[2]) + yb - yc;
  const double length = hypot(x, y);
  const double pull = -spring_stiffness * (length - spring_length) / length;
  const double s1 = m2 * da * rr * sin(q[1]), s2 = m4 * zt * (e - ea) * cos(q[3]),
               s3 = -m6 * u * (zf - fa) * cos(q[5]);
  (void)t;
  f[0] = drive_torque - s1 * v[1] * (v[1] + 2 * v[0]);
  f[1] = s1 * v[0] * v[0];
  f[2] = pull *
         (x * (sc * cos(q[2]) - sd * sin(q[2])) + y * (sd * cos(q[2]) + sc * sin(q[2])));
  f[3] = s2 * v[4] * v[4];
  f[4] = -s2 * v[3] * (v[3] + 2 * v[4]);
  f[5] = s3 * v[6] * v[6];
  f[6] = -s3 * v[5] * (v[5] + 2 * v[6]);
}

static void constraint(double t, const double* q, double* g) {
  const double x = rr * cos(q[0]) - d * cos(q[0] + q[1]);
  const double y = rr * sin(q[0]) - d * sin(q[0] + q[1]);
  (void)t;
  g[0] = x - ss * sin(q[2]) - xb;
  g[1] = y + ss * cos(q[2]) - yb;
  g[2] = x - e * sin(q[3] + q[4]) - zt * cos(q[4]) - xa;
  g[3] = y + e * cos(q[3] + q[4]) - zt * sin(q[4]) - ya;
  g[4] = x - zf * cos(q[5] + q[6]) - u * sin(q[6]) - xa;
  g[5] = y - zf * sin(q[5] + q[6]) + u * cos(q[6]) - ya;
}

static void gradient(double t, const double* q, double* g) {
  const double b = q[0] + q[1], p = q[3] + q[4], o = q[5] + q[6];
  (void)t;
  memset(g, 0, 42 * sizeof *g);
  for (int k = 0; k < 6; k += 2) {
    g[7 * k] = -rr * sin(q[0]) + d * sin(b);
    g[7 * k + 1] = d * sin(b);
    g[7 * k + 7] = rr * cos(q[0]) - d * cos(b);
    g[7 * k + 8] = -d * cos(b);
  }
  g[2] = -ss * cos(q[2]);
  g[9] = -ss * sin(q[2]);
  g[17] = -e * cos(p);
  g[18] = -e * cos(p) + zt * sin(q[4]);
  g[24] = -e * sin(p);
  g[25] = -e * sin(p) - zt * cos(q[4]);
  g[33] = zf * sin(o);
  g[34] = zf * sin(o) - u * cos(q[6]);
  g[40] = -zf * cos(o);
  g[41] = -zf * cos(o) - u * sin(q[6]);
}

static void bias(double t, const double* q, const double* v, double* r) {
  const double vb = square(v[0] + v[1]), vp = square(v[3] + v[4]),
               vo = square(v[5] + v[6]);
  const double x = -rr * cos(q[0]) * v[0] * v[0] + d * cos(q[0] + q[1]) * vb;
  const double y = -rr * sin(q[0]) * v[0] * v[0] + d * sin(q[0] + q[1]) * vb;
  (void)t;
  r[0] = x + ss * sin(q[2]) * v[2] * v[2];
  r[1] = y - ss * cos(q[2]) * v[2] * v[2];
  r[2] = x + e * sin(q[3] + q[4]) * vp + zt * cos(q[4]) * v[4] * v[4];
  r[3] = y - e * cos(q[3] + q[4]) * vp + zt * sin(q[4]) * v[4] * v[4];
  r[4] = x + zf * cos(q[5] + q[6]) * vo + u * sin(q[6]) * v[6] * v[6];
  r[5] = y + zf * sin(q[5] + q[6]) * vo - u * cos(q[6]) * v[6] * v[6];
}

static const double q_size[7] = {1, 1, .5, .5, .5, .5, 1};
static const double v_size[7] = {1e3, 1e3, 20, 20, 20, 20, 20};

const Problem andrews_squeezer = {"andrews_squeezer",
                                  7,
                                  6,
                                  .03,
                                  100,
                                  1e3,
                                  q_size,
                                  v_size,
                                  start,
                                  mass,
                                  force,
                                  constraint,
                                  gradient,
                                  no_rate,
                                  bias};
