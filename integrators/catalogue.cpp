#include "integrators/catalogue.h"
