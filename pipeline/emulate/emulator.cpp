#include "pipeline/emulate/emulator.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <stdexcept>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/binning.h"
#include "pipeline/emulate/color_traffic.h"
#include "pipeline/emulate/depth_traffic.h"
#include "pipeline/emulate/frame_memory.h"
#include "pipeline/emulate/geometry.h"
#include "pipeline/emulate/material_views.h"
#include "pipeline/emulate/pass_description.h"
#include "pipeline/emulate/pass_reuse.h"
#include "pipeline/emulate/shading_heat.h"
#include "pipeline/emulate/shared_passes.h"
#include "pipeline/emulate/transfer.h"
#include "pipeline/memory/depth_format.h"

namespace hwsim::pipeline {
namespace {

constexpr std::uint64_t kFullScreenBands = 64;

/// Runs the passes of one compiled graph in order.
class FrameRunner {
 public:
  FrameRunner(const FrameGraph& graph, const CompiledGraph& compiled, const FunctionalConfig& functional,
              const EmulationOptions& options)
      : graph_(graph),
        compiled_(compiled),
        functional_(functional),
        options_(options),
        textures_(graph.scene()),
        materials_(graph.scene(), textures_),
        memory_(graph, compiled),
        shared_(options.inspect ? nullptr : options.memo, graph, compiled, functional, options),
        workers_(static_cast<std::size_t>(std::max(1, options.jobs))),
        fetches_(functional.post_transform_cache_entries, options.exact_reuse),
        heat_(graph.width(), graph.height()) {}

  void run(Emulation& result) {
    for (std::size_t position = 0; position < compiled_.order.size(); ++position) {
      const Pass& pass = graph_.passes()[static_cast<std::size_t>(compiled_.order[position])];
      if (options_.progress)
        options_.progress(static_cast<double>(position) / static_cast<double>(compiled_.order.size()),
                          pass.name);
      const PassResult* known = shared_.reused(position);
      if (known == nullptr) {
        memory_.allocate(static_cast<int>(position));
        shared_.bring(position, memory_);
      }
      PassWork work = describe(graph_, compiled_, static_cast<int>(position), memory_.cleared());
      const auto start = std::chrono::steady_clock::now();
      const std::clock_t cpu_start = std::clock();
      known != nullptr ? reuse_pass(position, *known, work) : run_and_keep(position, pass, work);
      memory_.note_writes(pass);
      result.pass_cpu_s.push_back(static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC);
      result.pass_wall_s.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      result.trace.passes.push_back(std::move(work));
      if (options_.inspect) options_.inspect(pass, memory_.images());
      memory_.release(static_cast<int>(position));
    }
    if (options_.progress) options_.progress(1.0, "");
    shared_.bring_output(graph_.output(), memory_);
    result.color = read_output();
    result.shading_heat = heat_.image(options_.jobs);
    for (const BinWorker& worker : workers_)
      if (const std::uint64_t n = worker.hidden_samples_passed; n != 0)
        throw std::logic_error("the coarse depth test killed " + std::to_string(n) + " samples that pass");
    result.skipped = (skipped() + reused_skips_).by_name();
    result.skipped["passes"] = compiled_.culled.size();
    result.reused_passes = shared_.reused_passes();
  }

 private:
  GpuImage& image(ImageId id) { return memory_.image(id); }
  /// For all uses but a shader's reads.
  GpuImage& whole_image(ImageId id) {
    image(id).end_reads(options_.jobs);
    return image(id);
  }

  SkipCounts skipped() const {
    SkipCounts counts{.frustum = skipped_clusters_,
                      .cleared_tiles = memory_.untouched_tiles(),
                      .single_color_pixels = skipped_pixels_};
    for (const BinWorker& worker : workers_) {
      counts.hidden_tiles += worker.hidden_tiles_skipped;
      counts.accepted_tiles += worker.accepted_tiles_skipped;
      counts.plane_tiles += worker.plane_tiles_skipped;
    }
    return counts;
  }

  void reuse_pass(std::size_t position, const PassResult& known, PassWork& work) {
    work.chunks = known.chunks;
    work.reuse = known.reuse;
    work.raster_samples = known.raster_samples;
    reused_skips_ += known.skipped;
    heat_.add(known.heat);
    shared_.take(position, memory_);
  }

