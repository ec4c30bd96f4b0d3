#pragma once
// Between Python's values and the lab's plain data.
#include <pybind11/pybind11.h>

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "hwsim/config/toml_value.h"
#include "lab/base/table.h"
#include "lab/request/request.h"

namespace hwsim::python {

namespace py = pybind11;

/// Objects as dict, arrays as list; the order of keys stays.
py::object to_python(const nlohmann::ordered_json& json);
py::object to_python(const TomlValue& value);

/// {"columns": [(id, title)], "rows": [[cell]]}; a cell without a value is None.
py::dict to_python(const lab::Table& table);

/// What Diagnostic of hwsim/_errors.py takes.
py::list to_python(const std::vector<Diagnostic>& diagnostics);

/// A bool, int, float or str, those of NumPy too. Throws TypeError that names the key for anything else.
TomlValue to_toml_value(const std::string& key, const py::handle& value);

/// A sequence of (path, value), where a value is what to_toml_value takes.
std::vector<Assignment> to_assignments(const py::handle& pairs);

/// A request of {"view": {name: value}, "settings": {name: value}, "techniques": [...], "sets": [(path,
/// value)]}, by the names of lab/request/request.h. Throws InputError with everything that is wrong in it.
lab::Request to_request(const py::dict& words);

}  // namespace hwsim::python
