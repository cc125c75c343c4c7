#include "integrators/linear/linear_solver.h"
