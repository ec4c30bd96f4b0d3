// Storage buffers and their atomics, and the recorded command stream.
#include <gtest/gtest.h>

#include "pipeline/graph/commands.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "support/frames.h"

// One vector target is enough here: without foreach_target.
#include "pipeline/shade/fragment_lanes-inl.h"

namespace hwsim::pipeline {
namespace {
namespace lanes = HWY_NAMESPACE;

constexpr int kSize = 96;

/// Adds 1 to word (x & 15) of buffer 0, far outside for x = 95, and shows what buffer 1 holds.
struct HistogramShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using I = typename S::I;
    using F = typename S::F;
    const I x = s.pixel_x();
    s.atomic_add(0, select(x == I(kSize - 1), I(1 << 20), x & I(15)), I(1), s.active());
    s.store_buffer(1, s.pixel_y() * I(kSize) + x, x + I(1), s.active());
    const I back = s.load_buffer(1, s.pixel_y() * I(kSize) + x, s.active());
    s.output(0, {to_float(back) * F(1.0f / 255.0f), F(0.0f), F(0.0f), F(1.0f)});
  }
};

/// Shows the histogram that an earlier pass left.
struct ShowShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using F = typename S::F;
    const auto n = s.load_buffer(0, s.pixel_x(), s.active());
    s.output(0, {to_float(n) * F(1.0f / 1024.0f), F(0.0f), F(0.0f), F(1.0f)});
  }
};

template <class Shader>
const FragmentProgram& program(const char* name) {
  static const FragmentProgram p = lanes::describe_fragment_shader<Shader>(
      name, [](FragmentBatch& b, const void* u) { lanes::run_fragment_shader<Shader>(b, u); });
  return p;
}

FrameGraph histogram_graph() {
  FrameGraph graph(test::share(test::clip_space_scene({}, {})), kSize, kSize);
  const ImageId shown = graph.add_image({"shown", Format::rgba8_unorm, kSize, kSize, 1});
  const ImageId output = graph.add_image({"output", Format::rgba32_float, kSize, kSize, 1});
  const BufferId histogram = graph.add_buffer({"histogram", 128});
  const BufferId columns = graph.add_buffer({"columns", kSize * kSize});
  Pass& count = graph.add_pass("count", PassKind::full_screen);
  count.color = {shown};
  count.storage = {histogram, columns};
  count.storage_written = 3;
  count.fragment = &program<HistogramShader>("histogram");
  count.uniforms = std::make_shared<int>(0);
  Pass& show = graph.add_pass("show", PassKind::full_screen);
  show.color = {output};
  show.storage = {histogram};
  show.fragment = &program<ShowShader>("show");
  show.uniforms = std::make_shared<int>(0);
  graph.set_output(output);
  return graph;
}

TEST(StorageBuffer, AtomicsOfAllThreadsAddUpAndIndicesOutsideAreDropped) {
  const FrameGraph graph = histogram_graph();
  for (const int jobs : {1, 3}) {
    EmulationOptions options;
    options.jobs = jobs;
    const Emulation e = emulate(graph, GpuFeatures{}, FunctionalConfig{}, options);
    for (int x = 0; x < 16; ++x)  // 6 columns of 96 pixels each, but 5 where the last column pointed outside
      EXPECT_EQ(e.color.at(x, 0).x * 1024.0f, x == 15 ? 5.0f * kSize : 6.0f * kSize) << x << " with " << jobs;
    const PassCounters n = total(e.trace.passes[0]);
    constexpr std::uint64_t kPixels = kSize * kSize;
    EXPECT_EQ(n.mem.storage_write_bytes, 2 * 4 * kPixels);  // one atomic and one store
    EXPECT_EQ(n.mem.storage_read_bytes, 2 * 4 * kPixels);   // one atomic and one load
    EXPECT_EQ(n.shader.atomic_lane_ops, kPixels);
    EXPECT_EQ(n.shader.same_address_atomic_lane_ops, 6u * kSize);  // each of 15 words; the last got fewer
  }
}

TEST(StorageBuffer, CountingFindsThatAShaderWrites) {
  EXPECT_TRUE(program<HistogramShader>("histogram").writes_storage);
  EXPECT_FALSE(program<ShowShader>("show").writes_storage);
}

TEST(Commands, BindsAreSentOnlyForChanges) {
  Scene scene = test::clip_space_scene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0, 1, 2, 0, 1, 2});
  scene.materials.emplace_back();
  scene.meshes[0].parts = {{0, 3, 0}, {3, 3, 0}, {6, 3, 1}};
  FrameGraph graph(test::share(std::move(scene)), 64, 64);
  Pass& pass = graph.add_pass("draw", PassKind::draw);
  pass.batches.resize(1);
  pass.batches[0].draws = {{0, 0}, {0, 1}, {0, 2}};
  std::vector<CommandKind> kinds;
  for (const Command& c : record_pass(graph, pass, true)) kinds.push_back(c.kind);
  using enum CommandKind;
  EXPECT_EQ(kinds, (std::vector<CommandKind>{barrier, bind_targets, bind_pipeline, bind_resources, draw, draw,
                                             bind_resources, draw}));
}

}  // namespace
}  // namespace hwsim::pipeline
