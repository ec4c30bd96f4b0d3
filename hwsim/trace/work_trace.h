#pragma once
// The work of a frame, as counted by the functional emulator: the only thing that crosses from pipeline/ to
// the timing engines. Nothing here depends on clocks, unit counts, cache sizes or DRAM, so one trace is timed
// many times.
#include <cstdint>
#include <string>
#include <vector>

#include "hwsim/trace/counters.h"
#include "hwsim/trace/format.h"
#include "hwsim/trace/reuse.h"

namespace hwsim {

enum class PassKind : std::uint8_t { draw, full_screen, compute, clear, copy, resolve };
std::string_view pass_kind_name(PassKind kind);

struct ColorTargetWork {
  Format format = Format::none;
  int samples = 1;
  bool blended = false;
  bool loaded = false;  ///< it has contents that this pass goes on with: GPUs with tile memory load them
  bool kept = true;     ///< a later pass, or the display, needs what this pass leaves: they store it
};

/// An image that shaders of a pass read, first since something was drawn on it.
struct ReadTargetWork {
  Format format = Format::none;
  int samples = 1;
  std::uint64_t pixels = 0;  ///< in all layers
};

/// One pass. `chunks` stand in the order in which the hardware meets them: batches of triangles in submission
/// order for draws, bands of screen tiles for full-screen passes, bands of groups for compute.
struct PassWork {
  std::string name;
  PassKind kind = PassKind::draw;
  int width_px = 0;
  int height_px = 0;
  int raster_samples = 1;
  bool sample_rate = false;     ///< shaders ran once for each sample
  bool barrier_before = false;  ///< waits for an earlier pass to drain (it reads what that one wrote)
  Format depth_format = Format::none;
  int depth_samples = 1;
  bool depth_cleared_before = false;  ///< its depth target was fast-cleared: a first touch needs no read
  bool depth_loaded = false;          ///< as of color targets
  bool depth_kept = true;
  bool color_cleared_before = false;  ///< its color targets were: likewise
  bool source_in_tile = false;        ///< a resolve of what the pass just before it drew
  std::vector<ColorTargetWork> color_targets;
  std::vector<ReadTargetWork> read_targets;  ///< GPUs may have to decompress them first
  int group_memory_lane_bytes = 0;           ///< group memory of a compute group, divided by its invocations
  int attribute_scalars = 0;  ///< 32-bit values that the rasterizer interpolates for each fragment
  ReuseProfile reuse;         ///< what caches of any size let through
  std::vector<PassCounters> chunks;
};

struct WorkTrace {
  std::string scene;
  std::string technique;
  /// The ids of the technique counters by slot, "technique.lit_samples"; empty where a slot has none.
  std::vector<std::string> technique_counters;
  int width_px = 0;
  int height_px = 0;
  std::uint64_t peak_memory_bytes = 0;       ///< most bytes of attachments and buffers that live at once
  std::uint64_t allocated_memory_bytes = 0;  ///< bytes of all of them, none in another one's memory
  std::vector<PassWork> passes;
};

PassCounters total(const PassWork& pass);
PassCounters total(const WorkTrace& trace);

}  // namespace hwsim
