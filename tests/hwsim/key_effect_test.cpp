// Every key of a GPU file acts on some pass, and in the direction that its declaration states.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <string>

#include "hwsim/detailed/address_source.h"
#include "hwsim/detailed/dram.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

/// Moves a key by `grows`: a number up or down by half, a switch on or off. False where it is there already.
bool move(const Key& key, bool grows) {
  if (auto* const* number = std::get_if<double*>(&key.slot)) {
    const double before = **number;
    **number = std::clamp(grows ? before * 1.5 : before / 1.5, key.info.low, key.info.high);
    return **number != before;
  }
  if (auto* const* whole = std::get_if<int*>(&key.slot)) {
    const int before = **whole;
    **whole = std::clamp(grows ? before * 2 : before / 2, static_cast<int>(key.info.low),
                         static_cast<int>(key.info.high));
    return **whole != before;
  }
  if (auto* const* flag = std::get_if<bool*>(&key.slot)) {
    const bool before = **flag;
    **flag = grows;
    return **flag != before;
  }
  return false;
}

/// The latencies are those of a texture request, the way to the level before included: a longer way to L1 or
/// L2 is one to what lies behind, too.
GpuConfig moved(GpuConfig gpu, std::string_view name, bool grows, bool& changed) {
  const GpuConfig before = gpu;
  for (const Key& key : keys_of(gpu))
    if (key.info.name == name) changed = move(key, grows);
  const double to_l1 = gpu.tex_latency_cycles - before.tex_latency_cycles;
  gpu.l2_latency_cycles += to_l1;
  const double to_l2 = gpu.l2_latency_cycles - before.l2_latency_cycles;
  gpu.dram_latency_cycles += to_l2;
  return gpu;
}

