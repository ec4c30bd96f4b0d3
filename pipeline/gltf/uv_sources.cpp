#include "pipeline/gltf/uv_sources.h"

#include <cmath>

namespace hwsim::pipeline::gltf {

glm::vec2 UvTransform::applied(const glm::vec2& uv) const {
  const glm::dvec2 scaled = glm::dvec2(uv) * scale;
  const double c = std::cos(rotation_rad), s = std::sin(rotation_rad);
  return {static_cast<float>(c * scaled.x + s * scaled.y + offset.x),
          static_cast<float>(c * scaled.y - s * scaled.x + offset.y)};
}

std::string UvSources::key() const {
  std::string out;
  for (const UvSource& source : sets) {
    out += std::to_string(source.file_set);
    for (const double number :
         {source.transform.offset.x, source.transform.offset.y, source.transform.scale.x,
          source.transform.scale.y, source.transform.rotation_rad})
      out.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  return out;
}

}  // namespace hwsim::pipeline::gltf
