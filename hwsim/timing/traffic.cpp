#include "hwsim/timing/traffic.h"

#include <numeric>

namespace hwsim {
namespace {

double real(std::uint64_t n) { return static_cast<double>(n); }

}  // namespace

double StreamBytes::total_read() const { return std::accumulate(read.begin(), read.end(), 0.0); }
double StreamBytes::total_write() const { return std::accumulate(write.begin(), write.end(), 0.0); }

StreamBytes requested_bytes(const PassCounters& c) {
  StreamBytes bytes;
  const auto read = [&bytes](Stream s, std::uint64_t n) { bytes.read[index_of(s)] = real(n); };
  const auto write = [&bytes](Stream s, std::uint64_t n) { bytes.write[index_of(s)] = real(n); };
  read(Stream::depth, c.mem.depth_read_bytes);
  write(Stream::depth, c.mem.depth_write_bytes);
  read(Stream::color, c.mem.color_read_bytes);
  write(Stream::color, c.mem.color_write_bytes);
  read(Stream::texture, c.mem.texture_read_bytes);
  read(Stream::storage, c.mem.storage_read_bytes);
  write(Stream::storage, c.mem.storage_write_bytes);
  read(Stream::vertex, c.mem.vertex_read_bytes);
  read(Stream::index, c.mem.index_read_bytes);
  read(Stream::constant, c.mem.constant_read_bytes);
  read(Stream::shader, c.mem.shader_read_bytes);
  read(Stream::other, c.mem.other_read_bytes);
  write(Stream::other, c.mem.other_write_bytes);
  return bytes;
}

PassShape shape_of(const PassWork& pass) {
  PassShape shape;
  shape.sum = total(pass);
  shape.depth_read = depth_reads(shape.sum.zrop, pass.depth_cleared_before);
  shape.depth_write = depth_writes(shape.sum.zrop);
  shape.color_read = color_reads(shape.sum.crop);
  shape.color_write = color_writes(shape.sum.crop);
  shape.depth_tile_bytes =
      kTilePixels * pass.depth_samples * static_cast<double>(info(pass.depth_format).bytes);
  for (const ColorTargetWork& target : pass.color_targets)
    shape.color_tile_bytes =
        std::max(shape.color_tile_bytes,
                 kTilePixels * target.samples * static_cast<double>(info(target.format).bytes));
  return shape;
}

}  // namespace hwsim
