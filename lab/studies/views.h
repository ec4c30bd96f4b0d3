#pragma once
// The views that `--vary` spans: scene, camera, resolution and scene.* settings, whatever changes what is
// drawn.
#include <string>
#include <vector>

#include "lab/request/request.h"
#include "lab/studies/axes.h"

namespace hwsim::lab {

struct NamedView {
  std::string name;  ///< how its files are called: "scene-wires-camera-2"; empty for the request as it is
  Request request;
};

/// The request in each view. Appends what is wrong with the settings to `problems`. Throws InputError U019
/// where `views` varies what changes no image, such as gpu.*.
std::vector<NamedView> views_of(const Request& base, const PointSettings& views,
                                std::vector<Diagnostic>& problems);

}  // namespace hwsim::lab
