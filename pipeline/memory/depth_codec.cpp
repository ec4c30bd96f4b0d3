#include "pipeline/memory/depth_codec.h"

#include <algorithm>
#include <cstring>

#include "pipeline/memory/depth_expand.h"
#include "pipeline/memory/depth_format.h"

namespace hwsim::pipeline {
namespace {

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  void put(std::uint32_t value, int bits) {
    for (int i = 0; i < bits; ++i, ++used_) {
      if (used_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (value >> i & 1u) << (used_ % 8));
    }
  }

 private:
  std::vector<std::uint8_t>& bytes_;
  int used_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint32_t get(int bits) {
    std::uint32_t value = 0;
    for (int i = 0; i < bits; ++i, ++used_)
      value |= static_cast<std::uint32_t>(bytes_[used_ / 8] >> (used_ % 8) & 1) << i;
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t used_ = 0;
};

struct PackedPlane {
  float base, ddx, ddy;
  float reference_x, reference_y;
};
static_assert(sizeof(PackedPlane) == 20);

int index_bits(DepthTileForm form) {
  return form == DepthTileForm::one_plane ? 0 : form == DepthTileForm::two_planes ? 1 : 2;
}
int plane_slots(DepthTileForm form) { return 1 << index_bits(form); }
int offset_bits(DepthTileForm form) { return form == DepthTileForm::offset_6 ? 6 : 14; }
int raw_bits(Format format) { return format == Format::d16_unorm ? 16 : 32; }

// The slots of a form that holds more planes than the tile has stay zero.
void pack_planes(const GpuImage& image, int block, PackedDepthTile& out) {
  const auto count = static_cast<int>(image.plane_count[static_cast<std::size_t>(block)]);
  const DepthPlane* planes = image.planes.data() + static_cast<std::ptrdiff_t>(block) * kMaxDepthPlanes;
  const std::uint64_t* lanes =
      image.plane_lanes.data() + static_cast<std::ptrdiff_t>(block * kMaxDepthPlanes * image.samples);
  out.bytes.resize(sizeof(PackedPlane) * static_cast<std::size_t>(plane_slots(out.form)));
  for (int p = 0; p < count; ++p) {
    const DepthPlane& plane = planes[p];
    const PackedPlane packed{plane.z.base, plane.z.ddx, plane.z.ddy,
                             plane.reference_x - static_cast<float>(image.block_x(block)),
                             plane.reference_y - static_cast<float>(image.block_y(block))};
    std::memcpy(out.bytes.data() + sizeof(packed) * static_cast<std::size_t>(p), &packed, sizeof(packed));
  }
  BitWriter writer(out.bytes);
  for (int s = 0; s < image.samples; ++s) {
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      std::uint32_t of = 0;
      for (int p = 0; p < count; ++p)
        if ((lanes[p * image.samples + s] >> lane & 1) != 0) of = static_cast<std::uint32_t>(p);
      writer.put(of, index_bits(out.form));
    }
  }
}

void pack_samples(const GpuImage& image, int block, PackedDepthTile& out) {
  const std::span<const std::uint32_t> values(image.block(block), image.block_words());
  BitWriter writer(out.bytes);
  if (out.form == DepthTileForm::raw) {
    for (const std::uint32_t z : values) writer.put(z, raw_bits(image.format));
    return;
  }
  const auto [nearest, farthest] = std::minmax_element(values.begin(), values.end());
  writer.put(*nearest, 32);
  writer.put(*farthest, 32);
  for (const std::uint32_t z : values) {
    const bool far = *farthest - z < z - *nearest;
    writer.put(far ? 1 : 0, 1);
    writer.put(far ? *farthest - z : z - *nearest, offset_bits(out.form));
  }
}

void unpack_planes(const GpuImage& image, const PackedDepthTile& tile, std::span<std::uint32_t> values) {
  const auto slots = static_cast<std::size_t>(plane_slots(tile.form));
  std::array<PackedPlane, kMaxDepthPlanes> planes{};
  std::memcpy(planes.data(), tile.bytes.data(), slots * sizeof(PackedPlane));
  BitReader reader(std::span(tile.bytes).subspan(slots * sizeof(PackedPlane)));
  const float scale = depth_scale(image.format);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const PackedPlane& p = planes[reader.get(index_bits(tile.form))];
    const SamplePosition position = image.plane_positions[i / kBlockLanes];
    const int lane = static_cast<int>(i % kBlockLanes);
    values[i] = plane_depth_at(
        {p.base, p.ddx, p.ddy},
        (static_cast<float>(lane_x(lane)) - p.reference_x) + 0.5f + static_cast<float>(position.x) * 0.0625f,
        (static_cast<float>(lane_y(lane)) - p.reference_y) + 0.5f + static_cast<float>(position.y) * 0.0625f,
        scale);
  }
}

void unpack_samples(const GpuImage& image, const PackedDepthTile& tile, std::span<std::uint32_t> values) {
  BitReader reader(tile.bytes);
  if (tile.form == DepthTileForm::raw) {
    for (std::uint32_t& z : values) z = reader.get(raw_bits(image.format));
    return;
  }
  const std::uint32_t nearest = reader.get(32), farthest = reader.get(32);
  for (std::uint32_t& z : values) {
    const bool far = reader.get(1) != 0;
    const std::uint32_t distance = reader.get(offset_bits(tile.form));
    z = far ? farthest - distance : nearest + distance;
  }
}

}  // namespace

PackedDepthTile pack_depth_tile(const GpuImage& image, int block) {
  PackedDepthTile out;
  if (image.cleared[static_cast<std::size_t>(block)] != 0) {
    out.form = DepthTileForm::clear;
    return out;
  }
  out.form = depth_tile_form(image, block);
  if (image.plane_count[static_cast<std::size_t>(block)] != 0)
    pack_planes(image, block, out);
  else
    pack_samples(image, block, out);
  return out;
}

void unpack_depth_tile(const GpuImage& image, int block, const PackedDepthTile& tile,
                       std::span<std::uint32_t> values) {
  const bool planes = tile.form == DepthTileForm::one_plane || tile.form == DepthTileForm::two_planes ||
                      tile.form == DepthTileForm::four_planes;
  if (tile.form == DepthTileForm::clear)
    std::ranges::fill(values, image.clear_words[0]);
  else if (planes)
    unpack_planes(image, tile, values);
  else
    unpack_samples(image, tile, values);
  const std::uint64_t inside = image.lanes_inside(block);
  if (!planes || inside == ~std::uint64_t{0}) return;
  for (std::size_t i = 0; i < values.size(); ++i)
    if ((inside >> (i % kBlockLanes) & 1) == 0) values[i] = image.clear_words[0];
}

}  // namespace hwsim::pipeline
