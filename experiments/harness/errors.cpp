#include "experiments/harness/errors.h"
