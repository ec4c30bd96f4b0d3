#include "cli/arguments/requests.h"

#include "hwsim/config/settings.h"
#include "lab/base/messages.h"
#include "lab/request/image_input.h"

namespace hwsim::cli {
namespace {

std::vector<Assignment> parse_sets(const std::vector<std::string>& texts, std::vector<Diagnostic>& problems) {
  std::vector<Assignment> sets;
  for (const std::string& text : texts) try {
      sets.push_back(parse_assignment(text));
    } catch (const InputError& error) {
      append(problems, error);
    }
  return sets;
}

void apply_flags(const ViewArguments& options, View& view) {
  view.resolution = options.resolution.value_or(view.resolution);
  view.camera = options.camera.value_or(view.camera);
  if (!options.camera_eye.empty())
    view.camera = "eye=" + options.camera_eye + " target=" + options.camera_target +
                  (options.camera_fov.empty() ? "" : " fov=" + options.camera_fov);
  view.point_lights = options.point_lights.value_or(view.point_lights);
  view.shadows = view.shadows && !options.no_shadows;
  view.anisotropy = options.anisotropy.value_or(view.anisotropy);
  view.exposure = options.exposure.value_or(view.exposure);
  view.reference_shadows = options.reference_shadows.value_or(view.reference_shadows);
}

void apply_flags(const RunArguments& options, Request& request) {
  apply_flags(options.view, request.view);
  Settings& settings = request.settings;
  settings.engine = options.engine.value_or(settings.engine);
  settings.reference_samples = options.reference_samples.value_or(settings.reference_samples);
  settings.images = !options.no_image;
  if (!options.techniques.empty()) request.techniques = options.techniques;
  if (!options.gpus.empty()) request.gpus = options.gpus;
  request.overlays = options.overlays;
}

/// Flags that say how a scene is seen, given with an image.
void check_image_flags(const RunArguments& options, const View& view, std::vector<Diagnostic>& problems) {
  if (!is_image_file(view.scene)) return;
  const auto refuse = [&](bool given, const std::string& what) {
    if (given)
      problems.push_back(problem("U030", what + " has no meaning for the image `" + view.scene + "`", "",
                                 "an image is filtered as it is"));
  };
  refuse(options.view.resolution.has_value(), "--resolution");
  refuse(options.view.camera.has_value() || !options.view.camera_eye.empty(), "--camera");
  refuse(options.view.point_lights.has_value(), "--lights");
  refuse(options.view.anisotropy.has_value(), "--anisotropy");
}

Request request_with(const RunArguments& options, std::vector<Diagnostic>& problems) {
  const std::vector<Assignment> sets = parse_sets(options.view.sets, problems);
  Request request = open_request(options.view.scene);
  apply(request, sets, problems);
  apply_flags(options, request);
  check_image_flags(options, request.view, problems);
  return request;
}

}  // namespace

std::vector<Assignment> parse_sets(const std::vector<std::string>& texts) {
  std::vector<Diagnostic> problems;
  std::vector<Assignment> sets = parse_sets(texts, problems);
  if (!problems.empty()) throw InputError(problems);
  return sets;
}

Request request_of(const RunArguments& options) {
  std::vector<Diagnostic> problems;
  Request request = request_with(options, problems);
  if (!problems.empty()) throw InputError(problems);
  return request;
}

RunPlan plan_of(const RunArguments& options, Lab& lab) {
  std::vector<Diagnostic> problems;
  const Request request = request_with(options, problems);
  RunPlan plan = lab.plan(request, problems);
  if (!problems.empty()) throw InputError(problems);
  return plan;
}

View view_of(const ViewArguments& options) {
  std::vector<Diagnostic> problems;
  const std::vector<Assignment> sets = parse_sets(options.sets, problems);
  try {
    check_groups(sets, std::vector<std::string>{"scene"});
  } catch (const InputError& error) {
    append(problems, error);
  }
  Request request = open_request(options.scene);
  apply(request, sets, problems);
  apply_flags(options, request.view);
  if (!problems.empty()) throw InputError(problems);
  return request.view;
}

}  // namespace hwsim::cli
