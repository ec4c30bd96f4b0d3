#pragma once
// Runs a frame graph: the image, and every count of work.
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "hwsim/trace/work_trace.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// Work that a scene does not need. Each switch changes neither image nor trace, only the emulator's own
/// time.
struct SkipSwitches {
  bool frustum = true;
  bool cleared_tiles = true;
  bool hidden_tiles = true;
  bool accepted_tiles = true;
  bool plane_tiles = true;
  bool single_color_pixels = true;
};

struct SkipInfo {
  std::string_view name;
  std::string_view description;
  bool SkipSwitches::*flag;
};

/// The switches by name; results count each one's uses under it.
inline constexpr std::array<SkipInfo, 6> kSkips = {{
    {"frustum", "clusters outside the view volume are not transformed; their culling is still counted",
     &SkipSwitches::frustum},
    {"cleared_tiles", "memory of cleared tiles until something uses it", &SkipSwitches::cleared_tiles},
    {"hidden_tiles", "coverage and depth tests of samples in tiles that the coarse test kills",
     &SkipSwitches::hidden_tiles},
    {"accepted_tiles", "depth tests of samples in tiles that the coarse test accepts whole",
     &SkipSwitches::accepted_tiles},
    {"plane_tiles", "depth tests of samples where the bounds of two planes decide",
     &SkipSwitches::plane_tiles},
    {"single_color_pixels", "resolving all samples of pixels that hold one color",
     &SkipSwitches::single_color_pixels},
}};

struct GpuImage;  // memory/gpu_image.h
class PassMemo;   // pass_memo.h

struct EmulationOptions {
  int jobs = 1;
  SkipSwitches skip;
  bool exact_reuse = false;  ///< reuse distances of all blocks, not of a sample: slow, to know the error
  std::function<void(double done_ratio, const std::string& pass)> progress;  ///< optional
  /// Optional: passes that another frame has run are not emulated again. Neither image nor trace change.
  PassMemo* memo = nullptr;
  /// Optional: a look at memory after each pass, without a memo. Images by ImageId; null while not alive.
  std::function<void(const Pass& pass, std::span<const GpuImage* const> images)> inspect;
};

struct Emulation {
  WorkTrace trace;
  Image color;                                   ///< the graph's output, linear
  Image shading_heat;                            ///< r: fragment shader invocations of each pixel, all passes
  std::map<std::string, std::uint64_t> skipped;  ///< by switch: how often it applied
  double wall_s = 0.0;
  std::uint64_t reused_passes = 0;  ///< that EmulationOptions::memo knew
  std::vector<double> pass_wall_s;  ///< the trace's passes, memory allocation left out
  std::vector<double> pass_cpu_s;   ///< processor time of all threads
};

/// Throws InputError when the graph is not valid for this GPU.
Emulation emulate(const FrameGraph& graph, const GpuFeatures& features, const FunctionalConfig& functional,
                  const EmulationOptions& options);

}  // namespace hwsim::pipeline
