#pragma once
// The verdict on arrays or on a file, and the budget of arrays, for Python.

#include <nanobind/nanobind.h>

namespace credence::python {

void bind_judge(nanobind::module_& module);
void bind_budget(nanobind::module_& module);

}  // namespace credence::python