// Within a chunk the queue engine's units work along straight lines: so exact, and no more. The detailed
// engine draws addresses, and another order of requests draws others.
double tolerance(Engine engine) {
  if (engine == Engine::detailed) return 0.1;
  return engine == Engine::queue ? 1e-3 : 1e-12;
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
      pass_of([](PassCounters& c) { c.shader.alu_issued_lane_ops_w32 = c.shader.interp_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.load_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.group_memory_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.atomic_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.shader.narrow_store_lane_ops = 999; }),
      pass_of([](PassCounters& c) { c.gs.output_bytes = 9999; }),
      pass_of([](PassCounters& c) { c.tex.bilinear_probes = 999; }),
      pass_of([](PassCounters& c) { c.tex.gathers = 999; }),
      pass_of([](PassCounters& c) { c.tex.comparisons = 999; }),
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
      pass_of(
          [](PassCounters& c) {
            c.crop.exported_fragments = c.crop.single_color_fragments = 9;
            c.crop.written_samples = 72;
          },
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
  PassWork near = memory;
  for (PassCounters& c : near.chunks) {
    c.zrop = {};
    c.zrop.read_offset_6_tiles = c.zrop.write_offset_6_tiles = 90;
  }
  passes.push_back(near);
  PassWork samples = memory;
  samples.color_targets = {{Format::rgba8_unorm, 4, false}};
  for (PassCounters& c : samples.chunks) c.crop.write_single_pixels = c.crop.read_single_pixels = 90;
  passes.push_back(samples);
  PassWork color = memory;
  color.color_targets = {{Format::rgba8_unorm, 1, false}};
  passes.push_back(color);
  PassWork reading = pass_of([](PassCounters& c) { c.shader.alu_issued_lane_ops_w32 = 999; });
  reading.read_targets = {{Format::rgba8_unorm, 4, 9999}, {Format::d32_float, 1, 9999}};
  passes.push_back(reading);
  return passes;
}

/// GPUs in which different units limit.
std::vector<GpuConfig> bases() {
  GpuConfig on_chip = sample_gpu();
  on_chip.vliw_slots = 2;
  on_chip.ia_indices_per_clk = 5;
  on_chip.resolve_samples_per_clk = 50;
  on_chip.dram_bandwidth_gb_s = 50;
  on_chip.pass_overhead_us = 1;
  on_chip.dram_cpu_share_ratio = 0.1;
  on_chip.queue_packets = 4;
  on_chip.llc_size_kib = 32;
  on_chip.unit_lines_max = 20;
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
  slow_l2.msaa_color_block_bytes = 128;
  GpuConfig tiler = on_chip;
  tiler.tile_based = true;
  tiler.dram_bandwidth_gb_s = 1;
  tiler.tile_memory_kib = 3;
  tiler.gs_on_chip = false;
  return {on_chip, own_caches, slow_l2, tiler};
}

/// Short passes for the detailed engine: scattered reads by the cores, and units that read and write.
std::vector<PassWork> memory_passes() {
  PassCounters read;
  read.stats.fragment_shader_invocations = 32 * 40;
  read.shader.memory_chain_lane_ops = 4 * 32 * 40;
  read.shader.register_lanes = 20 * 32 * 40;
  read.mem.texture_read_bytes = 64 * 600;
  read.mem.storage_read_bytes = 64 * 600;
  PassWork reads = repeated(PassKind::full_screen, read, 8);
  set_reuse(reads, 0.7);
  PassCounters units;
  units.raster.quads = 8 * 40;
  units.mem.vertex_read_bytes = 64 * 300;
  units.mem.depth_read_bytes = units.mem.depth_write_bytes = 64 * 300;
  units.mem.color_read_bytes = units.mem.color_write_bytes = 64 * 600;
  units.crop.exported_fragments = 32 * 40;
  PassWork writes = repeated(PassKind::draw, units, 8);
  writes.color_targets = {{Format::rgba8_unorm, 1, true}};
  writes.depth_format = Format::d32_float;
  set_reuse(writes, 0.7);
  PassCounters stores;
  stores.crop.exported_fragments = 32 * 40;
  stores.mem.color_write_bytes = 64 * 4000;
  PassWork only_writes = repeated(PassKind::draw, stores, 4);
  only_writes.color_targets = {{Format::rgba8_unorm, 1, false}};
  set_reuse(only_writes, 0.9);
  return {reads, writes, only_writes};
}

/// A GPU whose memory limits, with few of everything that the detailed engine alone knows.
GpuConfig memory_gpu() {
  GpuConfig gpu = sample_gpu();
  gpu.shader_cores = 2;
  gpu.dram_bandwidth_gb_s = 40;
  gpu.dram_channels = 2;
  gpu.dram_banks = 4;
  gpu.dram_row_bytes = 1024;
  gpu.l2_size_kib = 32;
  gpu.l1_size_kib = 4;
  gpu.core_lines_max = 24;
  gpu.unit_lines_max = 24;
  gpu.dram_write_lines = 8;
  gpu.dram_write_groups = 1;
  return gpu;
}

/// What a larger value of a key does to some pass on some GPU.
struct Effect {
  bool acts = false, faster = false, slower = false;
  bool much_faster = false, much_slower = false;  ///< by more than the engines' own errors
  std::string where;                              ///< some pass that was not as fast as before
};

class Watch {
 public:
  Watch(std::vector<PassWork> passes, GpuConfig gpu, Engine engine) : gpu_(std::move(gpu)), engine_(engine) {
    trace_.passes = std::move(passes);
    before_ = time_frame(trace_, gpu_, engine_);
  }
  void see(std::string_view name, Effect& effect) const {
    for (const bool grows : {true, false}) {
      bool changed = false;
      const GpuConfig gpu = moved(gpu_, name, grows, changed);
      if (!changed) continue;
      const FrameTiming after = time_frame(trace_, gpu, engine_);
      for (std::size_t i = 0; i < trace_.passes.size(); ++i) {
        const double small = (grows ? before_ : after).passes[i].time_ns;
        const double large = (grows ? after : before_).passes[i].time_ns;
        effect.acts |= small != large;
        const bool drawn = engine_ == Engine::detailed;
        const double least = drawn ? tolerance(engine_) : 1e-9;
        effect.faster |= large < small * (1.0 - least);
        effect.slower |= large > small * (1.0 + least);
        effect.much_faster |= large < small * (1.0 - tolerance(engine_));
        if (large <= small * (1.0 + tolerance(engine_))) continue;
        effect.much_slower = true;
        effect.where = std::string(engine_name(engine_)) + ", pass " + std::to_string(i) + ": " +
                       std::to_string(small) + " to " + std::to_string(large) + " ns";
      }
    }
  }

 private:
  WorkTrace trace_;
  GpuConfig gpu_;
  Engine engine_;
  FrameTiming before_;
};

/// When a DRAM that opens rows most of the time has served scattered reads, and when it has taken over
/// scattered writes: both in the same order whatever the times.
std::array<double, 2> dram_ns(const GpuConfig& gpu) {
  Dram reads(gpu), writes(gpu);
  Random random(7);
  double taken_ns = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const std::uint64_t line = random.bits() % 4096;
    reads.access(line, false, 0.0);
    taken_ns += writes.access(line, true, 0.0);
  }
  return {reads.free_ns(), taken_ns};
}