  void run_and_keep(std::size_t position, const Pass& pass, PassWork& work) {
    if (!shared_.wants(position)) {
      run_pass(pass, work);
    } else {
      const SkipCounts skipped_before = skipped();
      const std::vector<std::uint32_t> heat_before = heat_.counts();
      run_pass(pass, work);
      shared_.keep(position, memory_,
                   {.chunks = work.chunks,
                    .reuse = work.reuse,
                    .raster_samples = work.raster_samples,
                    .skipped = skipped() - skipped_before,
                    .heat = heat_.added_since(heat_before),
                    .untouched_tiles = {}});
    }
    shared_.keep_states(position, memory_);
  }

  void run_pass(const Pass& pass, PassWork& work) {
    switch (pass.kind) {
      case PassKind::draw:
        run_draw(pass, work);
        break;
      case PassKind::full_screen:
        run_full_screen(pass, work);
        break;
      case PassKind::compute:
        run_compute(pass, work);
        break;
      default:
        run_transfer(pass, work);
        break;
    }
  }

  PassContext make_context(const Pass& pass) {
    PassContext c;
    c.hierarchical_z = functional_.hierarchical_z;
    c.pass = &pass;
    c.width = pass.width;
    c.height = pass.height;
    c.samples = pass.samples;
    c.bins_x = (pass.width + kBinPx - 1) / kBinPx;
    c.bins_y = (pass.height + kBinPx - 1) / kBinPx;
    c.skip = options_.skip;
    if (pass.depth) {
      c.depth = &image(pass.depth);
      c.depth_scale = depth_scale(c.depth->format);
      c.depth_bytes = info(c.depth->format).bytes;
    }
    for (const ImageId id : pass.color) c.color.push_back(&whole_image(id));
    if (pass.coverage_samples > 0) c.coverage_map = c.color.front();
    set_viewports(pass, c);
    bind(pass, c.resources);
    set_positions(pass, c);
    if (c.depth != nullptr) place_planes(*c.depth, c.positions);
    heat_.attach(c);
    return c;
  }

  void bind(const Pass& pass, ResourceView& resources) {
    resources.materials = materials_.views();
    if (pass.depth_planes) {  // before texels are asked for: that ends the planes' use for tests
      GpuImage& depth = image(pass.depth_planes);
      planes_ = {&depth, held_planes(depth)};
      resources.depth_planes = &planes_;
    }
    for (std::size_t i = 0; i < pass.sampled.size(); ++i) {
      image(pass.sampled[i]).begin_reads(options_.skip.single_color_pixels, options_.jobs);
      if (pass.sampled[i].index != pass.depth_planes.index) image(pass.sampled[i]).release_planes();
      resources.images[i] = &image(pass.sampled[i]);
      resources.formats[i] = pass.view_of(graph_, i);
    }
    for (std::size_t i = 0; i < pass.targets.size() && i < resources.targets.size(); ++i) {
      whole_image(pass.targets[i]).use_all(options_.jobs);
      image(pass.targets[i]).forget_colors();
      resources.targets[i] = &image(pass.targets[i]);
      resources.target_formats[i] = pass.target_view_of(graph_, i);
    }
    for (std::size_t i = 0; i < pass.storage.size(); ++i) {
      std::vector<std::uint32_t>& words = memory_.buffer(pass.storage[i]);
      resources.buffers[i] = words.data();
      resources.buffer_words[i] = words.size();
    }
  }

  /// A tile that nothing was drawn into is the plane of the clear value.
  static std::vector<std::uint8_t> held_planes(GpuImage& depth) {
    for (int block = 0; block < static_cast<int>(depth.cleared.size()); ++block) depth.use_planes(block);
    return depth.plane_count;
  }

  /// Planes were written for other sample positions: only their samples still hold
  /// (docs/compression.md#depth).
  void place_planes(GpuImage& depth, std::span<const SamplePosition> positions) const {
    const auto same = [](SamplePosition a, SamplePosition b) { return a.x == b.x && a.y == b.y; };
    if (std::equal(positions.begin(), positions.end(), depth.plane_positions.begin(),
                   depth.plane_positions.end(), same))
      return;
    if (!depth.plane_positions.empty()) depth.expand_all(options_.jobs);
    depth.plane_positions.assign(positions.begin(), positions.end());
  }

