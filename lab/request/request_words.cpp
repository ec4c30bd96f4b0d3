#include "lab/request/request_words.h"

#include <algorithm>
#include <charconv>

#include "lab/base/messages.h"
#include "lab/base/text.h"

namespace hwsim::lab {

const std::vector<std::string>& request_words() {
  static const std::vector<std::string> words = {"resolution", "camera", "gpu", "overlay", "scene"};
  return words;
}

bool is_request_word(std::string_view path) {
  return std::ranges::find(request_words(), path) != request_words().end();
}

bool is_of_frame(std::string_view path) {
  return path == "resolution" || path == "camera" || path == "scene" || path.starts_with("scene.");
}

std::vector<Assignment> without_words(const std::vector<Assignment>& settings) {
  std::vector<Assignment> rest;
  std::ranges::copy_if(settings, std::back_inserter(rest),
                       [](const Assignment& set) { return !is_request_word(set.path); });
  return rest;
}

void apply_words(Request& request, const std::vector<Assignment>& settings) {
  for (const Assignment& set : settings) {
    if (set.path == "resolution")
      request.view.resolution = parse_resolution(set.value, "resolution");
    else if (set.path == "camera")
      request.view.camera = set.value;
    else if (set.path == "gpu")
      request.gpus = {set.value};
    else if (set.path == "scene")
      request.view.scene = set.value;
    else if (set.path == "overlay" && set.value != "none")
      for (std::string& overlay : split(set.value, '+')) request.overlays.push_back(std::move(overlay));
  }
}

Resolution parse_resolution(std::string_view text, const std::string& name) {
  Resolution size;
  const auto cross = text.find('x');
  const auto number = [](std::string_view part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size();
  };
  if (cross == std::string_view::npos || !number(text.substr(0, cross), size.width_px) ||
      !number(text.substr(cross + 1), size.height_px))
    fail_usage("U005", name + " is `" + std::string(text) + "`, must be WIDTHxHEIGHT", name + " 1280x720");
  for (const int side : {size.width_px, size.height_px})
    if (side < 1 || side > kMaxSidePx)
      fail_usage("U005", name + " is " + std::string(text) + ", each side must be 1 to " +
                             std::to_string(kMaxSidePx) + " pixels");
  return size;
}

}  // namespace hwsim::lab
