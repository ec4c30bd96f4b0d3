#pragma once
// Options of surface based anti-aliasing.
#include <cstdint>

#include "algos/base/options.h"

namespace hwsim::algos {

enum class SbaaBackground : std::uint8_t { weighted, ignore };

struct SbaaOptions {
  int surfaces = 2;
  int samples = 8;
  int id_bits = 7;
  int record_bytes = 32;
  SbaaBackground background = SbaaBackground::weighted;
  bool centroid = true;
  bool empty_exit = false;
};
void describe(OptionList& list, SbaaOptions& o);

enum class SbaaMergeDepth : std::uint8_t { stored, linear };

struct SbaaMergeOptions {
  SbaaOptions sbaa;
  double alpha_rad = 0.19634954084936207;  ///< pi / 16
  double end_region = 0.25;                ///< share of the depth range
  SbaaMergeDepth merge_depth = SbaaMergeDepth::stored;
  bool pack_id_normal = false;
};
void describe(OptionList& list, SbaaMergeOptions& o);

}  // namespace hwsim::algos