  static void set_viewports(const Pass& pass, PassContext& c) {
    static constexpr ViewportShift kNone{};
    c.viewports = pass.viewports.empty() ? std::span(&kNone, 1) : std::span(pass.viewports);
    int largest = 0;
    for (const ViewportShift shift : c.viewports)
      largest = std::max({largest, std::abs(shift.x), std::abs(shift.y)});
    c.band = guard_band(pass.width, pass.height, (largest + kSubpixelUnits - 1) / kSubpixelUnits);
  }

  void set_positions(const Pass& pass, PassContext& c) {
    c.positions = standard_sample_positions(pass.samples);
    const PipelineState& state = pass.batches.empty() ? pass.state : pass.batches.front().state;
    if (!state.raster.sample_positions.empty()) c.positions = state.raster.sample_positions;
    c.coverage_positions = c.positions;
    c.centroid = standard_centroid(pass.samples);
    if (!state.raster.sample_positions.empty()) c.centroid = {c.positions, {}};
    if (pass.coverage_samples > 0) {
      coverage_positions_ = coverage_positions(pass.samples, pass.coverage_samples);
      c.coverage_positions = coverage_positions_;
      c.centroid = {c.coverage_positions, {}};
      c.positions = c.coverage_positions.first(static_cast<std::size_t>(pass.samples));
    }
    const auto [left, right] = std::ranges::minmax_element(c.coverage_positions, {}, &SamplePosition::x);
    const auto [top, bottom] = std::ranges::minmax_element(c.coverage_positions, {}, &SamplePosition::y);
    c.sample_min_x = left->x;
    c.sample_max_x = right->x;
    c.sample_min_y = top->y;
    c.sample_max_y = bottom->y;
  }

  void start_workers(const Pass& pass, std::size_t chunk_count, PassContext& c) {
    c.chunk_count = chunk_count;
    c.resources.image_first_line = image_lines(graph_, pass, textures_.line_count());
    const BlockKinds kinds = block_kinds(graph_, pass, c, textures_.line_count(), options_.exact_reuse);
    for (BinWorker& worker : workers_) {
      worker.chunks.assign(chunk_count, PassCounters{});
      worker.tracker.start_pass(kinds, !pass.storage.empty(), options_.exact_reuse ? SIZE_MAX : kAccessesMax);
      worker.resources = c.resources;
      worker.resources.tracker = &worker.tracker;
    }
    for (GpuImage* target : c.color) std::fill(target->touched_chunk.begin(), target->touched_chunk.end(), 0);
    if (c.depth != nullptr) std::fill(c.depth->touched_chunk.begin(), c.depth->touched_chunk.end(), 0);
  }

  /// Gives what was written back to memory, each tile at the cost of the chunk that used it last.
  template <class Save>
  void save_tiles(GpuImage& target, Save&& save) {
    constexpr std::size_t kTilesAtOnce = 512;
    const std::size_t tiles = target.unsaved.size();
    parallel_for((tiles + kTilesAtOnce - 1) / kTilesAtOnce, options_.jobs, [&](std::size_t i, int worker) {
      for (std::size_t tile = i * kTilesAtOnce; tile < std::min(tiles, (i + 1) * kTilesAtOnce); ++tile)
        save(target, static_cast<int>(tile), workers_[static_cast<std::size_t>(worker)].chunks);
    });
  }

  // Integer sums: the same whichever worker counted.
  void finish_workers(const Pass& pass, PassWork& work) {
    if (pass.depth) save_tiles(image(pass.depth), save_depth_tile);
    for (const ImageId id : pass.color) save_tiles(image(id), save_color_tile);
    work.chunks.assign(workers_.front().chunks.size(), PassCounters{});
    for (const BinWorker& worker : workers_)
      for (std::size_t i = 0; i < work.chunks.size(); ++i) work.chunks[i] += worker.chunks[i];
    work.reuse = merge_reuse(workers_, work, options_.exact_reuse, options_.jobs);
    if (!pass.storage.empty()) share_same_address(workers_, work);
  }

