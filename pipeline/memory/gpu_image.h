#pragma once
// An image in simulated GPU memory.
#include <array>
#include <cstdint>
#include <vector>

#include "hwsim/trace/format.h"
#include "pipeline/base/zeroed_vector.h"
#include "pipeline/memory/depth_planes.h"
#include "pipeline/raster/tile.h"
#include "pipeline/state/pipeline_state.h"

namespace hwsim::pipeline {

struct GpuImage;

/// The samples but the first of the quads that hold more than one color.
struct PackedSamples {
  /// By quad, tile by tile: its first word, or kOneColor where sample 0 stands for all. Empty: not packed.
  std::vector<std::int32_t> quad_start;
  /// A quad's lie sample by sample, for each 32-bit word of a texel its four lanes.
  ZeroedVector<std::uint32_t> words;

  static constexpr std::int32_t kOneColor = -1;
};

/// Writes the planes of a tile into its texels (memory/depth_expand.cpp).
void expand_depth_tile(GpuImage& image, int block_index);
/// Copies sample 0 of the stale lanes of a color tile to the others (memory/stale_samples.cpp).
void spread_stale_samples(GpuImage& image, int block_index);

/// Texels are stored tile by tile; in a tile layer by layer; in a layer sample by sample; in a sample, for
/// each 32-bit word of a texel, the 64 lanes. Multisampled color has sample 0 of all tiles before the further
/// samples of the first: tiles of one color touch no memory for those. Formats below 32 bits take a word each
/// here; what the simulated GPU allocates is the format's business. Depth formats hold the depth as an
/// integer that orders as the depth does (see memory/depth_format.h), stencil apart.
struct GpuImage {
  Format format = Format::none;
  int width = 0, height = 0, samples = 1;
  int layers = 1;
  int words = 1;  ///< 32-bit words of a texel
  int blocks_x = 0, blocks_y = 0;
  bool first_samples_apart = false;  ///< multisampled color without layers
  std::size_t first_stride = 0;      ///< words from a block's sample 0 to the next one's
  std::size_t further_begin = 0;     ///< word of the first block's sample 1
  std::size_t further_stride = 0;    ///< words from a block's sample 1 to the next one's
  ZeroedVector<std::uint32_t> texels;
  ZeroedVector<std::uint8_t> stencil;  ///< tile by tile, sample by sample, only for stencil formats
  std::vector<std::uint32_t> depth_min,
      depth_max;                             ///< by tile, depth formats only: bounds, exact after each draw
  std::vector<std::uint32_t> touched_chunk;  ///< by tile: 1 + the last chunk of the current pass that used it

  // Multisampled color: what compression would see, and what the emulator need not store
  // (docs/compression.md#color).
  std::vector<std::uint64_t> single_lanes;  ///< by tile: pixels with one color at all samples
  std::vector<std::uint64_t> double_lanes;  ///< pixels with two colors
  std::vector<std::uint64_t> second_color;  ///< by sample: pixels of double_lanes that hold the second
  std::vector<std::uint64_t> stale_lanes;   ///< single pixels of which only sample 0 has been written
  PackedSamples packed;                     ///< while shaders read (begin_reads)

  int coverage_samples = 0;                   ///< positions of the coverage map (memory/coverage_map.h)
  std::vector<std::uint64_t> coverage_map;    ///< by pixel, tile by tile; one word each or two
  std::vector<std::uint64_t> coverage_whole;  ///< by tile: pixels that one fragment covers everywhere

  // Depth formats: tiles held as planes; their texels are stale.
  std::vector<std::uint8_t> plane_count;        ///< by tile; 0: the texels hold the depth
  ZeroedVector<DepthPlane> planes;              ///< kMaxDepthPlanes a tile
  ZeroedVector<std::uint64_t> plane_lanes;      ///< lanes of each sample of each of these planes
  std::vector<SamplePosition> plane_positions;  ///< where samples lay when the planes were written
  std::vector<DepthTileForm> stored_form;       ///< by tile, as last given back to memory

  std::vector<std::uint8_t> unsaved;  ///< by tile: 1 when written since it was last given back to memory

  /// A clear only marks its tiles, as hardware's fast clear does; a tile is filled when it is first used.
  std::vector<std::uint8_t> cleared;  ///< by tile: 1 while its texels are still to be filled
  std::array<std::uint32_t, 4> clear_words{};
  float clear_depth = 1.0f;
  std::uint8_t clear_stencil = 0;

  GpuImage() = default;
  GpuImage(Format f, int w, int h, int s, int array_layers = 1, int coverage = 0);

