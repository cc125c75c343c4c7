#pragma once

#include "models/input_error.h"
