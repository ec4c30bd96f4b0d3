#pragma once
// A kept frame on many variants of one GPU, timed in threads: a point costs a replay, and nothing else.
#include <array>
#include <optional>
#include <vector>

#include "lab/catalog/config_files.h"
#include "lab/studies/axes.h"
#include "lab/studies/kept_frame.h"

namespace hwsim::lab {

struct VariantTime {
  double time_ms = 0.0;
  std::optional<std::array<double, 2>> interval_ms{};  ///< 90 %; none without a calibration
  Support support = Support::uncalibrated;
  double dram_mb = 0.0;
  bool operator==(const VariantTime&) const = default;
};

/// The variants of a GPU: its files, the settings that all of them share, and those of each (`gpu.*`).
struct GpuVariants {
  GpuFiles files;
  std::vector<Assignment> sets;
  const PointSettings& each;
};

/// The frame on each variant, in the order of the settings. The observer hears of progress. Throws InputError
/// with the problems of the variants that are none, of about a thousand at a time.
std::vector<VariantTime> time_variants(const KeptFrame& frame, const GpuVariants& variants, int jobs,
                                       Observer& observer);

}  // namespace hwsim::lab
