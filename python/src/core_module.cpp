// SPDX-License-Identifier: BSD-3-Clause
#include "python/src/measurements.hpp"

PYBIND11_MODULE(_core, module) {
  module.doc() = "Estimators, recordings and scores: what needs nothing of the simulation.";
  module.attr("__version__") = AIMS_VERSION;
  aims::python::bind_measurements(module);
  aims::python::bind_estimator(module);
  aims::python::bind_recordings(module);
}
