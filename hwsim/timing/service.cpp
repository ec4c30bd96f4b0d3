#include "hwsim/timing/service.h"

#include <algorithm>
#include <cmath>

namespace hwsim {

double packets_of(const PassCounters& c, int subgroup_size) {
  constexpr std::uint64_t kTileItems = 16, kItemBytes = 64;
  const std::uint64_t bytes = c.mem.depth_read_bytes + c.mem.depth_write_bytes + c.mem.color_read_bytes +
                              c.mem.color_write_bytes + c.mem.texture_read_bytes + c.mem.storage_read_bytes +
                              c.mem.storage_write_bytes + c.mem.vertex_read_bytes + c.mem.index_read_bytes;
  const std::uint64_t items =
      std::max({c.stats.fragment_shader_invocations + c.stats.compute_shader_invocations, 4 * c.raster.quads,
                kTileItems * c.raster.visited_tiles, kTileItems * c.hiz.tested_tiles,
                c.stats.input_assembly_vertices, c.setup.in_primitives, c.crop.exported_fragments,
                c.resolve.written_pixels, c.fe.draws, bytes / kItemBytes});
  return std::max(1.0, std::ceil(static_cast<double>(items) / subgroup_size));
}

}  // namespace hwsim
