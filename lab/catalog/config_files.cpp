#include "lab/catalog/config_files.h"

#include <filesystem>

#include "lab/base/files.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

}  // namespace

const GpuFiles& ConfigFiles::kept(const std::string& name, const std::vector<std::string>& overlays,
                                  bool calibrated) {
  const GpuKey key{name, overlays, calibrated};
  auto known = gpus_.find(key);
  if (known == gpus_.end())
    known = gpus_
                .emplace(key, GpuFiles(name, overlays, folder_.gpus(),
                                       calibrated ? folder_.calibrated() : std::string()))
                .first;
  return known->second;
}

GpuConfig ConfigFiles::gpu(const std::string& name, const std::vector<std::string>& overlays,
                           std::span<const Assignment> sets, bool calibrated) {
  return kept(name, overlays, calibrated).with(sets);
}

GpuConfig ConfigFiles::gpu(const GpuChoice& choice) { return gpu_files(choice).with(choice.sets); }

GpuFiles ConfigFiles::gpu_files(const GpuChoice& choice) {
  std::vector<std::string> files;
  for (const std::string& overlay : choice.overlays) files.push_back(folder_.overlay_file(overlay));
  return kept(choice.name, files, choice.calibrated);
}

std::shared_ptr<const cost_models::Calibration> ConfigFiles::calibration() {
  if (calibration_read_) return calibration_;
  const fs::path path = fs::path(folder_.calibrated()) / "calibration.json";
  std::error_code error;
  if (fs::exists(path, error))
    calibration_ = std::make_shared<const cost_models::Calibration>(
        cost_models::calibration_from_json(read_file(path.string()), path.string()));
  calibration_read_ = true;
  return calibration_;
}

}  // namespace hwsim::lab
