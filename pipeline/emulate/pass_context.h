#pragma once
// What stays the same during a pass, and what each worker thread keeps to itself.
#include <memory>
#include <span>
#include <vector>

#include "pipeline/base/arena.h"
#include "pipeline/batch/geometry_batch.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/emulate/segment.h"
#include "pipeline/raster/clip.h"

namespace hwsim::pipeline {

struct PassContext {
  const Pass* pass = nullptr;
  GpuImage* depth = nullptr;
  float depth_scale = 0.0f;  ///< see memory/depth_format.h
  int depth_bytes = 0;       ///< a sample's size, for byte counts
  std::vector<GpuImage*> color;
  int width = 0, height = 0, samples = 1;
  int bins_x = 0, bins_y = 0;
  std::span<const SamplePosition> positions;
  /// Where coverage is found: `positions`, and in a pass with a coverage map those behind them.
  std::span<const SamplePosition> coverage_positions;
  CentroidRule centroid;                     ///< over `coverage_positions`
  GpuImage* coverage_map = nullptr;          ///< the color image that has one
  std::span<const ViewportShift> viewports;  ///< at least one
  GuardBand band;
  int sample_min_x = 0, sample_min_y = 0, sample_max_x = 0, sample_max_y = 0;
  ResourceView resources;
  std::vector<DrawInfo> draws;
  std::uint32_t chunk_primitives = 1;  ///< triangles of a chunk
  std::size_t chunk_count = 1;
  std::uint32_t* heat =
      nullptr;  ///< invocations of each pixel, tile by tile as in GpuImage; null: not wanted
  int heat_blocks_x = 0;
  int heat_shift = 0;  ///< the heat image's pixels are this much coarser (log2)
  SkipSwitches skip;
  bool hierarchical_z = true;
};

/// The covered samples of a quad: bit i of masks[s] is its lane i.
struct QuadSamples {
  std::uint8_t masks[kMaxSamples];
};

struct BinWorker {
  FragmentBatch batch;
  std::array<std::int32_t, kBatchQuads> block;  ///< tile of each quad in the targets
  std::array<std::int32_t, kBatchQuads> quad_in_block;
  alignas(64) std::array<std::int32_t, kBatchQuads> place{};  ///< both in one number
  std::array<QuadSamples, kBatchQuads> samples;
  std::array<QuadSamples, kBatchQuads>
      primitive_samples;                              ///< before depth and stencil, where they are asked for
  FragmentBatch sample_batch;                         ///< sample-rate shading: the quads that have the sample
  std::array<std::int32_t, kBatchQuads> sample_quad;  ///< by quad of sample_batch: its number in `batch`
  /// Triangles that the quads of `batch` belong to, and one more that is set up.
  std::array<RasterTriangle, kBatchQuads + 1> triangles;
  std::size_t next_triangle = 0;

  BuiltPrimitives built;  ///< what the item at hand comes to
  Arena arena;            ///< holds what the segment's items hold

  ResourceView resources;  ///< the pass's, with the trackers of this worker
  AccessTracker tracker;
  std::unique_ptr<GeometryBatch> geometry_batch;  ///< made where a geometry shader runs
  std::vector<ImageStore> stores;
  std::vector<PassCounters> chunks;
  std::uint32_t current_chunk = 0;
  std::uint64_t hidden_tiles_skipped = 0;
  std::uint64_t hidden_samples_passed = 0;  ///< 0, or the coarse test is wrong; known with its skip off
  std::uint64_t accepted_tiles_skipped = 0;
  std::uint64_t plane_tiles_skipped = 0;
  const DrawInfo* draw = nullptr;  ///< the draw whose quads are in `batch`
  const PipelineState* state = nullptr;
  const FragmentProgram* program = nullptr;
  const void* uniforms = nullptr;
  bool late_z = false;
  bool early_reject =
      false;  ///< with late_z: samples that fail the depth test already are dropped before shading

  PassCounters& counters() { return chunks[current_chunk]; }
};

/// Rasterizes, tests, shades and writes one screen bin: all triangles of the segment, in order, layer by
/// layer.
void run_bin(const PassContext& context, const Segment& segment, int bin, BinWorker& worker);
/// Shades one screen bin of a full-screen pass.
void run_full_screen_bin(const PassContext& context, int bin, BinWorker& worker);

/// Whether depth and stencil are tested after the shader (docs/hardware_sources.md#early-depth).
bool tests_late(const PipelineState& state, const FragmentProgram* program);
/// Whether a late test has a first one, without writes, before the shader.
bool rejects_early(const PipelineState& state, const FragmentProgram* program);

/// Counts the use of a tile: once a chunk, and once a pass.
template <class UnitCounters>
void touch_tile(GpuImage& image, int block, std::uint32_t chunk, UnitCounters& counters) {
  std::uint32_t& last = image.touched_chunk[static_cast<std::size_t>(block)];
  if (last == chunk + 1) return;
  counters.touched_tiles += 1;
  counters.first_touched_tiles += last == 0 ? 1 : 0;
  last = chunk + 1;
}

}  // namespace hwsim::pipeline
