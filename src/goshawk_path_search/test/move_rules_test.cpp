#include "goshawk/path_search/move_rules.hpp"

#include <gtest/gtest.h>
