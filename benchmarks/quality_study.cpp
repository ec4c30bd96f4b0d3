// How near each technique comes to the ray-traced truth, and how still its images stand while the camera
// moves by parts of a pixel: Markdown tables on standard output.
//
//   quality_study [--samples=256] [--size=480x270] [--frames=8] [--jobs=2] [--only=errors|stability|kept]
//                 [--lights=scene|simple|complex] [--light_strength=1] [--technique=T ...] [scene ...]
// --lights=complex is the papers' rig: a light with a shadow map, and 16 point lights that reach the whole
// scene. `kept` gives filters the truth itself, which has no edges left to smooth, or an image file: what
// they change of it they lose.
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "algos/base/reference_frame.h"
#include "algos/techniques.h"
#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/every_feature.h"
#include "pipeline/base/file_io.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/image/metrics.h"
#include "pipeline/image/srgb_codes.h"
#include "pipeline/open/scene_source.h"
#include "study_input.h"

namespace hwsim::benchmarks {
namespace {
using algos::FrameRequest;
using pipeline::Image;

/// Selective supersampling wherever normals turn, at any cost; lists as far as 64x supersampling goes.
constexpr const char* kPoints = "sss_cs:mode=or,theta_c=0.5,hl_px=16,rho=64,k_max=256,border_frac=0";
constexpr const char* kLists =
    "sss_ppll:mode=or,theta_c=0.5,hl_px=16,early_exit=off,m=8,node_bytes=32,list_cap=64,capacity_nodes="
    "16000000";

/// Scenes of the tables of errors, and of those of flicker, where none is asked for.
constexpr const char* kCompared[] = {"none",
                                     "msaa4x",
                                     "msaa8x",
                                     "ssaa4x",
                                     "ssaa16x",
                                     "ssaa64x",
                                     "deferred",
                                     "deferred_simple_complex",
                                     "sbaa_top:n=4",
                                     "sbaa_merge:n=4",
                                     "agaa:c=2",
                                     "agaa:c=2,diffuse_filter=samples",
                                     "agaa:c=3",
                                     "agaa:c=2,ndf=sggx",
                                     "agaa:c=2,ndf=lean",
                                     "agaa:c=2,diffuse_filter=geometric",
                                     "csaa:mode=16x",
                                     "eqaa:mode=8f16x",
                                     "sss_gs",
                                     "sss_cs",
                                     "sss_ppll",
                                     kPoints,
                                     kLists,
                                     "wire_aa+msaa4x",
                                     "fxaa",
                                     "axaa",
                                     "smaa",
                                     "cmaa",
                                     "mlaa"};
constexpr const char* kWatched[] = {"none",         "msaa8x",         "ssaa64x", "deferred_simple_complex",
                                    "sbaa_top:n=4", "agaa:c=2",       "sss_cs",  "sss_ppll",
                                    kLists,         "wire_aa+msaa4x", "fxaa",    "smaa"};

constexpr const char* kFilters[] = {"fxaa", "axaa", "smaa", "cmaa", "mlaa"};

struct Study {
  int width_px = 480, height_px = 270;
  int samples = 256, frames = 8, jobs = 2;
  bool errors = true, stability = true, kept = true;
  double light_strength = 1.0;
  std::string lights = "scene";  ///< others reach the whole scene, and come with shadows, as in the papers
  std::vector<std::string> scenes, techniques;
};

template <std::size_t kCount>
std::vector<std::string> asked_or(const char* const (&usual)[kCount], const Study& study) {
  return study.techniques.empty() ? std::vector<std::string>(std::begin(usual), std::end(usual))
                                  : study.techniques;
}

/// The frame seen by its first camera turned so that the picture moves by `pan_px`.
FrameRequest panned(FrameRequest request, glm::vec2 pan_px) {
  if (pan_px == glm::vec2(0.0f)) return request;
  auto moved = std::make_shared<pipeline::Scene>(*request.scene);
  request.scene = moved;
  pipeline::Camera& camera = moved->cameras.front();
  if (camera.orthographic) {
    const float meters = 2.0f * camera.ortho_half_height_m / static_cast<float>(request.height_px);
    camera.view_from_world =
        glm::translate(glm::mat4(1.0f), glm::vec3(pan_px.x * meters, -pan_px.y * meters, 0.0f)) *
        camera.view_from_world;
    return request;
  }
  const float radians = 2.0f * std::tan(camera.fov_y_rad * 0.5f) / static_cast<float>(request.height_px);
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), -pan_px.x * radians, glm::vec3(0.0f, 1.0f, 0.0f)) *
                         glm::rotate(glm::mat4(1.0f), -pan_px.y * radians, glm::vec3(1.0f, 0.0f, 0.0f));
  camera.view_from_world = turn * camera.view_from_world;
  return request;
}

Image frame(const std::string& technique, const FrameRequest& request, const Study& study) {
  pipeline::EmulationOptions options;
  options.jobs = study.jobs;
  const pipeline::FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
  return pipeline::emulate(graph, request.features, FunctionalConfig{}, options).color;
}

