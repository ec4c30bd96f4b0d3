#include "pipeline/emulate/pass_key.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <string_view>

namespace hwsim::pipeline {

// All members by name: a new one that is forgotten here does not compile. States without padding go by their
// bytes.

static void add_content(ContentDigest& digest, const RasterState& state) {
  const auto& [topology, primitive_size_px, cull, conservative, centroid, sample_rate, sample_positions,
               texture_footprint] = state;
  digest.add(topology, primitive_size_px, cull, conservative, centroid, sample_rate, sample_positions,
             texture_footprint);
}
static void add_content(ContentDigest& digest, const PipelineState& state) {
  const auto& [depth, stencil, raster, coverage, blend, force_early_z] = state;
  digest.add(depth, stencil, raster, coverage, blend, force_early_z);
}
static void add_content(ContentDigest& digest, const FunctionalConfig& functional) {
  const auto& [post_transform_cache_entries, gs_max_scalars, late_z_on_discard, hierarchical_z,
               max_image_px] = functional;
  digest.add(post_transform_cache_entries, gs_max_scalars, late_z_on_discard, hierarchical_z, max_image_px);
}

namespace {

/// Large arrays by their bytes.
void add_words(ContentDigest& digest, std::span<const std::uint32_t> words) {
  ContentHash hash;
  hash.add(std::span(reinterpret_cast<const std::uint8_t*>(words.data()), words.size_bytes()));
  digest.add(words.size(), hash.words());
}

class Keys {
 public:
  Keys(const FrameGraph& graph, const FunctionalConfig& functional, const EmulationOptions& options)
      : graph_(graph), images_(graph.images().size()), buffers_(graph.buffers().size()) {
    ContentDigest digest;
    digest.add(&graph.scene(), graph.width(), graph.height(), functional, options.skip, options.exact_reuse);
    common_ = digest.words();
    for (std::size_t i = 0; i < images_.size(); ++i) images_[i] = fresh_image(static_cast<int>(i));
    for (std::size_t i = 0; i < buffers_.size(); ++i) buffers_[i] = fresh_buffer(graph.buffers()[i]);
  }

  KeyedPass key(const Pass& pass, bool barrier_before) {
    KeyedPass keyed;
    ContentDigest digest;
    digest.add(common_, barrier_before);
    add_targets(digest, pass, keyed);
    bool known = add_settings(digest, pass);
    for (const DrawBatch& batch : pass.batches) known = add_batch(digest, batch) && known;
    for (const int image : keyed.images) keyed.before.push_back(images_[static_cast<std::size_t>(image)]);
    for (const int buffer : keyed.buffers) keyed.before.push_back(buffers_[static_cast<std::size_t>(buffer)]);
    digest.add(keyed.before);
    digest.add(known ? 0 : ++unknown_, occurrences_[digest.words()]++);  // no two of a frame have one key
    keyed.key = digest.words();
    leave(keyed);
    return keyed;
  }

  Digest image_state(ImageId id) const { return images_[static_cast<std::size_t>(id.index)]; }

 private:
  Digest fresh_image(int index) const {
    const auto& [name, format, width, height, samples, layers, coverage_samples] =
        graph_.images()[static_cast<std::size_t>(index)];
    static_cast<void>(name);
    ContentDigest digest;
    digest.add('i', format, width, height, samples, layers, coverage_samples);
    if (const RawImage* contents = graph_.contents({index})) add_words(digest, contents->texels);
    return digest.words();
  }

  static Digest fresh_buffer(const BufferDesc& desc) {
    const auto& [name, words, contents] = desc;
    static_cast<void>(name);
    ContentDigest digest;
    digest.add('b', words);
    if (contents) add_words(digest, *contents);
    return digest.words();
  }

  static int place(std::vector<int>& list, int index) {
    if (index < 0) return -1;
    const auto found = std::ranges::find(list, index);
    const auto at = static_cast<int>(found - list.begin());
    if (found == list.end()) list.push_back(index);
    return at;
  }

