// GPUs as mappings.
#include <pybind11/stl.h>

#include <set>

#include "hwsim/gpu/gpu_keys.h"
#include "python/bindings.h"
#include "python/convert.h"

namespace hwsim::python {
namespace {

std::string_view layer_name(Origin::Layer layer) {
  switch (layer) {
    case Origin::Layer::built_in:
      return "built-in default";
    case Origin::Layer::file:
      return "file";
    case Origin::Layer::parent:
      return "parent file";
    case Origin::Layer::overlay:
      return "overlay";
    case Origin::Layer::command_line:
      return "setting";
  }
  return "";
}

std::set<std::string, std::less<>> whole_keys() {
  std::set<std::string, std::less<>> names;
  for (const KeyInfo& key : gpu_keys())
    if (key.has(kWhole)) names.emplace(key.name);
  return names;
}

/// Whole numbers are int, also those that the model takes as reals.
py::object value_of_key(const Gpu& gpu, const std::string& key) {
  static const std::set<std::string, std::less<>> whole = whole_keys();
  const std::string text = value_of(gpu.config, key);
  if (text.empty()) throw py::key_error(key);
  const TomlValue value = parse_toml_value(text);
  const auto* const real = std::get_if<double>(&value);
  if (real && whole.contains(key)) return py::int_(static_cast<std::int64_t>(*real));
  return to_python(value);
}

py::dict origin_of_key(const Gpu& gpu, const std::string& key) {
  const auto found = gpu.config.origins.find(key);
  if (found == gpu.config.origins.end()) throw py::key_error(key);
  const Origin& origin = found->second;
  py::dict dict;
  dict["layer"] = layer_name(origin.layer);
  dict["provenance"] =
      origin.provenance ? py::object(py::str(std::string(provenance_name(*origin.provenance)))) : py::none();
  dict["source"] = origin.source;
  dict["interval"] =
      origin.interval ? py::object(py::make_tuple((*origin.interval)[0], (*origin.interval)[1])) : py::none();
  dict["file"] = origin.file;
  dict["line"] = origin.line;
  dict["text"] = origin.to_string();
  return dict;
}

py::list all_keys() {
  py::list keys;
  for (const KeyInfo& key : gpu_keys()) {
    py::dict dict;
    dict["name"] = std::string(key.name);
    dict["low"] = key.low;
    dict["high"] = key.high;
    dict["description"] = std::string(key.description);
    keys.append(dict);
  }
  return keys;
}

py::list words_of(const std::vector<Assignment>& sets) {
  py::list words;
  for (const Assignment& set : sets) words.append(py::make_tuple(set.path, set.value));
  return words;
}

}  // namespace

void bind_gpus(py::module_& module) {
  module.def("gpu_keys", all_keys, "Every key of a GPU file, in its order.");
  py::class_<Gpu>(module, "Gpu", "A GPU with every value decided, and the words that made it.")
      .def_property_readonly("name", [](const Gpu& gpu) { return gpu.choice.name; })
      .def_property_readonly("overlays", [](const Gpu& gpu) { return gpu.choice.overlays; })
      .def_property_readonly("sets", [](const Gpu& gpu) { return words_of(gpu.choice.sets); })
      .def_property_readonly("calibrated", [](const Gpu& gpu) { return gpu.choice.calibrated; })
      .def_property_readonly("id", [](const Gpu& gpu) { return gpu.config.id; })
      .def_property_readonly("title", [](const Gpu& gpu) { return gpu.config.title; })
      .def_property_readonly("vendor", [](const Gpu& gpu) { return gpu.config.vendor; })
      .def_property_readonly("architecture", [](const Gpu& gpu) { return gpu.config.architecture; })
      .def("value", value_of_key, py::arg("key"))
      .def("origin", origin_of_key, py::arg("key"))
      .def("content_hash", [](const Gpu& gpu) { return content_hash(gpu.config); })
      .def(
          "toml", [](const Gpu& gpu, bool origins) { return show(gpu.config, origins); }, py::arg("origins"));
}

}  // namespace hwsim::python
