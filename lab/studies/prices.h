#pragma once
// What the parts of a GPU cost, in area units, and between which bounds they may be chosen: a small TOML
// file.
#include <string>
#include <vector>

#include "hwsim/gpu/gpu_config.h"

namespace hwsim::lab {

/// A real number of a GPU that may be chosen.
struct PricedKey {
  std::string key{};                  ///< "l2_size_kib"
  double area = 0.0;                  ///< one of its unit takes it
  double low = 0.0, high = 0.0;       ///< inclusive
  double step = 0.0;                  ///< from `low` on; 0: every number between the bounds
  std::vector<std::string> scales{};  ///< keys that grow and shrink with it
};

struct PriceList {
  std::string path{};
  double base_area = 0.0;  ///< all that stays takes it
  std::vector<PricedKey> keys{};

  double area_of(const std::vector<double>& values) const;
};

/// Throws InputError with every mistake: C010 to C015, C019 as in other files; C026 for prices and bounds
/// that are none, and keys that `gpu` does not have or that no time depends on.
PriceList read_prices(const std::string& path, const GpuConfig& gpu);

/// What the keys are in a GPU, in the order of the list.
std::vector<double> values_in(const PriceList& prices, const GpuConfig& gpu);

/// The GPU with other values of the keys, and what scales with them. Nothing is checked: a number of units
/// may be 3.5 on the way to 3 or 4.
GpuConfig with_values(const GpuConfig& gpu, const PriceList& prices, const std::vector<double>& values);

/// The same as settings, for a GPU that is checked.
std::vector<Assignment> settings_for(const GpuConfig& gpu, const PriceList& prices,
                                     const std::vector<double>& values);

}  // namespace hwsim::lab
