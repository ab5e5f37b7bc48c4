// So that scenes.hpp is compiled once, for all suites.
#include "scenes.hpp"
