#pragma once
// Options of the forward techniques.
#include "algos/base/frame_parts.h"
#include "algos/base/options.h"

namespace hwsim::algos {

struct PlainOptions {
  bool prepass = false;
};
void describe(OptionList& list, PlainOptions& o);

enum class SsaaVariant : std::uint8_t { ordered, accumulate, sample_rate };
struct SsaaOptions {
  int samples = 4;  ///< a square
  SsaaVariant variant = SsaaVariant::ordered;
};
void describe(OptionList& list, SsaaOptions& o);

struct MsaaOptions {
  int samples = 4;
  bool centroid = true;
  bool prepass = false;
};
void describe(OptionList& list, MsaaOptions& o);

/// Beyond eight samples, which GPUs may lack.
struct ManySamplesOptions {
  MsaaOptions msaa;
  Emulate emulate = Emulate::automatic;
};
void describe(OptionList& list, ManySamplesOptions& o);

enum class OrphanPositions : std::uint8_t { follow, drop };
struct CoverageOptions {
  bool centroid = true;
  OrphanPositions orphans = OrphanPositions::follow;
};
enum class CsaaMode : std::uint8_t { x8, x8q, x16, x16q, x32 };
struct CsaaOptions {
  CsaaMode mode = CsaaMode::x16;
  CoverageOptions coverage;
};
void describe(OptionList& list, CsaaOptions& o);
enum class EqaaMode : std::uint8_t { f2x4, f4x8, f8x16 };  ///< color samples, positions
struct EqaaOptions {
  EqaaMode mode = EqaaMode::f4x8;
  CoverageOptions coverage;
};
void describe(OptionList& list, EqaaOptions& o);

struct ForwardPlusOptions {
  int samples = 1;
  bool centroid = true;
};
void describe(OptionList& list, ForwardPlusOptions& o);

}  // namespace hwsim::algos
