#include "pipeline/gltf/cameras.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

std::string shown(const json& value) {
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() > 40 ? text.substr(0, 37) + "..." : text;
}

// Reads the numbers of one camera; the first thing wrong with them becomes its fault.
class CameraReader {
 public:
  CameraReader(const json& values, std::string kind, std::string& fault)
      : values_(values), kind_(std::move(kind)), fault_(fault) {}

  double required(const char* key) {
    if (!values_.contains(key)) fail(key, "is missing");
    return optional(key).value_or(0.0);
  }
  std::optional<double> optional(const char* key) {
    const auto found = values_.find(key);
    if (found == values_.end()) return std::nullopt;
    if (found->is_number() && std::isfinite(found->get<double>())) return found->get<double>();
    fail(key, "is no number");
    return std::nullopt;
  }
  void expect(bool right, const char* key, double value, const std::string& wanted) {
    if (!right) fail(key, "is " + json(value).dump() + ", must be " + wanted);
  }

 private:
  void fail(const char* key, const std::string& what) {
    if (fault_.empty()) fault_ = kind_ + "." + key + " " + what;
  }

  const json& values_;
  std::string kind_;
  std::string& fault_;
};

void read_depth_range(CameraReader& reader, CameraSpec& camera) {
  const bool may_be_zero = camera.orthographic;
  reader.expect(may_be_zero ? camera.near >= 0.0 : camera.near > 0.0, "znear", camera.near,
                may_be_zero ? "0 or more" : "above 0");
  const bool infinite = !camera.orthographic && camera.far == 0.0;
  reader.expect(infinite || camera.far > camera.near, "zfar", camera.far, "above znear");
}

void read_perspective(const json& values, CameraSpec& camera) {
  CameraReader reader(values, "perspective", camera.fault);
  camera.fov_y_rad = reader.required("yfov");
  camera.near = reader.required("znear");
  camera.far = reader.optional("zfar").value_or(0.0);
  reader.expect(camera.fov_y_rad > 1e-4 && camera.fov_y_rad < std::numbers::pi * 0.999, "yfov",
                camera.fov_y_rad, "between 0 and pi (radians)");
  read_depth_range(reader, camera);
  // A frame of no width says nothing: the image's shape is taken, as where the key is missing.
  if (!values.contains("aspectRatio")) return;
  const json& aspect = values["aspectRatio"];
  const double ratio = aspect.is_number() ? aspect.get<double>() : 0.0;
  if (ratio > 1e-6 && ratio < 1e6)
    camera.aspect_ratio = ratio;
  else
    camera.remark = "perspective.aspectRatio is " + shown(aspect) +
                    ", must be a number above 0: the picture's own shape is taken";
}

void read_orthographic(const json& values, CameraSpec& camera) {
  CameraReader reader(values, "orthographic", camera.fault);
  camera.orthographic = true;
  const double x = std::abs(reader.required("xmag"));
  camera.half_height = std::abs(reader.required("ymag"));
  camera.near = reader.required("znear");
  camera.far = reader.required("zfar");
  reader.expect(camera.half_height > 0.0, "ymag", camera.half_height, "another number than 0");
  reader.expect(x > 0.0, "xmag", x, "another number than 0");
  read_depth_range(reader, camera);
  if (camera.fault.empty()) camera.aspect_ratio = x / camera.half_height;
}

CameraSpec read_camera(const json& source) {
  CameraSpec camera;
  if (!source.is_object()) {
    camera.fault = "it is no object";
    return camera;
  }
  if (source.contains("name") && source["name"].is_string()) camera.name = source["name"];
  const std::string type =
      source.contains("type") && source["type"].is_string() ? source["type"].get<std::string>() : "";
  if (type != "perspective" && type != "orthographic")
    camera.fault = "its type must be perspective or orthographic";
  else if (!source.contains(type) || !source[type].is_object())
    camera.fault = "its values (" + type + ") are missing";
  else
    (type == "perspective" ? read_perspective : read_orthographic)(source[type], camera);
  return camera;
}

}  // namespace

std::vector<CameraSpec> read_cameras(const json& root) {
  std::vector<CameraSpec> out;
  const auto cameras = root.find("cameras");
  if (cameras == root.end()) return out;
  for (const json& camera : *cameras) out.push_back(read_camera(camera));
  return out;
}

}  // namespace hwsim::pipeline::gltf
