// SPDX-License-Identifier: BSD-3-Clause
#include "python/src/outcome.hpp"

#include <pybind11/stl.h>

namespace aims::python {

py::dict outcome_of(const EstimatorOutcome& outcome) {
  py::dict dict = result_of(outcome.result);
  dict["map"] = array_of(outcome.map);
  dict["wall_s"] = outcome.wall_s;
  dict["wall_ms"] = py::array(py::cast(outcome.scan_times.wall_ms));
  dict["cpu_ms"] = py::array(py::cast(outcome.scan_times.cpu_ms));
  return dict;
}

}  // namespace aims::python
