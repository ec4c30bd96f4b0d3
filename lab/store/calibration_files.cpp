#include "lab/store/calibration_files.h"

#include <filesystem>

#include "lab/base/files.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

fs::path calibrated_directory() { return fs::path(config_directory()) / "calibrated"; }

}  // namespace

std::optional<cost_models::Calibration> load_calibration() {
  const fs::path path = calibrated_directory() / "calibration.json";
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return cost_models::calibration_from_json(read_file(path.string()), path.string());
}

std::string gpu_file(const std::string& name) {
  const fs::path path = calibrated_directory() / (name + ".toml");
  std::error_code error;
  return fs::exists(path, error) ? path.string() : name;
}

void add_interval(FrameTiming& timing, const WorkTrace& trace, const GpuConfig& gpu,
                  const std::string& technique) {
  const std::optional<cost_models::Calibration> calibration = load_calibration();
  if (!calibration) return;
  const cost_models::FrameInterval found =
      cost_models::frame_interval(*calibration, trace, gpu, technique, timing.engine);
  timing.support = found.support;
  timing.interval_ns = found.interval_ns;
}

}  // namespace hwsim::lab
