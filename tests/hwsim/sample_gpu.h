#pragma once
// A GPU with literal values, so that a change to a shipped file cannot move a closed form; and passes built
// by hand.
#include <cstdint>
#include <vector>

#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim::test {

/// One core clock is a nanosecond. Memory is fast enough not to limit unless a test says otherwise.
inline GpuConfig sample_gpu() {
  GpuConfig c;
  c.id = "sample";
  c.title = "sample";
  c.core_clock_mhz = 1000.0;
  c.shader_cores = 10;
  c.fp32_lanes_per_core = 32;
  c.sfu_lanes_per_core = 8;
  c.interp_scalars_per_core_clk = 8;
  c.tex_bilinear_per_clk = 40;
  c.tex_64bit_ratio = 0.5;
  c.tex_128bit_ratio = 0.25;
  c.tex_gather_ratio = 0.8;
  c.tex_comparison_ratio = 0.5;
  c.setup_drawn_triangles_per_clk = 2.0;
  c.setup_culled_triangles_per_clk = 3.5;
  c.raster_engines = 4;
  c.raster_px_per_engine_clk = 8;
  c.raster_samples_per_clk = 256;
  c.hiz_px_per_clk = 512;
  c.export_px_per_clk = 28;
  c.export_64bit_ratio = 0.5;
  c.export_128bit_ratio = 0.25;
  c.crop_units = 40;
  c.crop_srgb32_ratio = 0.5;
  c.crop_half4_64_ratio = 0.5;
  c.crop_float1_32_ratio = 0.6;
  c.crop_bits64_ratio = 0.3;
  c.crop_float4_128_ratio = 0.25;
  c.zrop_samples_per_unit_clk = 4;
  c.l2_size_kib = 640;
  c.l2_bytes_per_clk = 5000;
  c.dram_bandwidth_gb_s = 5000.0;
  c.dram_efficiency_ratio = 1.0;
  c.unit_lines_max =
      46'875;  // as many as keep DRAM busy for its latency of 400 cycles, and half as many again
  c.pass_overhead_us = 0.0;
  return c;
}

inline PassWork repeated(PassKind kind, const PassCounters& chunk, std::size_t chunks) {
  PassWork pass;
  pass.name = "pass";
  pass.kind = kind;
  pass.chunks.assign(chunks, chunk);
  return pass;
}

/// `px` pixels a chunk, each written once by one fragment; no memory traffic.
inline PassWork fill_pass(Format format, bool blended, std::uint64_t px, std::size_t chunks) {
  PassCounters c;
  c.raster.covered_samples = c.raster.fragments = px;
  c.raster.quads = px / 4;
  c.crop.exported_fragments = c.crop.written_samples = c.crop.single_color_fragments = px;
  if (blended) c.crop.blended_samples = px;
  PassWork pass = repeated(PassKind::full_screen, c, chunks);
  pass.color_targets = {{format, 1, blended}};
  return pass;
}

inline FrameTiming time_one(const PassWork& pass, const GpuConfig& gpu, Engine engine = Engine::queue) {
  WorkTrace trace;
  trace.passes = {pass};
  return time_frame(trace, gpu, engine);
}

/// Every doubling of a cache keeps as much of what can be kept; the largest lets `compulsory_ratio` through.
inline MissCurve even_curve(std::uint64_t read, std::uint64_t write, double compulsory_ratio) {
  MissCurve curve;
  curve.requested_read_bytes = read;
  curve.requested_write_bytes = write;
  for (std::size_t k = 0; k < kCacheSizes; ++k) {
    const double kept = static_cast<double>(k) / (kCacheSizes - 1);
    const double moved = 1.0 - kept * (1.0 - compulsory_ratio);
    curve.read_bytes[k] = static_cast<std::uint64_t>(moved * static_cast<double>(read));
    curve.first_read_bytes[k] = static_cast<std::uint64_t>(compulsory_ratio * static_cast<double>(read));
    curve.write_bytes[k] = static_cast<std::uint64_t>(moved * static_cast<double>(write));
  }
  return curve;
}

/// Reuse of all streams of a pass whose chunks are there.
inline void set_reuse(PassWork& pass, double compulsory_ratio) {
  const MemCounters mem = total(pass).mem;
  auto& of = pass.reuse.shared;
  of[index_of(ReuseStream::color)] =
      even_curve(mem.color_read_bytes, mem.color_write_bytes, compulsory_ratio);
  of[index_of(ReuseStream::depth)] =
      even_curve(mem.depth_read_bytes, mem.depth_write_bytes, compulsory_ratio);
  of[index_of(ReuseStream::texture)] = even_curve(mem.texture_read_bytes, 0, compulsory_ratio);
  of[index_of(ReuseStream::storage)] =
      even_curve(mem.storage_read_bytes, mem.storage_write_bytes, compulsory_ratio);
  of[index_of(ReuseStream::geometry)] =
      even_curve(mem.vertex_read_bytes + mem.index_read_bytes, 0, compulsory_ratio);
  pass.reuse.apart = of;
  pass.reuse.texture_l1 = of[index_of(ReuseStream::texture)];
}

/// A pass that gives every unit something to do.
inline PassWork busy_pass(std::size_t chunks) {
  PassWork pass;
  pass.name = "busy";
  pass.kind = PassKind::draw;
  pass.raster_samples = 4;
  pass.depth_format = Format::d32_float;
  pass.depth_samples = 4;
  pass.color_targets = {{Format::rgba8_unorm, 4, true}, {Format::rgba16_float, 4, false}};
  for (std::size_t k = 0; k < chunks; ++k) {
    PassCounters c;
    std::uint64_t n = 100 + 37 * (k % 11);
    for (std::uint64_t& value : values(c)) value = n += 13;
    c.mem.color_write_bytes = c.mem.color_read_bytes = 60'000;
    c.mem.depth_write_bytes = c.mem.depth_read_bytes = 40'000;
    c.mem.vertex_read_bytes = 9'000;
    c.crop.touched_tiles = c.zrop.touched_tiles = 90;
    c.crop.first_touched_tiles = c.zrop.first_touched_tiles = 40;
    c.tex.texels = 4000;
    c.mem.texture_read_bytes = 4000 * 12;
    pass.chunks.push_back(c);
  }
  set_reuse(pass, 0.2);
  return pass;
}

}  // namespace hwsim::test
