#include "pipeline/graph/validate_coverage.h"

#include <algorithm>

namespace hwsim::pipeline {
namespace {

Diagnostic problem(std::string code, std::string message, std::string help = "") {
  return {Severity::error, std::move(code), std::move(message), {}, {}, {}, std::move(help)};
}

/// State that has no meaning at positions without a sample.
bool is_plain(const PipelineState& s) {
  return !s.raster.conservative && !s.raster.sample_rate && s.raster.sample_positions.empty() &&
         !s.coverage.override_output && !s.coverage.alpha_to_coverage;
}

}  // namespace

std::string text(const ImageDesc& image) {
  return "`" + image.name + "` (" + std::string(info(image.format).name) + ", " +
         std::to_string(image.width) + "x" + std::to_string(image.height) + ", " +
         std::to_string(image.samples) + "x)";
}

std::vector<Diagnostic> check_coverage_samples(const ImageDesc& image, const GpuFeatures& features) {
  const int n = image.coverage_samples, k = image.samples;
  const bool pattern =
      (k == 2 && n == 4) || (k == 4 && (n == 8 || n == 16)) || (k == 8 && (n == 16 || n == 32));
  if (!pattern)
    return {problem("G002", "image " + text(image) + " has " + std::to_string(n) + " coverage samples for " +
                                std::to_string(k) +
                                " color samples: 4 for 2, 8 for 4, 16 for 4 or 8, 32 for 8")};
  if (n <= features.coverage_samples_max) return {};
  const std::string has =
      features.coverage_samples_max == 0 ? "none" : std::to_string(features.coverage_samples_max);
  return {problem("G006",
                  "image " + text(image) + " needs " + std::to_string(n) +
                      " coverage samples, this GPU has " + has + " (gpu.features.coverage_samples_max)",
                  "gpu.features.coverage_samples_max = " + std::to_string(n) + " makes it native")};
}

std::vector<Diagnostic> check_coverage_pass(const FrameGraph& graph, const Pass& pass) {
  std::vector<Diagnostic> found;
  for (const ImageId id : pass.color)
    if (const ImageDesc& image = graph.image(id); image.coverage_samples != pass.coverage_samples)
      found.push_back(problem("G002", "pass `" + pass.name + "` finds coverage at " +
                                          std::to_string(pass.coverage_samples) + " positions, image " +
                                          text(image) + " has a map of " +
                                          std::to_string(image.coverage_samples)));
  if (pass.coverage_samples == 0) return found;
  const bool all_plain = std::all_of(pass.batches.begin(), pass.batches.end(),
                                     [](const DrawBatch& b) { return is_plain(b.state); });
  if (pass.kind != PassKind::draw || pass.color.size() != 1 || !pass.depth || !pass.viewports.empty() ||
      !all_plain)
    found.push_back(problem(
        "G010",
        "pass `" + pass.name + "` finds coverage at more positions than it has samples, and is no plain " +
            "draw into one color and one depth image",
        "no sample-rate shading, masks, own positions, conservative raster or several viewports"));
  return found;
}

bool shows_samples(const Pass& pass, ImageId id) {
  for (std::size_t slot = 0; slot < std::min(pass.sampled.size(), pass.views.size()); ++slot)
    if (pass.sampled[slot] == id) return pass.views[slot] != Format::none;
  return false;
}

}  // namespace hwsim::pipeline
