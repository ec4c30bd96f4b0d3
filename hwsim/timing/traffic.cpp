#include "hwsim/timing/traffic.h"

namespace hwsim {
namespace {

double real(std::uint64_t n) { return static_cast<double>(n); }

}  // namespace

StreamBytes requested_bytes(const PassCounters& c) {
  StreamBytes bytes;
  const auto read = [&bytes](Stream s, std::uint64_t n) { bytes.read[at(s)] = real(n); };
  const auto write = [&bytes](Stream s, std::uint64_t n) { bytes.write[at(s)] = real(n); };
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
  write(Stream::other, c.mem.other_write_bytes);
  return bytes;
}

PassShape shape_of(const PassWork& pass) {
  PassShape shape;
  shape.sum = total(pass);
  double samples = 0.0;
  for (const ColorTargetWork& target : pass.color_targets) samples += target.samples;
  if (!pass.color_targets.empty())
    shape.color_samples = samples / static_cast<double>(pass.color_targets.size());
  const double written = real(shape.sum.crop.written_samples);
  const double single = real(shape.sum.crop.single_color_fragments) * shape.color_samples;
  if (written > 0.0) shape.uncompressed_ratio = std::clamp((written - single) / written, 0.0, 1.0);
  return shape;
}

}  // namespace hwsim