Image truth(const FrameRequest& request, int samples, const Study& study) {
  algos::ReferenceFrameOptions options;
  options.samples = samples;
  options.jobs = study.jobs;
  return algos::render_reference_frame(request, options);
}

float shown_luma(const glm::vec4& linear) {
  const auto shown = [](float v) { return pipeline::srgb_from_linear(std::clamp(v, 0.0f, 1.0f)); };
  return 0.2126f * shown(linear.x) + 0.7152f * shown(linear.y) + 0.0722f * shown(linear.z);
}

/// Pixels within one of a pixel that the truth shows as bright as few others are.
std::vector<char> highlights(const Image& reference) {
  std::vector<char> mask(reference.pixels.size(), 0);
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      if (shown_luma(reference.at(x, y)) < 0.9f) continue;
      for (int v = std::max(0, y - 1); v <= std::min(reference.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(reference.width - 1, x + 1); ++u)
          mask[static_cast<std::size_t>(v * reference.width + u)] = 1;
    }
  return mask;
}

/// Root mean square of the luma's error where `mask` says so; not a number where it never does.
double masked_rmse(const Image& image, const Image& reference, const std::vector<char>& mask) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const double e = shown_luma(image.pixels[i]) - shown_luma(reference.pixels[i]);
    sum += e * e;
    ++count;
  }
  return count == 0 ? std::nan("") : std::sqrt(sum / static_cast<double>(count));
}

/// Share of pixels with a channel that is white at every sample: samples are cut there.
double overexposed(const Image& image) {
  const auto white = [](const glm::vec4& p) { return std::max({p.x, p.y, p.z}) > 0.9999f; };
  return static_cast<double>(std::count_if(image.pixels.begin(), image.pixels.end(), white)) /
         static_cast<double>(image.pixels.size());
}

void errors(const std::string& name, const FrameRequest& request, const Image& reference,
            const Study& study) {
  const std::vector<char> bright = highlights(reference);
  const auto share =
      static_cast<double>(std::count(bright.begin(), bright.end(), 1)) / static_cast<double>(bright.size());
  std::printf(
      "\n### %s\n\nHighlights: %.2f %% of the pixels; overexposed: %.2f %%.\n\n"
      "| technique | PSNR dB | RMSE | SSIM | FLIP | RMSE of highlights |\n|---|---|---|---|---|---|\n",
      name.c_str(), 100.0 * share, 100.0 * overexposed(reference));
  for (const std::string& technique : asked_or(kCompared, study)) {
    try {
      const Image image = frame(technique, request, study);
      const pipeline::ImageError e = pipeline::compare(image, reference);
      std::printf("| `%s` | %.2f | %.4f | %.4f | %.4f | %.4f |\n", technique.c_str(), e.psnr_db, e.rmse,
                  e.ssim, e.flip_mean, masked_rmse(image, reference, bright));
    } catch (const InputError& error) {
      std::printf("| `%s` | %s | | | | |\n", technique.c_str(), error.diagnostics().front().message.c_str());
    }
    std::fflush(stdout);
  }
}

/// The variance over the frames of what differs from each frame's own truth, as a standard deviation: an
/// error that stays where it is does not flicker.
void stability(const std::string& name, const FrameRequest& request, const Study& study) {
  std::vector<FrameRequest> views;
  std::vector<Image> references;
  for (int i = 0; i < study.frames; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(study.frames);
    views.push_back(panned(request, {t, std::fmod(3.0f * t, 1.0f)}));
    references.push_back(truth(views.back(), std::max(16, study.samples / 4), study));
  }
  std::printf("\n### %s, %d frames\n\n| technique | flicker | of `none` |\n|---|---|---|\n", name.c_str(),
              study.frames);
  double of_none = 0.0;
  for (const std::string& technique : asked_or(kWatched, study)) {
    std::vector<double> sum(references.front().pixels.size()), squares(sum.size());
    for (int i = 0; i < study.frames; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Image image = frame(technique, views[k], study);
      for (std::size_t p = 0; p < sum.size(); ++p) {
        const double e = shown_luma(image.pixels[p]) - shown_luma(references[k].pixels[p]);
        sum[p] += e;
        squares[p] += e * e;
      }
    }
    double variance = 0.0;
    for (std::size_t p = 0; p < sum.size(); ++p)
      variance += (squares[p] - sum[p] * sum[p] / study.frames) / study.frames;
    const double flicker = std::sqrt(std::max(0.0, variance / static_cast<double>(sum.size())));
    if (of_none == 0.0) of_none = flicker;
    std::printf("| `%s` | %.4f | %.2f |\n", technique.c_str(), flicker, flicker / of_none);
    std::fflush(stdout);
  }
}

/// Sum of the differences of neighbors in luma: what blur takes away.
double contrast(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y + 1 < image.height; ++y)
    for (int x = 0; x + 1 < image.width; ++x) {
      const float here = shown_luma(image.at(x, y));
      sum +=
          std::abs(here - shown_luma(image.at(x + 1, y))) + std::abs(here - shown_luma(image.at(x, y + 1)));
    }
  return sum;
}