void see_dram(std::string_view name, Effect& effect) {
  GpuConfig base = memory_gpu();
  base.dram_bandwidth_gb_s = 400;
  base.dram_banks = base.dram_queue_rows = 2;
  for (const bool grows : {true, false}) {
    bool changed = false;
    const GpuConfig gpu = moved(base, name, grows, changed);
    const std::array<double, 2> small = dram_ns(grows ? base : gpu), large = dram_ns(grows ? gpu : base);
    for (std::size_t i = 0; i < small.size(); ++i) {
      effect.acts |= small[i] != large[i];
      effect.faster |= large[i] < small[i];
      effect.slower |= large[i] > small[i];
    }
  }
}

std::vector<Watch> watches() {
  std::vector<Watch> all;
  for (const Engine engine : {Engine::roofline, Engine::queue})
    for (const GpuConfig& gpu : bases()) all.emplace_back(single_path_passes(), gpu, engine);
  GpuConfig own_caches = memory_gpu();
  own_caches.rop_through_l2 = false;
  for (const GpuConfig& gpu : {memory_gpu(), own_caches})
    all.emplace_back(memory_passes(), gpu, Engine::detailed);
  return all;
}

TEST(Keys, EachOneActsInItsStatedDirectionAndNoKeyWithoutOneActs) {
  const std::vector<Watch> all = watches();
  for (const KeyInfo& info : gpu_keys()) {
    SCOPED_TRACE(info.name);
    const unsigned direction = info.flags & kDirections;
    Effect effect;
    for (const Watch& watch : all) watch.see(info.name, effect);
    see_dram(info.name, effect);
    EXPECT_EQ(effect.acts, direction != 0);
    if (direction == kFaster) {
      EXPECT_TRUE(effect.faster);
      EXPECT_FALSE(effect.much_slower) << effect.where;
    }
    if (direction == kSlower) {
      EXPECT_TRUE(effect.slower) << effect.where;
      EXPECT_FALSE(effect.much_faster);
    }
    EXPECT_TRUE(direction == 0 || std::has_single_bit(direction)) << "one direction a key";
  }
}

// Lines in flight are hardware: a longer way to DRAM does not bring more of them.
TEST(Keys, ALongerWayToDramNeverMakesAFrameFaster) {
  GpuConfig gpu = memory_gpu();
  gpu.unit_lines_max = 600;
  PassWork uneven = memory_passes()[1];
  uneven.chunks.resize(24, uneven.chunks.front());
  for (std::size_t i = 0; i < uneven.chunks.size(); ++i) {
    PassCounters& c = uneven.chunks[i];
    if (i % 2 == 0) c.mem = {};
    if (i % 2 == 0) c.raster.quads *= 200;
  }
  set_reuse(uneven, 0.9);
  WorkTrace trace;
  trace.passes = {uneven};
  for (const Engine engine : {Engine::roofline, Engine::queue, Engine::detailed}) {
    double before_ns = 0.0;
    for (const double cycles : {200.0, 400.0, 800.0, 1600.0, 3200.0}) {
      gpu.dram_latency_cycles = cycles;
      const double ns = time_frame(trace, gpu, engine).time_ns;
      EXPECT_GE(ns, before_ns * (1.0 - 1e-3)) << cycles << " cycles in " << engine_name(engine);
      before_ns = ns;
    }
  }
}

}  // namespace
}  // namespace hwsim::test
