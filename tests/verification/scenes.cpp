// Compiles scenes.hpp once for all suites.
#include "scenes.hpp"
