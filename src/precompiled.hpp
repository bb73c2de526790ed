#pragma once
// What most sources of the library include, parsed once. No source includes this file: the build does, where it
// precompiles headers.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>
