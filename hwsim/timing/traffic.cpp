#include "hwsim/timing/traffic.h"

namespace hwsim {
namespace {

double real(std::uint64_t n) { return static_cast<double>(n); }

/// At most one tile's bytes a touch; no bound where the trace counts no touches.
double capped(std::uint64_t bytes, std::uint64_t touches, double tile_bytes) {
  return touches == 0 || tile_bytes <= 0.0 ? real(bytes) : std::min(real(bytes), real(touches) * tile_bytes);
}

void describe_targets(const PassWork& pass, PassShape& shape) {
  if (pass.depth_format != Format::none)
    shape.depth_tile_bytes = kTilePixels * pass.depth_samples * info(pass.depth_format).bytes;
  if (pass.color_targets.empty()) return;
  double bytes = 0.0, samples = 0.0;
  for (const ColorTargetWork& target : pass.color_targets) {
    bytes += kTilePixels * target.samples * info(target.format).bytes;
    samples += target.samples;
  }
  const auto targets = static_cast<double>(pass.color_targets.size());
  shape.color_tile_bytes = bytes / targets;
  shape.color_samples = samples / targets;
}

void fill_rop_compulsory(PassShape& shape) {
  const PassCounters& c = shape.sum;
  StreamBytes& first = shape.compulsory;
  const auto color = at(Stream::color), depth = at(Stream::depth);
  shape.color_footprint_bytes = real(c.crop.first_touched_tiles) * shape.color_tile_bytes;
  shape.depth_footprint_bytes = real(c.zrop.first_touched_tiles) * shape.depth_tile_bytes;
  const auto bounded = [](double requested, double footprint, std::uint64_t touches) {
    return touches == 0 ? requested : std::min(requested, footprint);
  };
  first.read[color] = bounded(shape.requested.read[color], shape.color_footprint_bytes, c.crop.touched_tiles);
  first.write[color] =
      bounded(shape.requested.write[color], shape.color_footprint_bytes, c.crop.touched_tiles);
  first.read[depth] = bounded(shape.requested.read[depth], shape.depth_footprint_bytes, c.zrop.touched_tiles);
  first.write[depth] =
      bounded(shape.requested.write[depth], shape.depth_footprint_bytes, c.zrop.touched_tiles);
}

/// Buffers: their distinct bytes, shared between reads and writes in proportion. A trace that does not say
/// how many bytes are distinct is taken to read each once.
void fill_buffer_compulsory(const PassWork& pass, PassShape& shape) {
  const auto share = [&shape](Stream s, std::uint64_t unique) {
    const double read = shape.requested.read[at(s)], write = shape.requested.write[at(s)];
    const double all = read + write;
    const double ratio = all <= 0.0 || unique == 0 ? 1.0 : std::min(1.0, real(unique) / all);
    shape.compulsory.read[at(s)] = read * ratio;
    shape.compulsory.write[at(s)] = write * ratio;
  };
  share(Stream::vertex, pass.unique_vertex_bytes);
  share(Stream::index, pass.unique_index_bytes);
  share(Stream::storage, pass.unique_storage_bytes);
  for (const Stream s : {Stream::constant, Stream::shader, Stream::other}) share(s, 0);
}

}  // namespace

StreamBytes requested_bytes(const PassCounters& c, const PassShape& shape) {
  StreamBytes bytes;
  const auto read = [&bytes](Stream s, double n) { bytes.read[at(s)] = n; };
  const auto write = [&bytes](Stream s, double n) { bytes.write[at(s)] = n; };
  read(Stream::depth, capped(c.mem.depth_read_bytes, c.zrop.touched_tiles, shape.depth_tile_bytes));
  write(Stream::depth, capped(c.mem.depth_write_bytes, c.zrop.touched_tiles, shape.depth_tile_bytes));
  read(Stream::color, capped(c.mem.color_read_bytes, c.crop.touched_tiles, shape.color_tile_bytes));
  write(Stream::color, capped(c.mem.color_write_bytes, c.crop.touched_tiles, shape.color_tile_bytes));
  read(Stream::storage, real(c.mem.storage_read_bytes));
  write(Stream::storage, real(c.mem.storage_write_bytes));
  read(Stream::vertex, real(c.mem.vertex_read_bytes));
  read(Stream::index, real(c.mem.index_read_bytes));
  read(Stream::constant, real(c.mem.constant_read_bytes));
  read(Stream::shader, real(c.mem.shader_read_bytes));
  write(Stream::other, real(c.mem.other_write_bytes));
  return bytes;
}

PassShape shape_of(const PassWork& pass) {
  PassShape shape;
  describe_targets(pass, shape);
  for (const PassCounters& chunk : pass.chunks) {
    shape.sum += chunk;
    const StreamBytes asked = requested_bytes(chunk, shape);
    for (std::size_t i = 0; i < kStreamCount; ++i) {
      shape.requested.read[i] += asked.read[i];
      shape.requested.write[i] += asked.write[i];
    }
  }
  const double written = real(shape.sum.crop.written_samples);
  const double single = real(shape.sum.crop.single_color_fragments) * shape.color_samples;
  if (written > 0.0) shape.uncompressed_ratio = std::clamp((written - single) / written, 0.0, 1.0);
  shape.texture_footprint_bytes = real(shape.sum.tex.first_touched_lines) * kTextureLineBytes;
  fill_rop_compulsory(shape);
  fill_buffer_compulsory(pass, shape);
  return shape;
}

}  // namespace hwsim
