#include "pipeline/image/frame_check.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline/image/known_srgb.h"

namespace hwsim::pipeline {
namespace {

// Frames hold eight bits: closer than half a code is the same color.
bool is_near(KnownSrgb& encoded, const glm::vec4& pixel, const glm::vec3& color) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(encoded(pixel[i]) - encoded(color[i])) > 1.0f / 255.0f) return false;
  return true;
}

Diagnostic warning(const char* code, const std::string& message, const std::string& help) {
  Diagnostic d;
  d.severity = Severity::warning;
  d.code = code;
  d.message = message;
  d.help = help;
  return d;
}

std::string percent(double share) { return std::to_string(std::lround(share * 100.0)) + " %"; }

}  // namespace

FrameLook look_at(const Image& color, const glm::vec3& background) {
  KnownSrgb encoded;
  const float near_white = linear_from_srgb(254.5f / 255.0f), near_black = linear_from_srgb(1.5f / 255.0f);
  std::size_t drawn = 0, white = 0, black = 0;
  for (const glm::vec4& p : color.pixels) {
    if (is_near(encoded, p, background)) continue;
    ++drawn;
    white += std::min({p.x, p.y, p.z}) > near_white;
    black += std::max({p.x, p.y, p.z}) < near_black;
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  return {share(drawn, color.pixels.size()), share(white, drawn), share(black, drawn)};
}

std::vector<Diagnostic> check_frame(const Image& color, const glm::vec3& background) {
  const FrameLook look = look_at(color, background);
  if (color.pixels.empty()) return {};
  if (look.drawn == 0.0)
    return {warning(
        "P001", "the picture shows the background alone: nothing is drawn",
        "choose another camera (--camera), or look at the scene's size, place and cameras: `hwsim scene "
        "check`")};
  if (look.white > 0.5)
    return {warning("P002",
                    percent(look.white) + " of what is drawn is white: the light is too bright for a picture",
                    "scale the light down: --exposure 0.1, or smaller")};
  if (look.black > 0.5)
    return {
        warning("P003", percent(look.black) + " of what is drawn is black: hardly any light reaches it",
                "scale the light up: --exposure 10, or larger; or look at lights and materials: `hwsim scene "
                "check`")};
  return {};
}

}  // namespace hwsim::pipeline
