#include "pipeline/emulate/gpu_image.h"

#include "pipeline/shade/codec.h"
#include "pipeline/shade/scalar_lane.h"
#include "pipeline/shade/texture_view.h"

namespace hwsim::pipeline {

GpuImage::GpuImage(Format f, int w, int h, int s) : format(f), width(w), height(h), samples(s) {
  const FormatInfo& format_info = info(f);
  words = format_info.is_depth ? 1 : (format_info.bytes + 3) / 4;
  if (format_info.is_integer) words = format_info.channels;
  blocks_x = (w + kBlockPx - 1) / kBlockPx;
  blocks_y = (h + kBlockPx - 1) / kBlockPx;
  const auto blocks = static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y);
  texels.resize(blocks * block_words());
  touched_chunk.resize(blocks);
  if (format_info.is_depth) {
    depth_min.resize(blocks);
    depth_max.resize(blocks);
  }
  if (format_info.has_stencil) stencil.resize(blocks * static_cast<std::size_t>(s * kBlockLanes));
}

void read_texel(const GpuImage& image, int x, int y, int sample, float rgba[4]) {
  ScalarI words[4] = {0, 0, 0, 0};
  for (int word = 0; word < image.words; ++word)
    words[word] = static_cast<std::int32_t>(image.texels[image.word_index(x, y, sample, word)]);
  const Vec4<ScalarF> c = decode_texel<ScalarF, ScalarI>(image.format, words, srgb_decode_table().data());
  rgba[0] = c.x.v;
  rgba[1] = c.y.v;
  rgba[2] = c.z.v;
  rgba[3] = c.w.v;
}

}  // namespace hwsim::pipeline
