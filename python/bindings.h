#pragma once
// The parts of the module, each in a file of its own, and the values that several of them take.
#include <pybind11/pybind11.h>

#include <memory>

#include "lab/catalog/config_files.h"
#include "lab/studies/kept_frame.h"

namespace hwsim::python {

namespace py = pybind11;

/// A GPU with the words that made it, from which variants are made.
struct Gpu {
  lab::GpuChoice choice;
  GpuConfig config;
};

void bind_errors(py::module_& module);
void bind_gpus(py::module_& module);
void bind_frames(py::module_& module);
void bind_labs(py::module_& module);

}  // namespace hwsim::python