  void run_draw(const Pass& pass, PassWork& work) {
    PassContext c = make_context(pass);
    c.draws = materials_.make_draws(pass, graph_.scene());
    std::uint64_t triangles = 0;
    for (DrawInfo& draw : c.draws) {
      draw.first_primitive = static_cast<std::uint32_t>(triangles);
      triangles += draw.primitive_count();
    }
    c.chunk_primitives = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(triangles / 256, 32, 4096));
    start_workers(pass, std::max<std::uint64_t>(1, (triangles + c.chunk_primitives - 1) / c.chunk_primitives),
                  c);
    count_commands(graph_, pass, c, work.barrier_before, workers_.front().chunks);
    count_inputs(c, workers_.front().chunks);
    std::uint32_t first = 0;
    while (first < c.draws.size()) {
      std::uint32_t last = first;
      const std::uint64_t most = std::max<std::uint64_t>(1, kSegmentTriangles / c.viewports.size());
      for (std::uint64_t n = 0; last < c.draws.size() && n < most; ++last)
        n += c.draws[last].primitive_count();
      start_segment(c, first, last, segment_);
      skipped_clusters_ +=
          run_vertices(c, segment_, {options_.jobs, options_.skip.frustum}, workers_, fetches_);
      while (next_items(c, segment_)) run_items(c, bin_jobs(pass));
      first = last;
    }
    end_segments(segment_, workers_);
    finish_workers(pass, work);
  }

  void run_items(const PassContext& c, int jobs) {
    run_primitives(c, segment_, options_.jobs, workers_);
    if (jobs > 1) sort_bins_by_work(c, segment_);
    parallel_for(segment_.bins.size(), jobs, [&](std::size_t i, int worker) {
      run_bin(c, segment_, static_cast<int>(segment_.bins[i]), workers_[static_cast<std::size_t>(worker)]);
    });
  }

  /// One thread where what is stored depends on the order, so that the result does not depend on the threads.
  int bin_jobs(const Pass& pass) const {
    bool ordered = pass.fragment != nullptr && pass.fragment->ordered_storage;
    for (const DrawBatch& batch : pass.batches)
      ordered = ordered || (batch.fragment != nullptr && batch.fragment->ordered_storage);
    return ordered ? 1 : options_.jobs;
  }

  void run_full_screen(const Pass& pass, PassWork& work) {
    PassContext c = make_context(pass);
    const auto bins = static_cast<std::uint64_t>(c.bins_x) * static_cast<std::uint64_t>(c.bins_y);
    const std::uint64_t bands = std::min(bins, kFullScreenBands);
    start_workers(pass, bands, c);
    count_commands(graph_, pass, c, work.barrier_before, workers_.front().chunks);
    workers_.front().chunks[0].stats.input_assembly_vertices += 3;  // one triangle that covers the screen
    workers_.front().chunks[0].stats.vertex_shader_invocations += 3;
    parallel_for(bins, bin_jobs(pass), [&](std::size_t bin, int worker) {
      BinWorker& w = workers_[static_cast<std::size_t>(worker)];
      w.current_chunk = static_cast<std::uint32_t>(bin * bands / bins);
      run_full_screen_bin(c, static_cast<int>(bin), w);
    });
    apply_stores(c.resources);
    finish_workers(pass, work);
  }

  void apply_stores(const ResourceView& resources) {
    std::vector<ImageStore> stores;
    for (BinWorker& worker : workers_) {
      stores.insert(stores.end(), worker.stores.begin(), worker.stores.end());
      worker.stores.clear();
    }
    std::stable_sort(stores.begin(), stores.end(), [](const ImageStore& a, const ImageStore& b) {
      return a.target != b.target ? a.target < b.target : a.order < b.order;
    });
    for (const ImageStore& store : stores) resources.targets[store.target]->texels[store.texel] = store.word;
  }

