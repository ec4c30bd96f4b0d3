#pragma once
// The cameras of a file, read from its JSON and judged one by one: a wrong camera is left out, not the file.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace hwsim::pipeline::gltf {

/// A camera as the file has it, in the file's units.
struct CameraSpec {
  std::string name;
  std::string fault;   ///< why it cannot be drawn from; empty: it can
  std::string remark;  ///< what is wrong with it and costs no picture; empty: nothing
  bool orthographic = false;
  double fov_y_rad = 0.0;     ///< perspective
  double half_height = 0.0;   ///< orthographic: ymag
  double aspect_ratio = 0.0;  ///< width by height of the frame that must be seen whole; 0: the image's
  double near = 0.0;
  double far = 0.0;  ///< 0: infinite (perspective)
};

std::vector<CameraSpec> read_cameras(const nlohmann::json& root);

}  // namespace hwsim::pipeline::gltf
