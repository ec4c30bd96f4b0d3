// Every rate and cost of a GPU file acts on some pass, and in the right direction.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

// Moves a key in the direction that must not slow the GPU down.
void improve(const Key& key) {
  const double sign = key.info.has(kRate) ? 1.0 : -1.0;
  if (auto* const* number = std::get_if<double*>(&key.slot))
    **number = std::clamp(sign > 0 ? **number * 1.5 : **number / 1.5, key.info.low, key.info.high);
  if (auto* const* whole = std::get_if<int*>(&key.slot)) **whole += static_cast<int>(sign);
}

TEST(Engines, NoTimeGrowsWhenAKeyImproves) {
  WorkTrace trace;
  trace.passes = {busy_pass(90), fill_pass(Format::rgba16_float, true, 1000, 40)};
  GpuConfig base = sample_gpu();
  base.dram_bandwidth_gb_s = 100.0;
  base.ia_indices_per_clk = 5.0;
  base.resolve_samples_per_clk = 50.0;
  base.rop_through_l2 = false;
  base.pass_overhead_us = 3.0;
  base.dram_cpu_share_ratio = 0.1;
  int moved = 0;
  for (const Engine engine : {Engine::roofline, Engine::queue}) {
    const double before = time_frame(trace, base, engine).time_ns;
    for (const KeyInfo& info : gpu_keys()) {
      if (!info.has(kRate) && !info.has(kCost)) continue;
      GpuConfig gpu = base;
      for (const Key& key : keys_of(gpu))
        if (key.info.name == info.name) improve(key);
      const double after = time_frame(trace, gpu, engine).time_ns;
      // Within a chunk the queue engine's units work along straight lines: so exact, and no more.
      EXPECT_LE(after, before * (engine == Engine::queue ? 1.0 + 1e-3 : 1.0 + 1e-12))
          << info.name << " in " << engine_name(engine);
      moved += after < before ? 1 : 0;
    }
  }
  EXPECT_GT(moved, 40) << "many keys matter to a pass that uses every unit";
}

using Fill = std::function<void(PassCounters&)>;

PassWork pass_of(const Fill& fill, Format color = Format::none, int samples = 1) {
  PassCounters c;
  fill(c);
  PassWork pass = repeated(PassKind::draw, c, 4);
  pass.raster_samples = samples;
  if (color != Format::none) pass.color_targets = {{color, samples, false}};
  return pass;
}

