#include "lab/studies/views.h"

#include "lab/base/messages.h"
#include "lab/request/request_words.h"

namespace hwsim::lab {
namespace {

std::string name_of(const std::vector<Assignment>& settings) {
  std::string name;
  for (const Assignment& set : settings) name += (name.empty() ? "" : "-") + set.path + "-" + set.value;
  for (char& c : name)
    if (c == '/' || c == ':' || c == ',' || c == '=') c = '_';
  return name;
}

}  // namespace

std::vector<NamedView> views_of(const Request& base, const PointSettings& views,
                                std::vector<Diagnostic>& problems) {
  std::vector<NamedView> named;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::vector<Assignment> settings = views[i];
    for (const Assignment& set : settings)
      if (!is_of_frame(set.path))
        fail_usage("U019", "`" + set.path + "` is no part of a view", "",
                   "--vary of scene, camera, resolution or scene.*; -g takes several GPUs");
    named.push_back({name_of(settings), base});
    apply(named.back().request, settings, problems);
  }
  return named;
}

}  // namespace hwsim::lab