  void run_compute(const Pass& pass, PassWork& work) {
    PassContext c = make_context(pass);
    const auto groups = static_cast<std::uint64_t>(pass.groups_x) * static_cast<std::uint64_t>(pass.groups_y);
    const std::uint64_t bands = std::min(groups, kFullScreenBands);
    start_workers(pass, bands, c);
    count_commands(graph_, pass, c, work.barrier_before, workers_.front().chunks);
    std::vector<std::vector<std::uint32_t>> memory(
        workers_.size(),
        std::vector<std::uint32_t>(static_cast<std::size_t>(pass.compute->group_memory_bytes) / 4 + 1));
    std::vector<std::unique_ptr<GroupBatch>> batches;
    for (std::size_t i = 0; i < workers_.size(); ++i) batches.push_back(std::make_unique<GroupBatch>());
    const int jobs = pass.compute->ordered_storage ? 1 : options_.jobs;
    parallel_for(groups, jobs, [&](std::size_t group, int worker) {
      const auto w = static_cast<std::size_t>(worker);
      GroupBatch& batch = *batches[w];
      if (!pass.compute->leaves_group_memory_zero) std::fill(memory[w].begin(), memory[w].end(), 0);
      workers_[w].tracker.start_bin(static_cast<std::uint32_t>(group));
      batch.group_x = static_cast<int>(group) % pass.groups_x;
      batch.group_y = static_cast<int>(group) / pass.groups_x;
      batch.width = pass.compute->group_width;
      batch.height = pass.compute->group_height;
      batch.image_width = pass.width;
      batch.image_height = pass.height;
      batch.resources = &workers_[w].resources;
      batch.group_memory = memory[w].data();
      batch.program = pass.compute;
      batch.counters = &workers_[w].chunks[group * bands / groups];
      const auto invocations = static_cast<std::uint64_t>(batch.width * batch.height);
      batch.counters->stats.compute_shader_invocations += invocations;
      // Waves are counted once a phase of the group; an invocation has its registers once.
      const std::uint64_t registers_before = batch.counters->shader.register_lanes;
      pass.compute->run(batch, pass.uniforms.get());
      batch.counters->shader.register_lanes = registers_before + pass.compute->ops[0].registers * invocations;
    });
    finish_workers(pass, work);
  }

  void run_transfer(const Pass& pass, PassWork& work) {
    std::vector<GpuImage*> targets;
    for (const ImageId id : pass.targets) targets.push_back(&whole_image(id));
    GpuImage* source = pass.source ? &whole_image(pass.source) : nullptr;
    if (source != nullptr && pass.kind == PassKind::copy) source->use_all(options_.jobs);
    for (GpuImage* target : targets) {
      if (pass.kind == PassKind::clear) memory_.count_untouched(*target);
      if (pass.kind == PassKind::clear) clear_image(*target, pass);
      if (pass.kind == PassKind::clear && !options_.skip.cleared_tiles) target->start_all(options_.jobs);
      if (pass.kind == PassKind::copy) copy_image(*source, *target);
      if (pass.kind == PassKind::resolve)
        skipped_pixels_ += resolve_image(*source, *target, options_.skip.single_color_pixels, options_.jobs);
    }
    if (source != nullptr) work.raster_samples = source->samples;
    work.chunks = count_transfer(pass, source, targets);
    count_commands(graph_, pass, PassContext{}, work.barrier_before, work.chunks);
  }

  Image read_output() {
    GpuImage& from = whole_image(graph_.output());
    from.use_all(options_.jobs);
    return to_linear_image(from, graph_.output_view(), options_.jobs);
  }

  const FrameGraph& graph_;
  const CompiledGraph& compiled_;
  const FunctionalConfig& functional_;
  const EmulationOptions& options_;
  TextureStore textures_;
  MaterialViews materials_;
  FrameMemory memory_;
  SharedPasses shared_;
  SkipCounts reused_skips_;
  DepthPlaneView planes_;                           ///< what the pass at hand reads
  std::vector<SamplePosition> coverage_positions_;  ///< likewise
  std::vector<BinWorker> workers_;
  Segment segment_;
  VertexFetches fetches_;
  ShadingHeat heat_;
  std::uint64_t skipped_clusters_ = 0;
  std::uint64_t skipped_pixels_ = 0;
};

}  // namespace

Emulation emulate(const FrameGraph& graph, const GpuFeatures& features, const FunctionalConfig& functional,
                  const EmulationOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const CompiledGraph compiled = compile(graph, features, functional);
  Emulation result;
  result.trace.scene = graph.scene().name;
  result.trace.width_px = graph.width();
  result.trace.height_px = graph.height();
  result.trace.peak_memory_bytes = compiled.peak_bytes;
  result.trace.allocated_memory_bytes = compiled.allocated_bytes;
  FrameRunner(graph, compiled, functional, options).run(result);
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace hwsim::pipeline
