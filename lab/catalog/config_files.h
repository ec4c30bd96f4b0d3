#pragma once
// What the configuration folder holds for every run, each file read once for as long as a lab lives: GPUs,
// and the calibration that `fit` wrote (configs/calibrated).
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "cost_models/calibration.h"
#include "hwsim/gpu/gpu_files.h"
#include "lab/catalog/config_folder.h"

namespace hwsim::lab {

/// A GPU as words say it: a file, and what is laid over it.
struct GpuChoice {
  std::string name{};                   ///< an id, or a path that ends in .toml
  std::vector<std::string> overlays{};  ///< names or paths, in the order in which they are laid
  std::vector<Assignment> sets{};       ///< those whose group is "gpu"; they act last
  bool calibrated = true;               ///< with the fitted values, where there are
};

/// Not for several threads at once.
class ConfigFiles {
 public:
  explicit ConfigFiles(ConfigFolder folder = ConfigFolder()) : folder_(std::move(folder)) {}
  const ConfigFolder& folder() const { return folder_; }

  /// The GPU of an id or a file, with overlay files, and those of `sets` whose group is "gpu".
  /// `calibrated`: with the fitted values of its calibrated file, or of the calibrated GPU that its file
  /// extends. Throws InputError with every problem found.
  GpuConfig gpu(const std::string& name, const std::vector<std::string>& overlays,
                std::span<const Assignment> sets, bool calibrated);

  /// The same of a choice, whose overlays may be names. Throws InputError U018 for one that is not there.
  GpuConfig gpu(const GpuChoice& choice);
  /// The files of a choice without its settings, from which many variants are made in any thread.
  GpuFiles gpu_files(const GpuChoice& choice);

  /// calibrated/calibration.json; null when nothing was fitted yet. Throws InputError M006.
  std::shared_ptr<const cost_models::Calibration> calibration();

 private:
  using GpuKey = std::tuple<std::string, std::vector<std::string>, bool>;
  const GpuFiles& kept(const std::string& name, const std::vector<std::string>& overlays, bool calibrated);

  ConfigFolder folder_;
  std::map<GpuKey, GpuFiles> gpus_;
  std::shared_ptr<const cost_models::Calibration> calibration_;
  bool calibration_read_ = false;
};

}  // namespace hwsim::lab
