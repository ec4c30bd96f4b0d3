// What goes into a stage comes out of it, for every pass of every technique on every generated scene.
#include <gtest/gtest.h>

#include <cmath>

#include "algos/frame_run.h"

namespace hwsim::test {
namespace {
using pipeline::FrameGraph;
using pipeline::Pass;

class Conservation : public ::testing::TestWithParam<std::string> {};

std::uint64_t product(int a, int b, int c = 1) {
  return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b) * static_cast<std::uint64_t>(c);
}

void check_draw(const FrameGraph& graph, const Pass& pass, const PassCounters& n) {
  std::uint64_t triangles = 0, draws = 0;
  for (const pipeline::DrawBatch& batch : pass.batches) {
    for (const pipeline::DrawCall& call : batch.draws) {
      const auto mesh =
          static_cast<std::size_t>(graph.scene().instances[static_cast<std::size_t>(call.instance)].mesh);
      triangles +=
          (call.list ? call.list->indices.size()
                     : graph.scene().meshes[mesh].parts[static_cast<std::size_t>(call.part)].index_count) /
          3;
    }
    draws += batch.draws.size();
  }
  EXPECT_EQ(n.fe.draws, draws);
  EXPECT_EQ(n.stats.input_assembly_primitives, triangles);
  EXPECT_EQ(n.stats.input_assembly_vertices, 3 * triangles);
  EXPECT_LE(n.stats.vertex_shader_invocations, 3 * triangles);
  EXPECT_GT(n.stats.vertex_shader_invocations, 0u);
  if (!pass.depth) return;
  EXPECT_EQ(n.hiz.tested_tiles, n.raster.visited_tiles);  // such draws of these techniques test depth
  const std::uint64_t early = n.zrop.early_z_tested_samples - n.zrop.early_z_killed_samples,
                      late = n.zrop.late_z_tested_samples - n.zrop.late_z_killed_samples;
  bool alpha = false;  // its samples are tested twice
  for (const pipeline::DrawBatch& batch : pass.batches)
    alpha = alpha || batch.state.coverage.alpha_to_coverage;
  if (alpha) {
    EXPECT_LE(n.stats.samples_passed, early + late);
  } else {
    EXPECT_EQ(n.stats.samples_passed, early + late);
  }
}

void check_full_screen(const Pass& pass, const PassCounters& n) {
  EXPECT_EQ(n.raster.covered_samples, product(pass.width, pass.height, pass.samples));
  if (!pass.state.stencil.test && !pass.state.depth.test) {
    EXPECT_EQ(n.raster.fragments, product(pass.width, pass.height));
    EXPECT_EQ(n.stats.samples_passed, n.raster.covered_samples);
  }
}

void check_pass(const FrameGraph& graph, const Pass& pass, const PassWork& work) {
  const PassCounters n = total(work);
  for (const CounterViolation& v : algos::broken_laws(n))
    ADD_FAILURE() << v.law << ": " << v.left << ", " << v.right;
  if (n.ps.sample_rate_invocations == 0 && n.ps.invocations > 0) {
    EXPECT_EQ(n.ps.invocations, n.raster.fragments);
  }
  switch (pass.kind) {
    case PassKind::draw:
      check_draw(graph, pass, n);
      break;
    case PassKind::full_screen:
      check_full_screen(pass, n);
      break;
    case PassKind::compute:
      EXPECT_EQ(n.stats.compute_shader_invocations,
                product(pass.groups_x, pass.groups_y) *
                    product(pass.compute->group_width, pass.compute->group_height));
      break;
    case PassKind::clear: {
      std::uint64_t tiles = 0;
      for (const pipeline::ImageId id : pass.targets)
        tiles += product((graph.image(id).width + 7) / 8, (graph.image(id).height + 7) / 8,
                         graph.image(id).samples * graph.image(id).layers);
      EXPECT_EQ(n.fe.cleared_tiles, tiles);
      break;
    }
    default:
      EXPECT_EQ(n.resolve.written_pixels, product(pass.width, pass.height));
      EXPECT_EQ(n.resolve.read_samples, product(pass.width, pass.height, graph.image(pass.source).samples));
      break;
  }
}

// The heat image holds the invocations of passes that have the frame's size or a multiple of it.
void check_heat(const FrameGraph& graph, const pipeline::CompiledGraph& compiled,
                const pipeline::Emulation& e) {
  double heat = 0.0;
  for (const glm::vec4& pixel : e.shading_heat.pixels) heat += pixel.x;
  std::uint64_t invocations = 0;
  for (std::size_t i = 0; i < compiled.order.size(); ++i) {
    const Pass& pass = graph.passes()[static_cast<std::size_t>(compiled.order[i])];
    if (pass.width % graph.width() == 0) invocations += total(e.trace.passes[i]).ps.invocations;
  }
  EXPECT_EQ(heat, static_cast<double>(invocations));
}

TEST_P(Conservation, HoldsInEveryPassOnEveryGeneratedScene) {
  for (const pipeline::GeneratorInfo& generator : pipeline::generators()) {
    const FrameSetup setup{GetParam(), generator.name, 160, 90};
    SCOPED_TRACE(generator.name);
    const FrameGraph graph = build_graph(setup);
    const pipeline::CompiledGraph compiled = pipeline::compile(graph, test_features(), FunctionalConfig{});
    pipeline::EmulationOptions options;
    options.jobs = 2;
    const pipeline::Emulation e = pipeline::emulate(graph, test_features(), FunctionalConfig{}, options);
    ASSERT_EQ(e.trace.passes.size(), compiled.order.size());
    for (std::size_t i = 0; i < compiled.order.size(); ++i) {
      SCOPED_TRACE(e.trace.passes[i].name);
      check_pass(graph, graph.passes()[static_cast<std::size_t>(compiled.order[i])], e.trace.passes[i]);
    }
    check_heat(graph, compiled, e);
    EXPECT_EQ(e.trace.peak_memory_bytes, compiled.peak_bytes);
    bool finite = true, drawn = false;
    for (const glm::vec4& p : e.color.pixels) {
      finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(p.w);
      drawn = drawn || p != e.color.pixels.front();
    }
    EXPECT_TRUE(finite);
    EXPECT_TRUE(drawn);
  }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Conservation, ::testing::ValuesIn(technique_variants()),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace hwsim::test
