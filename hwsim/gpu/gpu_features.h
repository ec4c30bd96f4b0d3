#pragma once
// What the GPU can do at all. A technique that needs a switch that is off takes its documented emulation, or
// ends in an error that names the switch ("gpu.features.native_msaa_max"). These and FunctionalConfig are the
// only parts of a GPU that change what the functional emulator does; everything else only changes the timing.
namespace hwsim {

struct GpuFeatures {
  int native_msaa_max = 8;
  int coverage_samples_max = 0;  ///< positions of coverage beyond the color samples (CSAA, EQAA); 0: none
  bool target_independent_raster = false;
  bool post_depth_coverage = false;
  bool coverage_override = false;
  bool viewport_multicast = false;
  bool programmable_sample_positions = false;
  bool conservative_raster = false;
  bool compressed_depth_read = false;
  bool float_atomics = false;
  bool append_consume = true;
  bool tessellator_points = false;
  bool fragment_interlock = false;
};

struct FunctionalConfig {
  int post_transform_cache_entries = 32;  ///< FIFO
  int gs_max_scalars = 1024;      ///< 32-bit values of all vertices that one geometry shader invocation emits
  bool late_z_on_discard = true;  ///< where shaders discard: docs/hardware_sources.md#early-depth
  bool hierarchical_z = true;     ///< off: every covered sample is tested one by one
  int max_image_px = 16384;       ///< largest width or height of a render target
};

}  // namespace hwsim
