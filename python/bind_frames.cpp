// Frames that were emulated once: NumPy views of their pictures, and their times.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "pipeline/image/image_io.h"
#include "pipeline/image/srgb_codes.h"
#include "python/bindings.h"
#include "python/convert.h"

namespace hwsim::python {
namespace {

using lab::KeptFrame;

/// Read-only float32 over the picture's own memory, which `owner` keeps: (height, width, 4), or of the first
/// channel alone (height, width).
template <class Owner>
py::object picture(const pipeline::Image& image, bool one_channel, std::shared_ptr<Owner> owner) {
  constexpr py::ssize_t kPixel = sizeof(image.pixels[0]), kChannel = sizeof(float);
  const py::ssize_t height = image.height, width = image.width;
  std::vector<py::ssize_t> shape = {height, width}, strides = {width * kPixel, kPixel};
  if (!one_channel) {
    shape.push_back(4);
    strides.push_back(kChannel);
  }
  auto kept = std::make_unique<std::shared_ptr<Owner>>(std::move(owner));
  const py::capsule base(kept.get(), [](void* held) { delete static_cast<std::shared_ptr<Owner>*>(held); });
  kept.release();
  py::array_t<float> array(shape, strides, &image.pixels[0][0], base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// A frame that was not asked for pictures may have them, where another one of the same work was.
bool has_pictures(const KeptFrame& frame) {
  return frame.plan.images && !frame.emulation->color.pixels.empty();
}

py::object color_of(const KeptFrame& frame) {
  return has_pictures(frame) ? picture(frame.emulation->color, false, frame.emulation) : py::none();
}
py::object heat_of(const KeptFrame& frame) {
  return has_pictures(frame) ? picture(frame.emulation->shading_heat, true, frame.emulation) : py::none();
}
py::object flip_of(const KeptFrame& frame) {
  return frame.flip_map ? picture(*frame.flip_map, true, frame.flip_map) : py::none();
}

/// uint8 (height, width, 3), as a file holds it.
py::object srgb_of(const KeptFrame& frame) {
  if (!has_pictures(frame)) return py::none();
  const pipeline::Image& image = frame.emulation->color;
  constexpr py::ssize_t kTexel = sizeof(std::uint32_t);
  auto codes = std::make_unique<pipeline::RawImage>(pipeline::srgb_codes(image));
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(codes->texels.data());
  const py::capsule base(codes.get(), [](void* held) { delete static_cast<pipeline::RawImage*>(held); });
  codes.release();
  return py::array_t<std::uint8_t>(std::vector<py::ssize_t>{image.height, image.width, 3},
                                   std::vector<py::ssize_t>{image.width * kTexel, kTexel, 1}, bytes, base);
}

void save(const KeptFrame& frame, const std::string& path) {
  const py::gil_scoped_release release;
  pipeline::write_image(frame.emulation->color, path);
}

py::object error_of(const KeptFrame& frame) {
  if (!frame.image_error) return py::none();
  py::dict error;
  error["flip_mean"] = frame.image_error->flip_mean;
  error["flip_median"] = frame.image_error->flip_median;
  error["flip_p99"] = frame.image_error->flip_p99;
  error["psnr_db"] = frame.image_error->psnr_db;
  error["rmse"] = frame.image_error->rmse;
  error["ssim"] = frame.image_error->ssim;
  return error;
}

/// What does not depend on the GPU that times it.
py::dict facts_of(const KeptFrame& frame) {
  const WorkTrace& trace = frame.emulation->trace;
  py::dict facts;
  facts["scene"] = frame.scene.name;
  facts["technique"] = trace.technique;
  facts["gpu"] = frame.plan.gpus.front().id;
  facts["engine"] = std::string(engine_name(frame.plan.engine));
  facts["resolution"] = py::make_tuple(trace.width_px, trace.height_px);
  facts["memory_bytes"] = trace.peak_memory_bytes;
  facts["allocated_bytes"] = trace.allocated_memory_bytes;
  facts["from_cache"] = frame.from_cache;
  facts["emulation_wall_s"] = frame.emulation->wall_s;
  return facts;
}

/// By pass, in order: name, kind and counters by id.
py::list passes_of(const KeptFrame& frame) {
  py::list passes;
  for (const PassWork& pass : frame.emulation->trace.passes) {
    py::dict counters;
    const PassCounters sum = total(pass);
    for (const auto& [info, place] : algos::counters()) counters[py::str(info.id)] = values(sum)[place];
    py::dict dict;
    dict["name"] = pass.name;
    dict["kind"] = std::string(pass_kind_name(pass.kind));
    dict["counters"] = counters;
    passes.append(dict);
  }
  return passes;
}

/// Without the interpreter's lock while hwsim works.
template <class Work>
auto released(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

py::object time_of(const KeptFrame& frame, const Gpu& gpu) {
  return to_python(released([&] { return to_json(lab::time(frame, gpu.config)); }));
}

py::object explanation_of(const KeptFrame& frame, const Gpu& gpu) {
  return to_python(released([&] { return to_json(lab::explain(frame, gpu.config)); }));
}

py::list gradient_of(const KeptFrame& frame, const Gpu& gpu) {
  py::list list;
  for (const lab::KeySlope& slope : released([&] { return lab::gradient(frame, gpu.config); }))
    list.append(py::make_tuple(slope.key, slope.value, slope.slope_ms, slope.elasticity));
  return list;
}

}  // namespace

void bind_frames(py::module_& module) {
  py::class_<KeptFrame>(module, "Frame", "A frame that was emulated once.")
      .def_property_readonly("image", color_of)
      .def_property_readonly("shading_heat", heat_of)
      .def_property_readonly("flip_map", flip_of)
      .def("srgb", srgb_of)
      .def("save", save, py::arg("path"))
      .def("error", error_of)
      .def("facts", facts_of)
      .def("passes", passes_of)
      .def(
          "is_work_of", [](const KeptFrame& frame, const Gpu& gpu) { return is_work_of(frame, gpu.config); },
          py::arg("gpu"))
      .def("time", time_of, py::arg("gpu"))
      .def("explain", explanation_of, py::arg("gpu"))
      .def("gradient", gradient_of, py::arg("gpu"));
}

}  // namespace hwsim::python
