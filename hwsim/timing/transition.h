#pragma once
// What happens to a target before a shader reads it: GPUs whose texture units cannot read what their ROPs
// compress write it out raw, in place (docs/hardware_model.md#from-target-to-texture).
#include "hwsim/gpu/gpu_rates.h"
#include "hwsim/timing/traffic.h"
#include "hwsim/trace/work_trace.h"

namespace hwsim {

/// The pass begins when this is done.
template <class T>
struct Transition {
  T crop_ns{0.0}, zrop_ns{0.0};  ///< busy ROPs
  StreamBytesOf<T> dram;
  T dram_ns{0.0}, ns{0.0};  ///< ns: of the slowest
};

/// Multisampled color: each pixel's one color, and the table that says so, become samples. Pixels with
/// several colors move more: this is the least.
template <class T>
void expand_color(const ReadTargetWork& target, const GpuRates<T>& r, Transition<T>& t) {
  const auto k = static_cast<std::size_t>(info(target.format).rate_class);
  const double px = static_cast<double>(target.pixels), bytes = info(target.format).bytes;
  t.dram.read[index_of(Stream::color)] += T(px * bytes);
  t.dram.write[index_of(Stream::color)] += T(px * bytes * target.samples);
  t.crop_ns += px * target.samples * r.color_sample_ns[k];
}

/// Depth: a tile's planes become samples. Stencil stays where it is.
template <class T>
void expand_depth(const ReadTargetWork& target, const GpuRates<T>& r, Transition<T>& t) {
  constexpr double kDepthBytes = 4.0;
  const auto px = static_cast<double>(target.pixels);
  t.dram.read[index_of(Stream::depth)] += T(px / kTilePixels * r.compression_granule_bytes);
  t.dram.write[index_of(Stream::depth)] += T(px * target.samples * kDepthBytes);
  t.zrop_ns += px * target.samples * r.zrop_sample_ns;
}

template <class T>
Transition<T> transition_before(const PassWork& pass, const GpuRates<T>& r) {
  Transition<T> t;
  for (const ReadTargetWork& target : pass.read_targets) {
    const bool depth = info(target.format).is_depth;
    if (depth && r.shader_read_expands_depth) expand_depth(target, r, t);
    if (!depth && r.shader_read_expands_color && target.samples > 1) expand_color(target, r, t);
  }
  t.dram_ns = t.dram.total() * r.dram_byte_ns;
  t.ns = larger(larger(t.crop_ns, t.zrop_ns), t.dram_ns);
  return t;
}

/// Adds it to a pass that was timed without: a fixed part of its time.
template <class T, class Time>
void add_transition(const Transition<T>& t, Time& time) {
  time.time_ns += t.ns;
  time.overhead_ns += t.ns;
  const bool by_bytes = !(t.dram_ns < t.crop_ns) && !(t.dram_ns < t.zrop_ns);
  const Unit slowest = by_bytes ? Unit::dram : t.crop_ns < t.zrop_ns ? Unit::zrop : Unit::crop;
  time.stack_ns[index_of(slowest)] += t.ns;
  time.busy_ns[index_of(Unit::crop)] += t.crop_ns;
  time.busy_ns[index_of(Unit::zrop)] += t.zrop_ns;
  time.busy_ns[index_of(Unit::dram)] += t.dram_ns;
  time.dram += t.dram;
}

}  // namespace hwsim
