#include "python/convert.h"

#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

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

/// Gives each named value to its field.
void fill(const std::vector<lab::Field>& fields, const py::dict& values, std::vector<Diagnostic>& problems) {
  std::vector<Key> keys;
  for (const lab::Field& field : fields) keys.push_back({field.info.key, field.slot});
  for (const auto& [name, value] : values) {
    const std::string key_name = py::cast<std::string>(name);
    const Key* const key = find_key(keys, key_name);
    if (key)
      assign(*key, to_toml_value(value), {.file = key_name, .line_text = {}}, problems);
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

TomlValue to_toml_value(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (PyIndex_Check(value.ptr()) != 0)
    return py::reinterpret_steal<py::int_>(PyNumber_Index(value.ptr())).cast<std::int64_t>();
  if (PyNumber_Check(value.ptr()) != 0) return value.cast<double>();
  throw py::type_error("a value must be bool, int, float or str, not " +
                       std::string(Py_TYPE(value.ptr())->tp_name));
}

std::vector<Assignment> to_assignments(const py::handle& pairs) {
  std::vector<Assignment> sets;
  for (const py::handle& pair : pairs) {
    const auto [path, value] = pair.cast<std::pair<std::string, py::object>>();
    const TomlValue toml = to_toml_value(value);
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
