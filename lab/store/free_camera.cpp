#include "lab/store/free_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "lab/base/messages.h"
#include "pipeline/scene/framing.h"

namespace hwsim::lab {
namespace {

constexpr float kFovDefaultDeg = 60.0f, kFovLeastDeg = 1.0f, kFovMostDeg = 170.0f, kRadPerDeg = 0.017453293f;
constexpr float kNearOfDiagonal = 1e-3f;
constexpr float kCoordinateMost = 1e6f;

[[noreturn]] void fail_camera(std::string_view words, const std::string& why) {
  fail("U009", fmt::format("`{}` places no camera: {}", words, why), "",
       "--camera-eye X,Y,Z --camera-target X,Y,Z --camera-fov DEGREES, in the scene's meters, y up");
}

/// As many numbers as there are, with commas between.
template <std::size_t N>
bool read_numbers(std::string_view text, std::array<float, N>& numbers) {
  for (std::size_t i = 0; i < N; ++i) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, numbers[i]);
    if (error != std::errc() || !(std::abs(numbers[i]) <= kCoordinateMost)) return false;
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    if (i + 1 < N && !text.starts_with(',')) return false;
    if (i + 1 < N) text.remove_prefix(1);
  }
  return text.empty();
}

struct Words {
  std::array<float, 3> eye{}, target{};
  std::array<float, 1> fov_deg{kFovDefaultDeg};
};

Words read_words(std::string_view words) {
  Words read;
  bool has_target = false;
  for (std::string_view rest = words; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? "" : word.substr(equals + 1);
    const bool good = name == "eye"      ? read_numbers(value, read.eye)
                      : name == "target" ? read_numbers(value, read.target)
                      : name == "fov"    ? read_numbers(value, read.fov_deg)
                                         : false;
    if (!good)
      fail_camera(words, fmt::format("`{}` is none of eye=X,Y,Z, target=X,Y,Z and fov=DEGREES", word));
    has_target = has_target || name == "target";
  }
  if (!has_target) fail_camera(words, "nothing says where it looks");
  return read;
}

}  // namespace

std::optional<pipeline::Camera> free_camera(std::string_view words) {
  if (!words.starts_with("eye=")) return std::nullopt;
  const Words read = read_words(words);
  if (read.fov_deg[0] < kFovLeastDeg || read.fov_deg[0] > kFovMostDeg)
    fail_camera(words, fmt::format("fov is from {:g} to {:g} degrees", kFovLeastDeg, kFovMostDeg));
  const glm::vec3 eye{read.eye[0], read.eye[1], read.eye[2]};
  const glm::vec3 way = glm::vec3{read.target[0], read.target[1], read.target[2]} - eye;
  if (!(glm::length(way) > 0.0f)) fail_camera(words, "it looks at where it stands");
  const bool steep = std::abs(way.x) + std::abs(way.z) < 1e-4f * std::abs(way.y);
  pipeline::Camera camera;
  camera.name = words;
  camera.fov_y_rad = read.fov_deg[0] * kRadPerDeg;
  camera.view_from_world =
      glm::lookAtRH(eye, eye + way, steep ? glm::vec3{0.0f, 0.0f, -1.0f} : glm::vec3{0.0f, 1.0f, 0.0f});
  return camera;
}

pipeline::Scene with_camera(pipeline::Scene scene, pipeline::Camera camera) {
  const pipeline::SceneStats stats = pipeline::stats(scene);
  camera.near_m = kNearOfDiagonal * glm::length(stats.bounds_max - stats.bounds_min);
  camera.far_m = pipeline::far_plane_m(camera, stats.bounds_min, stats.bounds_max);
  scene.cameras.push_back(std::move(camera));
  return scene;
}

}  // namespace hwsim::lab
