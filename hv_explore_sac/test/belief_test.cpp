#include "hv_explore_sac/belief.h"

#include <gtest/gtest.h>
