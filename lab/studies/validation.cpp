#include "lab/studies/validation.h"

#include <chrono>

#include "cost_models/calibration.h"
#include "lab/base/files.h"
#include "lab/base/stage_progress.h"

namespace hwsim::lab {

Validation validate(cost_models::Experiment experiment, const cost_models::FitOptions& options,
                    Observer& observer) {
  const auto start = std::chrono::steady_clock::now();
  const StageProgress progress(observer, 1);
  Validation validation{std::move(experiment), {}, 0.0};
  validation.figures = cost_models::validate(
      validation.experiment, options, [&](std::size_t done, std::size_t all, const std::string& what) {
        if (done == 1)
          validation.fit_wall_s =
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        progress.update(static_cast<double>(done) / static_cast<double>(all), what);
      });
  return validation;
}

void write_calibration(const Validation& validation, const OutPlace& place) {
  OutPlace out = place;
  if (out.directory.empty()) out.directory = "calibrated";
  RunDirectory directory(out, "fit");
  const cost_models::Calibration calibration =
      cost_models::make_calibration(validation.experiment, validation.figures);
  for (const GpuConfig& gpu : validation.experiment.gpus)
    if (calibration.techniques.contains(gpu.id))
      write_file(directory.path(gpu.id + ".toml"), cost_models::calibrated_file(gpu, calibration));
  write_file(directory.path("calibration.json"), cost_models::to_json(calibration));
  write_file(directory.path("manifest.json"), "{\"written_by\": \"hwsim fit\"}\n");
  directory.commit();
}

}  // namespace hwsim::lab
