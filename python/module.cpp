// The extension module hwsim._core. What people call is in the Python files beside it.
#include "lab/base/build_info.h"
#include "python/bindings.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "What hwsim's Python package is built on; not for direct use.";
  module.attr("__version__") = std::string(hwsim::lab::build_info().version);
  hwsim::python::bind_errors(module);
  hwsim::python::bind_gpus(module);
  hwsim::python::bind_frames(module);
  hwsim::python::bind_labs(module);
}
