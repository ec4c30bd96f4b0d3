#include "python/convert.h"

#include <pybind11/stl.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "hwsim/config/assign.h"

namespace hwsim::python {
namespace {

using Json = nlohmann::ordered_json;

py::object cell_value(const lab::TableCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return py::str(*text);
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return py::int_(*count);
  if (const auto* real = std::get_if<lab::Real>(&cell)) return py::float_(real->value);
  return py::none();
}

std::string_view severity_name(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      break;
  }
  return "error";
}

py::type_error wrong_type(const std::string& key, const py::handle& value) {
  return py::type_error("`" + key + "` must be bool, int, float or str, not " +
                        Py_TYPE(value.ptr())->tp_name);
}

/// Which Python takes for a number; "numpy.bool" from NumPy 2 on.
bool is_numpy_bool(const py::handle& value) {
  const std::string_view name = Py_TYPE(value.ptr())->tp_name;
  return name == "numpy.bool_" || name == "numpy.bool";
}

/// NumPy makes a real number of any array that holds one value, and of a complex number: one with a dimension
/// is a list, though, and the other two numbers.
bool is_several_numbers(const py::handle& value) {
  if (py::hasattr(value, "ndim") && !py::object(value.attr("ndim")).equal(py::int_(0))) return true;
  const py::object type = py::getattr(value, "dtype", py::none());
  return py::object(py::getattr(type, "kind", py::none())).equal(py::str("c"));
}

/// What Python's protocol of numbers answered. None, and Python's error cleared, where it refused.
std::optional<py::object> answered(PyObject* answer) {
  if (answer != nullptr) return py::reinterpret_steal<py::object>(answer);
  if (PyErr_ExceptionMatches(PyExc_Exception) == 0) throw py::error_already_set();  // Ctrl-C, SystemExit
  PyErr_Clear();
  return std::nullopt;
}

/// None for what is no whole number of 64 bits.
std::optional<std::int64_t> whole_number(const py::handle& value) {
  if (PyIndex_Check(value.ptr()) == 0) return std::nullopt;
  const auto whole = answered(PyNumber_Index(value.ptr()));
  if (!whole) return std::nullopt;
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(whole->ptr(), &overflow);
  return overflow == 0 ? std::optional(std::int64_t{number}) : std::nullopt;
}

/// None for what is no real number. A whole number beyond the reals is infinite: out of every key's range.
std::optional<double> real_number(const py::handle& value) {
  if (PyNumber_Check(value.ptr()) == 0) return std::nullopt;
  if (const auto real = answered(PyNumber_Float(value.ptr()))) return PyFloat_AsDouble(real->ptr());
  if (PyLong_Check(value.ptr()) != 0) return std::numeric_limits<double>::infinity();
  return std::nullopt;
}

/// Gives each named value to its field.
void fill(const std::vector<lab::Field>& fields, const py::dict& values, std::vector<Diagnostic>& problems) {
  std::vector<Key> keys;
  for (const lab::Field& field : fields) keys.push_back({field.info.key, field.slot});
  for (const auto& [name, value] : values) {
    const std::string key_name = py::cast<std::string>(name);
    const Key* const key = find_key(keys, key_name);
    if (key)
      assign(*key, to_toml_value(key_name, value), {.file = key_name, .line_text = {}}, problems);
    else
      problems.push_back(unknown_key(keys, key_name, "a request", {.file = key_name, .line_text = {}}));
  }
}

}  // namespace

py::object to_python(const Json& json) {
  switch (json.type()) {
    case Json::value_t::boolean:
      return py::bool_(json.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(json.get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(json.get<double>());
    case Json::value_t::string:
      return py::str(json.get_ref<const std::string&>());
    case Json::value_t::array: {
      py::list list;
      for (const Json& item : json) list.append(to_python(item));
      return list;
    }
    case Json::value_t::object: {
      py::dict dict;
      for (const auto& [name, item] : json.items()) dict[py::str(name)] = to_python(item);
      return dict;
    }
    default:
      return py::none();
  }
}

py::object to_python(const TomlValue& value) {
  return std::visit([](const auto& item) -> py::object { return py::cast(item); }, value);
}

py::dict to_python(const lab::Table& table) {
  py::list columns, rows;
  for (const lab::Column& column : table.columns) columns.append(py::make_tuple(column.id, column.title));
  for (const std::vector<lab::TableCell>& cells : table.rows) {
    py::list row;
    for (const lab::TableCell& cell : cells) row.append(cell_value(cell));
    rows.append(row);
  }
  py::dict result;
  result["columns"] = columns;
  result["rows"] = rows;
  return result;
}

py::list to_python(const std::vector<Diagnostic>& diagnostics) {
  py::list list;
  for (const Diagnostic& diagnostic : diagnostics) {
    py::dict dict;
    dict["severity"] = severity_name(diagnostic.severity);
    dict["code"] = diagnostic.code;
    dict["message"] = diagnostic.message;
    dict["file"] = diagnostic.place.file;
    dict["line"] = diagnostic.place.line;
    dict["column"] = diagnostic.place.column;
    dict["hint"] = diagnostic.hint;
    dict["notes"] = py::tuple(py::cast(diagnostic.notes));
    dict["help"] = diagnostic.help;
    dict["text"] = render(diagnostic, false);
    list.append(dict);
  }
  return list;
}

TomlValue to_toml_value(const std::string& key, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (is_numpy_bool(value)) return PyObject_IsTrue(value.ptr()) == 1;
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (is_several_numbers(value)) throw wrong_type(key, value);
  if (const auto whole = whole_number(value)) return *whole;
  if (const auto real = real_number(value)) return *real;
  throw wrong_type(key, value);
}

std::vector<Assignment> to_assignments(const py::handle& pairs) {
  std::vector<Assignment> sets;
  for (const py::handle& pair : pairs) {
    const auto [path, value] = pair.cast<std::pair<std::string, py::object>>();
    const TomlValue toml = to_toml_value(path, value);
    const auto* const text = std::get_if<std::string>(&toml);  // as on a command line: x2, none, "1.5"
    sets.push_back({path, text ? *text : to_toml(toml)});
  }
  return sets;
}

lab::Request to_request(const py::dict& words) {
  lab::Request request;
  std::vector<Diagnostic> problems;
  fill(fields_of(request.view), words["view"], problems);
  fill(fields_of(request.settings), words["settings"], problems);
  request.techniques = words["techniques"].cast<std::vector<std::string>>();
  apply(request, to_assignments(words["sets"]), problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return request;
}

}  // namespace hwsim::python
