#include "hwsim/timing/compression.h"

#include <numeric>

namespace hwsim {
namespace {

DepthMix parts(const std::array<std::uint64_t, kDepthForms>& tiles) {
  DepthMix mix{};
  const auto all = static_cast<double>(std::accumulate(tiles.begin(), tiles.end(), std::uint64_t{0}));
  if (all > 0.0)
    for (std::size_t form = 0; form < kDepthForms; ++form) mix[form] = static_cast<double>(tiles[form]) / all;
  return mix;
}

ColorMix mix_of(std::uint64_t single, std::uint64_t twice, std::uint64_t mixed, std::uint64_t groups_8px,
                std::uint64_t groups_16px) {
  ColorMix mix;
  const auto all = static_cast<double>(single + twice + mixed);
  mix.counted = all > 0.0;
  if (!mix.counted) return mix;
  mix.single = static_cast<double>(single) / all;
  mix.twice = static_cast<double>(twice) / all;
  // Groups are whole within 8x8 tiles; at the image's border a tile has pixels outside of all groups.
  mix.in_8px = std::min(mix.single, 8.0 * static_cast<double>(groups_8px) / all);
  mix.in_16px = std::min(mix.in_8px, 16.0 * static_cast<double>(groups_16px) / all);
  return mix;
}

}  // namespace

DepthMix depth_reads(const ZropCounters& c, bool without_cleared) {
  return parts({without_cleared ? 0 : c.read_clear_tiles, c.read_one_plane_tiles, c.read_two_plane_tiles,
                c.read_four_plane_tiles, c.read_offset_6_tiles, c.read_offset_14_tiles, c.read_raw_tiles});
}

DepthMix depth_writes(const ZropCounters& c) {
  return parts({c.write_clear_tiles, c.write_one_plane_tiles, c.write_two_plane_tiles,
                c.write_four_plane_tiles, c.write_offset_6_tiles, c.write_offset_14_tiles,
                c.write_raw_tiles});
}

ColorMix color_reads(const CropCounters& c) {
  return mix_of(c.read_single_pixels, c.read_double_pixels, c.read_mixed_pixels, c.read_single_groups_8px,
                c.read_single_groups_16px);
}

ColorMix color_writes(const CropCounters& c) {
  return mix_of(c.write_single_pixels, c.write_double_pixels, c.write_mixed_pixels, c.write_single_groups_8px,
                c.write_single_groups_16px);
}

double pixels_in_single_blocks(const ColorMix& mix, double block_px) {
  const double doublings = std::log2(std::clamp(block_px, 1.0, 16.0));
  if (doublings <= 3.0) return mix.single + (mix.in_8px - mix.single) * doublings / 3.0;
  return mix.in_8px + (mix.in_16px - mix.in_8px) * (doublings - 3.0);
}

}  // namespace hwsim
