#pragma once
// What `--vary` takes beside settings: words that stand for a whole part of a request, such as its
// resolution.
#include <string>
#include <string_view>
#include <vector>

#include "lab/request/request.h"

namespace hwsim::lab {

/// resolution, camera, gpu, overlay and scene.
const std::vector<std::string>& request_words();
bool is_request_word(std::string_view path);

/// Whether what `path` varies is what is drawn, not how or on what: scene, camera, resolution, `scene.*`.
bool is_of_frame(std::string_view path);

/// The settings without the words among them.
std::vector<Assignment> without_words(const std::vector<Assignment>& settings);

/// Puts what the words among `settings` say in the place of what the request has. An overlay is laid over
/// those that it has: "none" is no further one, "a+b" are two. Throws InputError U005.
void apply_words(Request& request, const std::vector<Assignment>& settings);

/// "1280x720"; `name` is what the user called it. Throws InputError U005.
Resolution parse_resolution(std::string_view text, const std::string& name);

}  // namespace hwsim::lab
