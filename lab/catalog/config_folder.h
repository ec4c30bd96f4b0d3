#pragma once
// The folder of data files that hwsim reads: GPUs, overlays, published tables, calibration.
#include <string>
#include <vector>

namespace hwsim::lab {

class ConfigFolder {
 public:
  /// Without a name: ../share/hwsim/configs beside the program's folder, else the source tree that it was
  /// built from. Nothing is looked for yet.
  explicit ConfigFolder(std::string named = {}) : named_(std::move(named)) {}

  /// Throws InputError U012 when there is no such folder, as do all below.
  std::string path() const;
  std::string gpus() const;         ///< a file a GPU
  std::string published() const;    ///< the papers' tables
  std::string external() const;     ///< other renderers' times, never fitted
  std::string calibration() const;  ///< parameters of the fit, and stated accuracies
  std::string calibrated() const;   ///< what a fit left behind

  /// Overlays that come with hwsim: what-ifs and hardware wishes, a file each.
  std::vector<std::string> overlay_names() const;
  /// The file of an overlay: a path that ends in .toml as it is, a name from the folder. Throws InputError
  /// U018.
  std::string overlay_file(const std::string& name_or_path) const;

  /// The file of a list of prices: a path that ends in .toml as it is, a name from the folder. Throws
  /// InputError C010.
  std::string prices_file(const std::string& name_or_path) const;

 private:
  std::string named_;
};

}  // namespace hwsim::lab