/// What filters do to an image that needs none.
void kept(const std::string& name, const pipeline::RawImage& smooth, const Study& study) {
  FrameRequest request;
  request.scene = std::make_shared<const pipeline::Scene>();
  request.image = std::make_shared<const pipeline::RawImage>(smooth);
  request.width_px = smooth.width;
  request.height_px = smooth.height;
  request.features = every_feature(8);
  pipeline::EmulationOptions options;
  options.jobs = study.jobs;
  const Image before = pipeline::linear_image(smooth);
  std::printf(
      "\n### %s, smooth before it is filtered\n\n| filter | PSNR dB | FLIP | pixels changed %% | contrast "
      "kept "
      "%% |\n|---|---|---|---|---|\n",
      name.c_str());
  for (const char* technique : kFilters) {
    const pipeline::FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
    const Image after = pipeline::emulate(graph, request.features, FunctionalConfig{}, options).color;
    const pipeline::RawImage codes = pipeline::srgb_codes(after);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < codes.texels.size(); ++i) changed += codes.texels[i] != smooth.texels[i];
    const pipeline::ImageError e = pipeline::compare(after, before);
    std::printf("| `%s` | %.2f | %.4f | %.1f | %.1f |\n", technique, e.psnr_db, e.flip_mean,
                100.0 * static_cast<double>(changed) / static_cast<double>(codes.texels.size()),
                100.0 * contrast(after) / contrast(before));
    std::fflush(stdout);
  }
}

int number(std::string_view text) { return std::atoi(std::string(text).c_str()); }

bool parse_part(std::string_view part, Study& study) {
  study.errors = part == "errors";
  study.stability = part == "stability";
  study.kept = part == "kept";
  return study.errors || study.stability || study.kept;
}

/// False where an argument is not understood.
bool parse(std::string_view argument, Study& study) {
  const auto value = [&](std::string_view flag) {
    return argument.starts_with(flag) ? argument.substr(flag.size()) : std::string_view();
  };
  if (const auto text = value("--samples="); !text.empty()) return (study.samples = number(text)) > 0;
  if (const auto text = value("--frames="); !text.empty()) return (study.frames = number(text)) > 1;
  if (const auto text = value("--jobs="); !text.empty()) return (study.jobs = number(text)) > 0;
  if (const auto text = value("--only="); !text.empty()) return parse_part(text, study);
  if (const auto text = value("--lights="); !text.empty()) {
    study.lights = text;
    return text == "scene" || text == "simple" || text == "complex";
  }
  if (const auto text = value("--light_strength="); !text.empty())
    return (study.light_strength = std::atof(std::string(text).c_str())) > 0.0;
  if (const auto text = value("--technique="); !text.empty()) {
    study.techniques.emplace_back(text);
    return true;
  }
  if (const auto text = value("--size="); !text.empty()) {
    const std::size_t cross = text.find('x');
    study.width_px = number(text.substr(0, cross));
    study.height_px = cross == text.npos ? 0 : number(text.substr(cross + 1));
    return study.width_px > 0 && study.height_px > 0;
  }
  if (argument.starts_with("-")) return false;
  study.scenes.emplace_back(argument);
  return true;
}

void run(const std::string& name, const Study& study) {
  const std::string shown = name.substr(name.find_last_of('/') + 1);
  if (name.ends_with(".png")) {
    kept(shown, pipeline::srgb_codes(pipeline::read_image(name)), study);
    return;
  }
  const bool of_papers = study.lights != "scene";
  FrameRequest request = open_study({.scene = name,
                                     .resolution = {study.width_px, study.height_px},
                                     .light_range = of_papers ? 1.0 : 0.15,
                                     .light_strength = study.light_strength,
                                     .lights = study.lights,
                                     .shadows = of_papers,
                                     .metal_ambient = false});  // as the papers' shaders have it
  request.features = every_feature(8);
  if (study.errors || study.kept) {
    const Image reference = truth(request, study.samples, study);
    if (study.errors) errors(shown, request, reference, study);
    if (study.kept) kept(shown, pipeline::srgb_codes(reference), study);
  }
  if (study.stability) stability(shown, request, study);
}

}  // namespace
}  // namespace hwsim::benchmarks

int main(int argc, char** argv) {
  using namespace hwsim;
  using namespace hwsim::benchmarks;
  Study study;
  for (int i = 1; i < argc; ++i)
    if (!parse(argv[i], study)) {
      std::fprintf(
          stderr,
          "quality_study: `%s` is not understood; the head of benchmarks/quality_study.cpp says what is\n",
          argv[i]);
      return 2;
    }
  if (study.scenes.empty())
    for (const pipeline::GeneratorInfo& generator : pipeline::generators())
      study.scenes.push_back(generator.name);
  std::printf(
      "# Quality\n\n%dx%d, lights=%s, against %d samples a pixel traced by rays; sRGB values in [0,1].\n",
      study.width_px, study.height_px, study.lights.c_str(), study.samples);
  try {
    for (const std::string& name : study.scenes) run(name, study);
  } catch (const InputError& error) {
    return report(error);
  }
  return 0;
}