/// Passes that each load one path of one unit, so that no other unit hides it.
std::vector<PassWork> single_path_passes() {
  std::vector<PassWork> passes = {
      pass_of([](PassCounters& c) { c.fe.draws = 9; }),
      pass_of([](PassCounters& c) { c.fe.state_changes = 9; }),
      pass_of([](PassCounters& c) { c.stats.input_assembly_vertices = 999; }),
      pass_of([](PassCounters& c) { c.setup.in_primitives = 999; }),
      pass_of([](PassCounters& c) { c.setup.out_primitives = 999; }),
      pass_of([](PassCounters& c) { c.raster.quads = 999; }),
      pass_of([](PassCounters& c) { c.raster.covered_samples = 99'999; }, Format::none, 64),
      pass_of([](PassCounters& c) { c.raster.visited_tiles = 999; }),
      pass_of([](PassCounters& c) { c.hiz.tested_tiles = 999; }),
      pass_of([](PassCounters& c) { c.zrop.written_samples = 999; }),
      pass_of([](PassCounters& c) { c.shader.alu_issued_lane_ops_w32 = 999; }),
      pass_of([](PassCounters& c) { c.shader.sfu_issued_lane_ops_w32 = 999; }),
      pass_of([](PassCounters& c) { c.shader.interp_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.load_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.group_memory_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.atomic_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.gs.output_bytes = 9999; }),
      pass_of([](PassCounters& c) { c.tex.bilinear_probes = 999; }),
      pass_of([](PassCounters& c) { c.tex.fetched_64bit_texels = 999; }),
      pass_of([](PassCounters& c) { c.tex.fetched_128bit_texels = 999; }),
      pass_of([](PassCounters& c) { c.shader.same_address_atomic_lane_ops = 999; }),
      pass_of([](PassCounters& c) {
        c.stats.fragment_shader_invocations = c.shader.alu_chain_lane_ops = 9999;
        c.shader.register_lanes = 9999;
      }),
      pass_of([](PassCounters& c) {
        c.stats.fragment_shader_invocations = c.shader.memory_chain_lane_ops = 9'999'999;
        c.shader.register_lanes = 9'999'999 * std::uint64_t{200};
        c.tex.requests = 9999;
      }),
      pass_of([](PassCounters& c) { c.mem.texture_read_bytes = 99'999; }),
      pass_of([](PassCounters& c) { c.resolve.read_samples = 999; }),
      pass_of([](PassCounters& c) { c.crop.exported_fragments = 9, c.crop.written_samples = 72; },
              Format::rgba8_unorm, 8),
  };
  for (const bool blended : {false, true})
    for (const Format f : {Format::rgba8_unorm, Format::rgba8_srgb, Format::rgba16_float, Format::r32_float,
                           Format::rg32_float, Format::rgba32_float})
      passes.push_back(fill_pass(f, blended, 1000, 4));
  PassWork clear;
  clear.kind = PassKind::clear;
  clear.width_px = clear.height_px = 640;
  clear.color_targets = {{Format::rgba8_unorm, 1, false}};
  clear.depth_format = Format::d32_float;
  passes.push_back(clear);
  PassWork memory = busy_pass(90);
  for (PassCounters& c : memory.chunks) {
    PassCounters only;
    only.mem = c.mem;
    only.zrop.read_four_plane_tiles = only.zrop.write_four_plane_tiles = 90;
    c = only;
  }
  PassWork textures = memory;
  for (PassCounters& c : textures.chunks) {
    PassCounters only;
    only.mem.texture_read_bytes = 999'999;
    c = only;
  }
  set_reuse(textures, 0.2);
  passes.push_back(textures);
  PassWork waiting = textures;
  for (PassCounters& c : waiting.chunks) {
    c.stats.fragment_shader_invocations = c.shader.memory_chain_lane_ops = 9'999'999;
    c.shader.register_lanes = 9'999'999 * std::uint64_t{200};
    c.tex.requests = 9'999'999;
  }
  passes.push_back(waiting);
  PassWork grouped = waiting;  // group memory, not registers, bounds what a core holds
  grouped.group_memory_lane_bytes = 512;
  for (PassCounters& c : grouped.chunks) c.shader.register_lanes = 9'999'999;
  passes.push_back(grouped);
  passes.push_back(memory);
  PassWork binned = pass_of([](PassCounters& c) { c.raster.visited_tiles = 99'999; }, Format::rgba32_float);
  passes.push_back(binned);
  PassWork uneven = pass_of([](PassCounters& c) { c.setup.in_primitives = 9999; });
  uneven.chunks.resize(20, uneven.chunks.front());
  for (std::size_t i = 0; i < uneven.chunks.size(); i += 2) {
    uneven.chunks[i].setup.in_primitives = 0;
    uneven.chunks[i].raster.quads = 9999;
  }
  passes.push_back(uneven);
  PassWork color = memory;
  color.color_targets = {{Format::rgba8_unorm, 1, false}};
  passes.push_back(color);
  return passes;
}

TEST(Keys, EachOneMovesSomePassOfSomeGpu) {
  WorkTrace trace;
  trace.passes = single_path_passes();
  GpuConfig on_chip = sample_gpu();
  on_chip.vliw_slots = 2;
  on_chip.ia_indices_per_clk = 5;
  on_chip.resolve_samples_per_clk = 50;
  on_chip.dram_bandwidth_gb_s = 50;
  on_chip.pass_overhead_us = 1;
  on_chip.dram_cpu_share_ratio = 0.1;
  on_chip.queue_packets = 2;
  on_chip.llc_size_kib = 32;
  on_chip.alu_efficiency_ratio = on_chip.tex_efficiency_ratio = on_chip.dram_efficiency_ratio = 0.5;
  on_chip.zrop_efficiency_ratio = on_chip.crop_efficiency_ratio = on_chip.blend_rgba8_ratio = 0.5;
  GpuConfig own_caches = on_chip;
  own_caches.rop_through_l2 = false;
  own_caches.vliw_slots = own_caches.vliw_fill_slots = 1;
  own_caches.export_px_per_clk = 1000;  // the ROPs limit
  own_caches.raster_px_per_engine_clk = 100;
  GpuConfig slow_l2 = on_chip;
  slow_l2.l2_bytes_per_clk = 5;
  slow_l2.l1_fill_bytes_per_core_clk = 0.1;
  slow_l2.color_delta_ratio = 0.9;
  slow_l2.depth_plane_slots = 3;
  GpuConfig tiler = on_chip;
  tiler.tile_based = true;
  tiler.dram_bandwidth_gb_s = 1;
  tiler.tile_memory_kib = 3;
  for (const KeyInfo& info : gpu_keys()) {
    if (!info.has(kRate) && !info.has(kCost)) continue;
    bool moves = false;
    for (const GpuConfig& base : {on_chip, own_caches, slow_l2, tiler})
      for (const Engine engine : {Engine::roofline, Engine::queue}) {
        GpuConfig gpu = base;
        for (const Key& key : keys_of(gpu))
          if (key.info.name == info.name) improve(key);
        const FrameTiming before = time_frame(trace, base, engine), after = time_frame(trace, gpu, engine);
        for (std::size_t i = 0; i < trace.passes.size(); ++i) {
          EXPECT_LE(after.passes[i].time_ns, before.passes[i].time_ns * (1 + 1e-3))
              << info.name << " pass " << i;
          moves |= after.passes[i].time_ns < before.passes[i].time_ns * (1 - 1e-9);
        }
      }
    EXPECT_TRUE(moves) << info.name << " changes nothing";
  }
}

}  // namespace
}  // namespace hwsim::test
