// From a graph to what runs: needed passes, barriers, lifetimes, memory.
#include <algorithm>

#include "pipeline/graph/frame_graph.h"
#include "pipeline/graph/validate.h"

namespace hwsim::pipeline {
namespace {

bool overwrites(PassKind kind) {
  return kind == PassKind::clear || kind == PassKind::copy || kind == PassKind::resolve;
}

bool writes_stencil(const PipelineState& state) {
  const StencilState& s = state.stencil;
  return s.test &&
         (s.on_pass != StencilOp::keep || s.on_fail != StencilOp::keep || s.on_depth_fail != StencilOp::keep);
}

/// Read-only depth may still have its stencil written.
bool writes_stencil(const Pass& pass) {
  return writes_stencil(pass.state) ||
         std::any_of(pass.batches.begin(), pass.batches.end(),
                     [](const DrawBatch& b) { return writes_stencil(b.state); });
}

/// Images and buffers in one index space: buffers follow the images.
struct Access {
  std::vector<int> reads, writes;
};

Access access(const FrameGraph& graph, const Pass& pass) {
  const int images = static_cast<int>(graph.images().size());
  Access a;
  for (const ImageId id : pass.color) a.writes.push_back(id.index);
  if (pass.depth && pass.depth_read_only) a.reads.push_back(pass.depth.index);
  if (pass.depth && (!pass.depth_read_only || writes_stencil(pass))) a.writes.push_back(pass.depth.index);
  for (const ImageId id : pass.sampled) a.reads.push_back(id.index);
  for (const ImageId id : pass.targets) a.writes.push_back(id.index);
  if (pass.source) a.reads.push_back(pass.source.index);
  for (std::size_t slot = 0; slot < pass.storage.size(); ++slot) {
    const int index = images + pass.storage[slot].index;
    a.reads.push_back(index);
    if ((pass.storage_written >> slot & 1) != 0) a.writes.push_back(index);
  }
  return a;
}

std::vector<char> find_needed(const FrameGraph& graph, const std::vector<Access>& accesses) {
  const auto passes = graph.passes();
  std::vector<char> wanted(graph.images().size() + graph.buffers().size(), 0), needed(passes.size(), 0);
  if (graph.output()) wanted[static_cast<std::size_t>(graph.output().index)] = 1;
  for (std::size_t i = passes.size(); i-- > 0;) {
    const Access& a = accesses[i];
    const bool writes_wanted = std::any_of(a.writes.begin(), a.writes.end(),
                                           [&](int r) { return wanted[static_cast<std::size_t>(r)] != 0; });
    if (!writes_wanted && !passes[i].keep) continue;
    needed[i] = 1;
    for (const int r : a.writes) wanted[static_cast<std::size_t>(r)] = overwrites(passes[i].kind) ? 0 : 1;
    for (const int r : a.reads) wanted[static_cast<std::size_t>(r)] = 1;
  }
  return needed;
}

void find_barriers(const std::vector<Access>& accesses, CompiledGraph& compiled, std::size_t resources) {
  std::vector<char> written(resources, 0);
  for (const int index : compiled.order) {
    const Access& a = accesses[static_cast<std::size_t>(index)];
    // Reading what an earlier pass wrote waits for it; attachments of successive passes stay in order without
    // a wait.
    const bool waits = std::any_of(a.reads.begin(), a.reads.end(),
                                   [&](int r) { return written[static_cast<std::size_t>(r)] != 0; });
    if (waits) std::fill(written.begin(), written.end(), 0);
    compiled.barrier_before.push_back(waits ? 1 : 0);
    for (const int r : a.writes) written[static_cast<std::size_t>(r)] = 1;
  }
}

void find_lifetimes(const FrameGraph& graph, const std::vector<Access>& accesses, CompiledGraph& compiled) {
  std::vector<CompiledGraph::Lifetime> all(graph.images().size() + graph.buffers().size());
  for (std::size_t position = 0; position < compiled.order.size(); ++position) {
    const Access& a = accesses[static_cast<std::size_t>(compiled.order[position])];
    const auto use = [&](int r) {
      CompiledGraph::Lifetime& life = all[static_cast<std::size_t>(r)];
      if (life.first_pass < 0) life.first_pass = static_cast<int>(position);
      life.last_pass = static_cast<int>(position);
    };
    std::for_each(a.reads.begin(), a.reads.end(), use);
    std::for_each(a.writes.begin(), a.writes.end(), use);
  }
  if (graph.output() && !compiled.order.empty())  // it is presented after the last pass
    all[static_cast<std::size_t>(graph.output().index)].last_pass =
        static_cast<int>(compiled.order.size()) - 1;
  const auto images = static_cast<std::ptrdiff_t>(graph.images().size());
  compiled.images.assign(all.begin(), all.begin() + images);
  compiled.buffers.assign(all.begin() + images, all.end());
}

/// Images that no pass names: a program holds them for other techniques than the one that runs.
std::vector<char> find_idle(const FrameGraph& graph, const std::vector<Access>& accesses) {
  std::vector<char> idle(graph.images().size(), 1);
  for (const Access& a : accesses)
    for (const auto* list : {&a.reads, &a.writes})
      for (const int r : *list)
        if (static_cast<std::size_t>(r) < idle.size()) idle[static_cast<std::size_t>(r)] = 0;
  return idle;
}

void sum_memory(const FrameGraph& graph, const std::vector<Access>& accesses, CompiledGraph& compiled) {
  std::vector<std::uint64_t> live(compiled.order.size() + 1, 0);
  const auto add = [&](const CompiledGraph::Lifetime& life, std::uint64_t bytes) {
    if (life.first_pass < 0) return;
    compiled.allocated_bytes += bytes;
    for (int p = life.first_pass; p <= life.last_pass; ++p) live[static_cast<std::size_t>(p)] += bytes;
  };
  for (std::size_t i = 0; i < compiled.images.size(); ++i)
    add(compiled.images[i], allocated_bytes(graph.images()[i]));
  for (std::size_t i = 0; i < compiled.buffers.size(); ++i)
    add(compiled.buffers[i], allocated_bytes(graph.buffers()[i]));
  compiled.peak_bytes = *std::max_element(live.begin(), live.end());
  const std::vector<char> idle = find_idle(graph, accesses);
  for (std::size_t i = 0; i < idle.size(); ++i)
    if (idle[i] != 0) compiled.allocated_bytes += allocated_bytes(graph.images()[i]);
}

enum class Use { none, contents, overwritten };

Use use_of(const FrameGraph& graph, const Pass& pass, ImageId image) {
  const Access a = access(graph, pass);
  const auto has = [&](const std::vector<int>& list) {
    return std::find(list.begin(), list.end(), image.index) != list.end();
  };
  if (has(a.reads)) return Use::contents;
  if (!has(a.writes)) return Use::none;
  return overwrites(pass.kind) ? Use::overwritten : Use::contents;
}

const Pass& pass_at(const FrameGraph& graph, const CompiledGraph& compiled, int position) {
  return graph.passes()[static_cast<std::size_t>(compiled.order[static_cast<std::size_t>(position)])];
}

bool draws(const Pass& pass) { return pass.kind == PassKind::draw || pass.kind == PassKind::full_screen; }

}  // namespace

bool resolves_from_tile(const FrameGraph& graph, const CompiledGraph& compiled, int position) {
  const Pass& pass = pass_at(graph, compiled, position);
  if (pass.kind != PassKind::resolve || position == 0) return false;
  const Pass& before = pass_at(graph, compiled, position - 1);
  const bool color = std::find(before.color.begin(), before.color.end(), pass.source) != before.color.end();
  return draws(before) && (color || before.depth == pass.source);
}

AttachmentUse attachment_use(const FrameGraph& graph, const CompiledGraph& compiled, int position,
                             ImageId image) {
  AttachmentUse result;
  result.loaded = graph.contents(image) != nullptr;
  for (int p = position - 1; p >= 0; --p) {
    const Pass& pass = pass_at(graph, compiled, p);
    if (use_of(graph, pass, image) == Use::none) continue;
    result.loaded = pass.kind != PassKind::clear;
    break;
  }
  result.kept = graph.output() == image;
  const auto end = static_cast<int>(compiled.order.size());
  for (int p = position + 1; p < end; ++p) {
    const Pass& pass = pass_at(graph, compiled, p);
    const bool from_tile =
        p == position + 1 && pass.source == image && resolves_from_tile(graph, compiled, p);
    const Use use = from_tile ? Use::none : use_of(graph, pass, image);
    if (use == Use::none) continue;
    result.kept = use == Use::contents;
    break;
  }
  return result;
}

CompiledGraph compile(const FrameGraph& graph, const GpuFeatures& features,
                      const FunctionalConfig& functional) {
  std::vector<Diagnostic> errors = validate(graph, features, functional);
  if (!errors.empty()) throw InputError(std::move(errors));
  std::vector<Access> accesses;
  for (const Pass& pass : graph.passes()) accesses.push_back(access(graph, pass));
  const std::vector<char> needed = find_needed(graph, accesses);
  CompiledGraph compiled;
  for (std::size_t i = 0; i < needed.size(); ++i)
    (needed[i] != 0 ? compiled.order : compiled.culled).push_back(static_cast<int>(i));
  find_barriers(accesses, compiled, graph.images().size() + graph.buffers().size());
  find_lifetimes(graph, accesses, compiled);
  sum_memory(graph, accesses, compiled);
  return compiled;
}

}  // namespace hwsim::pipeline
