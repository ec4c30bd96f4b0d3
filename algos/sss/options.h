#pragma once
// Options of selective supersampling: those that its three variants share
// (docs/techniques/sss.md#parameters), and their own.
#include <cstdint>

#include "algos/base/options.h"
#include "algos/sss/shaders/programs.h"

namespace hwsim::algos {

enum class SssShading : std::uint8_t { scene, phong };
/// What is drawn under the samples: 8x multisampling, or 8 samples with 32 positions of coverage (the paper's
/// "count 8, quality 32"); automatic: as the GPU has them.
enum class SssBase : std::uint8_t { automatic, msaa8x, csaa32x };
enum class SssRest : std::uint8_t { frame, others };  ///< what lies under the samples of a pixel

/// The defaults are the configuration that is compared with the paper's times and pictures.
struct SssOptions {
  double theta_c_deg = 2.0;
  double triangle_px = 4.0;
  double highlight_px = 1.0;
  SssMode mode = SssMode::either;
  bool early_exit = true;
  double threshold = 0.05;
  double samples_per_px = 16.0;
  double samples_min = 4.0;
  double samples_max = 256.0;
  double sparsest_per_px = 8.0;  ///< points
  double border_share = 0.25;
  double depth_bias_steps = 2.0;  ///< steps of 24-bit depth
  double depth_slope = 0.1;
  SssShading shading = SssShading::scene;
  SssBase base = SssBase::automatic;
  SssRest rest = SssRest::others;
};
void describe(OptionList& list, SssOptions& o);

enum class SssPointSource : std::uint8_t { automatic, geometry_shader, tessellator };
struct SssPointOptions {
  SssOptions sss;
  SssPointSource points = SssPointSource::automatic;
  SssPointDepth depth = SssPointDepth::fixed;
};
void describe(OptionList& list, SssPointOptions& o);

enum class SssAtomics : std::uint8_t { automatic, integer, floats };
struct SssComputeOptions {
  SssOptions sss;
  SssAtomics atomics = SssAtomics::automatic;
  int fixed_bits = 20;
  double radiance_max = 1.0;
};
void describe(OptionList& list, SssComputeOptions& o);

enum class SssGrid : std::uint8_t { places_2x2, places_4x4, places_8x8, adaptive };
enum class SssBoxes : std::uint8_t { boxes, raster };  ///< who makes triangles conservative
struct SssListOptions {
  SssOptions sss;
  SssGrid grid = SssGrid::adaptive;
  int node_bytes = 16;
  int capacity_nodes = 0;   ///< 0: four a pixel
  double budget_mib = 0.0;  ///< 0: capacity_nodes says it
  int list_cap = 32;
  SssBoxes conservative = SssBoxes::boxes;
};
void describe(OptionList& list, SssListOptions& o);

}  // namespace hwsim::algos
