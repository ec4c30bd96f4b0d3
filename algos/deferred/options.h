#pragma once
// Options of deferred shading.
#include <cstdint>

#include "algos/base/frame_parts.h"
#include "algos/base/options.h"

namespace hwsim::algos {

/// In the order of gbuffer_layouts().
enum class DeferredLayout : std::uint8_t { gb_lauritzen, gb_sbaa40, gb_agaa16, gb_20, gb_mrt4 };

struct DeferredOptions {
  int samples = 8;
  DeferredLayout layout = DeferredLayout::gb_lauritzen;
  bool centroid = true;
  Emulate emulate = Emulate::automatic;
  bool prepass = false;
};

/// How the technique that lights every sample does so.
enum class SampleLighting : std::uint8_t { full_screen, compute_tiles };

struct EverySampleOptions {
  DeferredOptions gbuffer;
  SampleLighting lighting = SampleLighting::full_screen;
};
void describe(OptionList& list, EverySampleOptions& o);

enum class DeferredLighting : std::uint8_t { stencil, compute_tiles };

/// Where compute tiles average the samples of a pixel: in a pass behind them, or in the group's memory.
enum class TileResolve : std::uint8_t { pass, tiles };

struct SimpleComplexOptions {
  DeferredOptions gbuffer;
  DeferredLighting lighting = DeferredLighting::stencil;
  TileResolve resolve = TileResolve::pass;
  double normal_dot_min = 0.99;
  double z_scale = 1.0;
  bool compare_all = false;
  bool alpha_to_coverage = false;
};
void describe(OptionList& list, SimpleComplexOptions& o);

}  // namespace hwsim::algos
