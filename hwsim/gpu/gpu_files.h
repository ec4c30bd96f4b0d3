#pragma once
// The files of a GPU, read once: what varies numbers of a GPU takes each variant from the same texts.
#include <memory>
#include <span>
#include <string>

#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

/// A base file with its chain of parents and overlays, as load_gpu takes them. Cheap to copy.
class GpuFiles {
 public:
  /// Reads the files. What is wrong in them is thrown by `with`, together with what is wrong in the settings.
  /// `preferred_dir`: where an id is looked for first, that of a parent too; empty: nowhere.
  GpuFiles(const std::string& id_or_path, std::span<const std::string> overlays,
           const std::string& config_dir, const std::string& preferred_dir = {});

  /// The GPU with those of `sets` whose group is "gpu": what load_gpu gives. Throws InputError with every
  /// problem found.
  GpuConfig with(std::span<const Assignment> sets) const;

 private:
  class Loader;
  std::shared_ptr<const Loader> read_;
  std::shared_ptr<const GpuConfig> plain_;  ///< without settings; null where something is wrong in the files
};

}  // namespace hwsim