  /// Before a tile's texels are read or written.
  void use(int block_index) {
    const auto i = static_cast<std::size_t>(block_index);
    if (cleared[i] != 0) fill(block_index);
    if (!plane_count.empty() && plane_count[i] != 0) expand_depth_tile(*this, block_index);
    if (!stale_lanes.empty() && stale_lanes[i] != 0) spread_stale_samples(*this, block_index);
  }
  /// Before sample 0 of a color tile is used; other samples of its stale lanes may be garbage.
  void use_first_sample(int block_index) {
    if (cleared[static_cast<std::size_t>(block_index)] != 0) fill_first_sample(block_index);
  }
  void fill_first_sample(int block_index);
  /// Before a tile's stencil is used, or its depth where planes will do.
  void use_planes(int block_index) {
    if (cleared[static_cast<std::size_t>(block_index)] != 0) start_planes(block_index);
  }
  void fill(int block_index);
  void start_planes(int block_index);
  /// Fills what is marked, depth as planes.
  void start_all(int jobs);
  /// Before texels anywhere are read: fills what is still marked.
  void use_all(int jobs);
  /// The same before shaders read, who find samples where shade/image_access-inl.h looks for them. `pack`:
  /// where most quads have one color, the further samples of the others move to `packed`, and the memory that
  /// they had is given back; texels but those of sample 0 are then stale until end_reads().
  void begin_reads(bool pack, int jobs);
  /// Before the image is used in another way.
  void end_reads(int jobs);
  /// Gives the memory of planes back where no tile is held as such: a sixth of what depth at 8x takes.
  void release_planes();
  /// Texels in place of planes; cleared tiles stay so.
  void expand_all(int jobs);

  /// A tile's layers lie one after the other, each a block with its own state: so sample s of layer l is also
  /// plane l * samples + s of the tile.
  std::size_t block_words() const { return static_cast<std::size_t>(samples * words * kBlockLanes); }
  /// A block's texels: all of them one after the other, but where first_samples_apart.
  std::uint32_t* block(int block_index) { return texels.data() + first_word(block_index, 0); }
  const std::uint32_t* block(int block_index) const { return texels.data() + first_word(block_index, 0); }
  std::uint32_t* sample_of_block(int block_index, int sample) {
    return texels.data() + first_word(block_index, sample);
  }
  const std::uint32_t* sample_of_block(int block_index, int sample) const {
    return texels.data() + first_word(block_index, sample);
  }
  std::uint8_t* stencil_block(int block_index) {
    return stencil.data() +
           static_cast<std::size_t>(block_index) * static_cast<std::size_t>(samples * kBlockLanes);
  }
  /// Whether pixels of one color are tracked.
  bool tracks_colors() const { return !single_lanes.empty(); }
  /// What shaders or copies wrote is not tracked: any sample may differ from any other.
  void forget_colors();
  std::uint64_t* tile_second_color(int block_index) {
    return second_color.data() + static_cast<std::size_t>(block_index * samples);
  }
  DepthPlane* tile_planes(int block_index) {
    return planes.data() + static_cast<std::size_t>(block_index) * kMaxDepthPlanes;
  }
  /// kMaxDepthPlanes * samples masks.
  std::uint64_t* tile_plane_lanes(int block_index) {
    return plane_lanes.data() + static_cast<std::size_t>(block_index * kMaxDepthPlanes * samples);
  }
  /// Lanes of a tile that lie in the image.
  std::uint64_t lanes_inside(int block_index) const;
  int block_index(int x, int y, int layer = 0) const {
    return ((y / kBlockPx) * blocks_x + x / kBlockPx) * layers + layer;
  }
  /// Pixel of a block's corner.
  int block_x(int block_index) const { return block_index / layers % blocks_x * kBlockPx; }
  int block_y(int block_index) const { return block_index / layers / blocks_x * kBlockPx; }
  std::size_t word_index(int x, int y, int sample, int word) const {
    return first_word(block_index(x, y), sample) +
           static_cast<std::size_t>(word * kBlockLanes + lane_of(x & 7, y & 7));
  }

 private:
  void place_texels();
  void release_further_samples(int row);
  std::size_t sample_words() const { return static_cast<std::size_t>(words * kBlockLanes); }
  std::size_t first_word(int block_index, int sample) const {
    const auto i = static_cast<std::size_t>(block_index);
    if (sample == 0) return i * first_stride;
    return further_begin + i * further_stride + static_cast<std::size_t>(sample - 1) * sample_words();
  }
  template <class Body>
  void for_each_block(int jobs, const Body& body);
};

/// One texel decoded to linear floats (integer formats: the value as a float; depth: 0..1 in r).
void read_texel(const GpuImage& image, int x, int y, int sample, float rgba[4]);

}  // namespace hwsim::pipeline
