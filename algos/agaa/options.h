#pragma once
// Options of aggregate G-buffer anti-aliasing.
#include <cstdint>

#include "algos/agaa/layout.h"
#include "algos/agaa/shaders/programs.h"
#include "algos/base/frame_parts.h"
#include "algos/base/options.h"

namespace hwsim::algos {

enum class AgaaBrdf : std::uint8_t { blinn_phong, ggx };
/// `automatic`: folded in a Toksvig vector, from the samples' normals with other distributions.
enum class AgaaDiffuse : std::uint8_t { automatic, off, folded, geometric, samples };
enum class AgaaGloss : std::uint8_t { folded, separate };
enum class AgaaScale : std::uint8_t { world, footprint };  ///< what the length k is measured by
enum class AgaaMeanNormal : std::uint8_t { unit, raw };    ///< in the search of the first seed
enum class AgaaAccumulate : std::uint8_t { automatic, blend, atomics };
enum class AgaaPlanePath : std::uint8_t { automatic, on, off, given };
enum class AgaaShadowAxis : std::uint8_t { depth, places, receiver };

struct AgaaOptions {
  int aggregates = 2;
  int samples = 8;
  double k_m = 0.1;
  double separation = 0.02;  ///< the t of the paper
  Ndf ndf = Ndf::toksvig;
  AgaaBrdf brdf = AgaaBrdf::blinn_phong;
  AgaaDiffuse diffuse = AgaaDiffuse::automatic;
  AgaaGloss gloss = AgaaGloss::folded;
  AgaaScale k_mode = AgaaScale::world;
  double footprint_px = 8.0;
  AgaaMeanNormal mean_normal = AgaaMeanNormal::unit;
  SeedRule seeds = SeedRule::farthest;
  int shadow_taps = 4;
  MaskStore mask = MaskStore::natural;
  bool half_floats = false;
  bool depth_moments = false;
  bool light_variance = false;
  int visible_normals = 8;
  double gloss_reference = 0.0;  ///< Toksvig's reference exponent; 0: infinite
  double matte_exponent = 32.0;  ///< what diffuse light adds to the exponent that the vector holds
  Emulate emulate = Emulate::automatic;
  AgaaAccumulate accumulate = AgaaAccumulate::automatic;
  bool centroid = true;
  AgaaPlanePath plane_path = AgaaPlanePath::automatic;
  bool empty_exit = false;
  bool alpha_dither = true;
  AgaaShadowAxis shadow_axis = AgaaShadowAxis::receiver;
};
void describe(OptionList& list, AgaaOptions& o);

}  // namespace hwsim::algos
