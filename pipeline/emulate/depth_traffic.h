#pragma once
// Depth tiles between the depth unit and memory, counted by the form in which they lie there.
#include <array>
#include <span>

#include "hwsim/trace/counters.h"
#include "pipeline/memory/depth_expand.h"

namespace hwsim::pipeline {

using TileCounter = std::uint64_t ZropCounters::*;
inline constexpr std::array<TileCounter, kDepthTileForms> kReadTiles = {
    &ZropCounters::read_clear_tiles,     &ZropCounters::read_one_plane_tiles,
    &ZropCounters::read_two_plane_tiles, &ZropCounters::read_four_plane_tiles,
    &ZropCounters::read_offset_6_tiles,  &ZropCounters::read_offset_14_tiles,
    &ZropCounters::read_raw_tiles,
};
inline constexpr std::array<TileCounter, kDepthTileForms> kWriteTiles = {
    &ZropCounters::write_clear_tiles,     &ZropCounters::write_one_plane_tiles,
    &ZropCounters::write_two_plane_tiles, &ZropCounters::write_four_plane_tiles,
    &ZropCounters::write_offset_6_tiles,  &ZropCounters::write_offset_14_tiles,
    &ZropCounters::write_raw_tiles,
};

inline void count_tile_form(const std::array<TileCounter, kDepthTileForms>& counters, DepthTileForm form,
                            ZropCounters& n) {
  n.*counters[static_cast<std::size_t>(form)] += 1;
}

/// Gives a written tile back to memory, at the cost of the chunk that used it last.
inline void save_depth_tile(GpuImage& image, int block, std::span<PassCounters> chunks) {
  const auto i = static_cast<std::size_t>(block);
  if (image.unsaved[i] == 0) return;
  image.unsaved[i] = 0;
  image.stored_form[i] = depth_tile_form(image, block);
  count_tile_form(kWriteTiles, image.stored_form[i], chunks[image.touched_chunk[i] - 1].zrop);
}

}  // namespace hwsim::pipeline
