#pragma once
// What a lab is told when it is made: its folders, its limits, and who listens.
#include <cstdint>
#include <string>

#include "lab/base/observer.h"

namespace hwsim::lab {

inline constexpr std::uint64_t kDefaultCacheLimitBytes = std::uint64_t{4} << 30;
inline constexpr std::uint64_t kDefaultSharedPassesBytes = std::uint64_t{64} << 20;

struct LabOptions {
  std::string config_folder{};  ///< gpus, overlays, published tables, calibration; empty: those of hwsim
  std::string page_folder{};    ///< parts of a report's page; empty: those built with hwsim
  std::string cache_folder{};   ///< for what can be made anew; empty: nothing outlives the lab
  std::uint64_t cache_limit_bytes = kDefaultCacheLimitBytes;  ///< what the traces on the disk may take
  /// What images of passes that techniques of one view share may take in memory; 0: each technique emulates
  /// all of its passes.
  std::uint64_t shared_passes_bytes = kDefaultSharedPassesBytes;
  int jobs = 1;                  ///< threads
  bool use_cache = true;         ///< false: traces are neither read from the disk nor kept there
  Observer* observer = nullptr;  ///< hears of progress, notes and warnings; outlives the lab; none: silence
};

}  // namespace hwsim::lab
