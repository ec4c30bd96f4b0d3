#pragma once
// Every key of a GPU file: those of the units (hwsim/units), of features and of what the emulator asks.
#include "hwsim/config/key.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

/// The numbers of the timing model, for any scalar type.
template <class V, class T>
void describe(V& v, GpuValues<T>& c) {
#define HWSIM_PART_KEYS(id, Name) units::Name::describe(v, c);
  HWSIM_GPU_PARTS(HWSIM_PART_KEYS)
#undef HWSIM_PART_KEYS
}

template <class V>
void describe(V& v, GpuFeatures& f) {
  v.key({"features.native_msaa_max", 1, 64, kNoFlags, "largest sample count; a power of two"},
        f.native_msaa_max);
  v.key({"features.coverage_samples_max", 0, 32, kNoFlags,
         "coverage samples of a pixel beyond its color samples (CSAA, EQAA), both together; 0: none"},
        f.coverage_samples_max);
  v.key({"features.target_independent_raster", 0, 0, kNoFlags, "more raster samples than color samples"},
        f.target_independent_raster);
  v.key({"features.post_depth_coverage", 0, 0, kNoFlags, "shaders read the coverage after the depth test"},
        f.post_depth_coverage);
  v.key({"features.coverage_override", 0, 0, kNoFlags, "shaders widen the coverage"}, f.coverage_override);
  v.key({"features.viewport_multicast", 0, 0, kNoFlags,
         "one triangle to several viewports without a geometry shader"},
        f.viewport_multicast);
  v.key({"features.programmable_sample_positions", 0, 0, kNoFlags, "positions set by the application"},
        f.programmable_sample_positions);
  v.key({"features.conservative_raster", 0, 0, kNoFlags, "every pixel that a triangle touches"},
        f.conservative_raster);
  v.key({"features.compressed_depth_read", 0, 0, kNoFlags, "shaders read depth planes without decompression"},
        f.compressed_depth_read);
  v.key({"features.float_atomics", 0, 0, kNoFlags, "atomic addition of floats in buffers"}, f.float_atomics);
  v.key({"features.append_consume", 0, 0, kNoFlags, "counters of append and consume buffers"},
        f.append_consume);
  v.key({"features.tessellator_points", 0, 0, kNoFlags, "the tessellator emits points"},
        f.tessellator_points);
  v.key({"features.fragment_interlock", 0, 0, kNoFlags, "ordered read-modify-write of a pixel by shaders"},
        f.fragment_interlock);
}

template <class V>
void describe(V& v, FunctionalConfig& f) {
  v.key(
      {"functional.post_transform_cache_entries", 0, 4096, kNoFlags, "shaded vertices kept for reuse, FIFO"},
      f.post_transform_cache_entries);
  v.key({"functional.gs_max_scalars", 16, 65536, kNoFlags,
         "32-bit values of all vertices that one geometry shader invocation emits"},
        f.gs_max_scalars);
  v.key({"functional.late_z_on_discard", 0, 0, kNoFlags, "depth is written after a shader that can discard"},
        f.late_z_on_discard);
  v.key({"functional.hierarchical_z", 0, 0, kNoFlags,
         "a coarse depth test rejects and accepts 8x8 tiles whole"},
        f.hierarchical_z);
  v.key({"functional.max_image_px", 1, 65536, kNoFlags, "largest width or height of an image"},
        f.max_image_px);
}

template <class V>
void describe(V& v, GpuConfig& c) {
  v.key({"title", 0, 0, kRequired, "name for people"}, c.title);
  v.key({"vendor", 0, 0, kNoFlags, "maker"}, c.vendor);
  v.key({"architecture", 0, 0, kNoFlags, "chip and generation"}, c.architecture);
  describe(v, static_cast<GpuValues<double>&>(c));
  describe(v, c.features);
  describe(v, c.functional);
}

}  // namespace hwsim
