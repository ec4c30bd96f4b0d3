#pragma once
// Depth tiles as bytes, the way memory would hold them. The timing engines need only their sizes
// (hwsim/timing); this is the proof that nothing is lost at these sizes, and a scalar witness of the vector
// code that tests and expands planes.
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

struct PackedDepthTile {
  DepthTileForm form = DepthTileForm::raw;
  std::vector<std::uint8_t> bytes;
};

/// Packs a tile in the form that depth_tile_form gives, `clear` for a tile that is still marked as cleared.
/// Layouts, little-endian: planes: 20 bytes each (base, ddx, ddy, reference point relative to the tile), then
/// the number of the plane of each sample in 0, 1 or 2 bits; offsets: nearest, farthest value of the tile,
/// then for each sample one bit (0: from the nearest) and 6 or 14 bits of distance; raw: 2 bytes a sample for
/// D16, else 4.
PackedDepthTile pack_depth_tile(const GpuImage& image, int block);

/// The samples of the tile: `samples` * 64 values, sample by sample. Lanes outside of the image are clear.
/// `image` gives format, sample positions, clear value and size; its contents are not read.
void unpack_depth_tile(const GpuImage& image, int block, const PackedDepthTile& tile,
                       std::span<std::uint32_t> values);

}  // namespace hwsim::pipeline
