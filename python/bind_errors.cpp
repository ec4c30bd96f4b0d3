// hwsim's exceptions become those of hwsim/_errors.py.
#include "lab/point/simulate.h"
#include "python/bindings.h"
#include "python/convert.h"

namespace hwsim::python {
namespace {

py::object error_class(const char* name) { return py::module_::import("hwsim._errors").attr(name); }

void raise(const py::object& type, const py::object& error) { PyErr_SetObject(type.ptr(), error.ptr()); }

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const InputError& error) {
    const py::object type = error_class("InputError");
    raise(type, type(to_python(error.diagnostics())));
  } catch (const lab::InternalError& error) {
    const py::object type = error_class("InternalError");
    raise(type, type(error.what()));
  }
}

}  // namespace

void bind_errors(py::module_&) { py::register_local_exception_translator(translate); }

}  // namespace hwsim::python
