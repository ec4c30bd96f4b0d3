#include "pipeline/emulate/pass_description.h"

#include <algorithm>

#include "pipeline/graph/commands.h"

namespace hwsim::pipeline {

namespace {

/// What the pass's shaders read, first since it was drawn on. Shaders' stores and copies compress nothing.
std::vector<ReadTargetWork> read_targets(const FrameGraph& graph, const CompiledGraph& compiled,
                                         int position) {
  const auto pass_at = [&](int p) -> const Pass& {
    return graph.passes()[static_cast<std::size_t>(compiled.order[static_cast<std::size_t>(p)])];
  };
  const auto drawn_last = [&](ImageId image) {
    for (int p = position - 1; p >= 0; --p) {
      const Pass& earlier = pass_at(p);
      if (std::ranges::count(earlier.color, image) > 0) return true;
      if (earlier.depth == image && !earlier.depth_read_only) return true;
      if (std::ranges::count(earlier.sampled, image) > 0 || std::ranges::count(earlier.targets, image) > 0)
        return false;
    }
    return false;
  };
  std::vector<ReadTargetWork> targets;
  const std::vector<ImageId>& sampled = pass_at(position).sampled;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const bool before = std::find(sampled.begin(), sampled.begin() + static_cast<std::ptrdiff_t>(i),
                                  sampled[i]) != sampled.begin() + static_cast<std::ptrdiff_t>(i);
    if (before || !drawn_last(sampled[i])) continue;
    const ImageDesc& desc = graph.image(sampled[i]);
    targets.push_back({desc.format, desc.samples,
                       static_cast<std::uint64_t>(desc.width) * static_cast<std::uint64_t>(desc.height) *
                           static_cast<std::uint64_t>(desc.layers)});
  }
  return targets;
}

}  // namespace

PassWork describe(const FrameGraph& graph, const CompiledGraph& compiled, int position,
                  std::span<const char> cleared) {
  const auto in_order = static_cast<std::size_t>(position);
  const Pass& pass = graph.passes()[static_cast<std::size_t>(compiled.order[in_order])];
  const auto use = [&](ImageId id) { return attachment_use(graph, compiled, position, id); };
  PassWork work;
  work.name = pass.name;
  work.kind = pass.kind;
  work.width_px = pass.width;
  work.height_px = pass.height;
  work.raster_samples = std::max(pass.samples, pass.coverage_samples);
  work.barrier_before = compiled.barrier_before[in_order] != 0;
  work.source_in_tile = resolves_from_tile(graph, compiled, position);
  if (pass.depth) {
    work.depth_loaded = use(pass.depth).loaded;
    work.depth_kept = use(pass.depth).kept;
    work.depth_format = graph.image(pass.depth).format;
    work.depth_samples = graph.image(pass.depth).samples;
    work.depth_cleared_before = cleared[static_cast<std::size_t>(pass.depth.index)] != 0;
  }
  work.color_cleared_before = !pass.color.empty();
  const std::vector<ImageId>& written = pass.color.empty() ? pass.targets : pass.color;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const ImageDesc& desc = graph.image(written[i]);
    bool blended = i < pass.state.blend.size() && pass.state.blend[i].enabled;
    for (const DrawBatch& batch : pass.batches)
      blended = blended || (i < batch.state.blend.size() && batch.state.blend[i].enabled);
    const bool every_layer = pass.kind != PassKind::draw && pass.kind != PassKind::full_screen;
    const bool covers = pass.kind != PassKind::draw && !blended;  // what was there does not matter
    work.color_targets.push_back({desc.format, desc.samples * (every_layer ? desc.layers : 1), blended,
                                  !covers && use(written[i]).loaded, use(written[i]).kept});
    work.color_cleared_before =
        work.color_cleared_before && cleared[static_cast<std::size_t>(written[i].index)] != 0;
  }
  work.read_targets = read_targets(graph, compiled, position);
  if (pass.compute != nullptr) {
    const int lanes = pass.compute->group_width * pass.compute->group_height;
    work.group_memory_lane_bytes = (pass.compute->group_memory_bytes + lanes - 1) / lanes;
  }
  work.sample_rate = pass.state.raster.sample_rate;
  for (const DrawBatch& batch : pass.batches) {
    work.sample_rate = work.sample_rate || batch.state.raster.sample_rate;
    if (batch.vertex != nullptr)
      work.attribute_scalars = std::max(work.attribute_scalars, batch.raster_scalars());
  }
  return work;
}

void count_commands(const FrameGraph& graph, const Pass& pass, const PassContext& c, bool barrier,
                    std::vector<PassCounters>& chunks) {
  for (const Command& command : record_pass(graph, pass, barrier)) {
    const bool of_draw = pass.kind == PassKind::draw && command.draw < c.draws.size();
    const std::size_t chunk = of_draw ? c.draws[command.draw].first_primitive / c.chunk_primitives : 0;
    FrontEndCounters& n = chunks[std::min(chunk, chunks.size() - 1)].fe;
    n.command_words += command_words(command.kind);
    const bool binds =
        command.kind == CommandKind::bind_pipeline || command.kind == CommandKind::bind_resources;
    n.state_changes += binds ? 1 : 0;
    n.draws += command.kind >= CommandKind::draw ? 1 : 0;  // draws, dispatches and transfers: they start work
  }
}

void count_inputs(const PassContext& c, std::vector<PassCounters>& chunks) {
  for (const DrawInfo& draw : c.draws) {
    const std::size_t chunk =
        std::min<std::size_t>(draw.first_primitive / c.chunk_primitives, chunks.size() - 1);
    // Transforms and material, as a driver would bind them.
    chunks[chunk].mem.constant_read_bytes += 64 + 36 + sizeof(MaterialView);
  }
}

}  // namespace hwsim::pipeline