  /// Which of the images it touches are what to the pass.
  static void add_targets(ContentDigest& digest, const Pass& pass, KeyedPass& keyed) {
    const auto add_images = [&](const std::vector<ImageId>& ids) {
      digest.add(ids.size());
      for (const ImageId id : ids) digest.add(place(keyed.images, id.index));
    };
    add_images(pass.color);
    add_images(pass.sampled);
    add_images(pass.targets);
    for (const ImageId id : {pass.depth, pass.depth_planes, pass.source})
      digest.add(place(keyed.images, id.index));
    digest.add(pass.storage.size());
    for (const BufferId id : pass.storage) digest.add(place(keyed.buffers, id.index));
  }

  static bool add_settings(ContentDigest& digest, const Pass& pass) {
    const auto& [name, kind, width, height, samples, coverage_samples, drop_orphans, viewports, color, depth,
                 depth_read_only, sampled, views, storage, storage_written, depth_planes, depth_planes_given,
                 batches, state, fragment, compute, groups_x, groups_y, uniforms, targets, source, resolve,
                 clear_color, clear_depth, clear_stencil, target_views, full_screen_depth, keep] = pass;
    static_cast<void>(name), static_cast<void>(keep);  // nothing is emulated by them
    static_cast<void>(color), static_cast<void>(depth), static_cast<void>(sampled);  // add_targets()
    static_cast<void>(storage), static_cast<void>(depth_planes), static_cast<void>(targets);
    static_cast<void>(source), static_cast<void>(batches);
    digest.add(kind, width, height, samples, coverage_samples, drop_orphans, viewports, depth_read_only,
               views, storage_written, depth_planes_given, state, fragment, compute, groups_x, groups_y,
               resolve, clear_color, clear_depth, clear_stencil, target_views, full_screen_depth);
    return uniforms.add_to(digest);
  }

  static bool add_batch(ContentDigest& digest, const DrawBatch& batch) {
    const auto& [state, vertex, geometry, fragment, vertex_uniforms, geometry_uniforms, fragment_uniforms,
                 draws, tessellated_points] = batch;
    digest.add(state, vertex, geometry, fragment, tessellated_points, draws.size());
    for (const DrawCall& draw : draws) {
      const auto& [instance, part, list] = draw;
      digest.add(instance, part, list != nullptr);
      if (list) add_words(digest, list->indices);
    }
    bool known = true;
    for (const Uniforms* uniforms : {&vertex_uniforms, &geometry_uniforms, &fragment_uniforms})
      known = uniforms->add_to(digest) && known;
    return known;
  }

  /// Everything that the pass touched has another state.
  void leave(KeyedPass& keyed) {
    const auto next = [&](Digest& state) {
      ContentDigest digest;
      digest.add(keyed.key, keyed.after.size());
      state = digest.words();
      keyed.after.push_back(state);
    };
    for (const int image : keyed.images) next(images_[static_cast<std::size_t>(image)]);
    for (const int buffer : keyed.buffers) next(buffers_[static_cast<std::size_t>(buffer)]);
  }

  static inline std::atomic<int> unknown_ = 0;

  const FrameGraph& graph_;
  Digest common_;
  std::vector<Digest> images_, buffers_;
  std::map<Digest, int> occurrences_;
};

}  // namespace

KeyedFrame key_frame(const FrameGraph& graph, const CompiledGraph& compiled,
                     const FunctionalConfig& functional, const EmulationOptions& options) {
  Keys keys(graph, functional, options);
  KeyedFrame frame;
  for (std::size_t position = 0; position < compiled.order.size(); ++position)
    frame.passes.push_back(keys.key(graph.passes()[static_cast<std::size_t>(compiled.order[position])],
                                    compiled.barrier_before[position] != 0));
  frame.output = keys.image_state(graph.output());
  return frame;
}

}  // namespace hwsim::pipeline
