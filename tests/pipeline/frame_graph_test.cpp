// What follows from a graph: needed passes, lifetimes, memory, barriers; and every code of the validator,
// provoked.
#include <gtest/gtest.h>

#include "pipeline/graph/validate.h"
#include "support/frames.h"

namespace hwsim::pipeline {
namespace {

constexpr double kMiB = 1024.0 * 1024.0;

std::shared_ptr<const Scene> one_triangle() {
  return test::share(test::clip_space_scene({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {0, 1, 2}));
}

Pass& add_full_screen(FrameGraph& graph, const std::string& name, std::vector<ImageId> reads,
                      ImageId target) {
  Pass& pass = graph.add_pass(name, PassKind::full_screen);
  pass.width = graph.image(target).width;
  pass.height = graph.image(target).height;
  pass.samples = graph.image(target).samples;
  pass.sampled = std::move(reads);
  pass.color = {target};
  pass.fragment = &test::constant_program();
  pass.uniforms = std::make_shared<glm::vec4>(1.0f);
  return pass;
}

std::vector<std::string> names(const FrameGraph& graph, const std::vector<int>& passes) {
  std::vector<std::string> all;
  for (const int i : passes) all.push_back(graph.passes()[static_cast<std::size_t>(i)].name);
  return all;
}

TEST(FrameGraph, LeavesOutWhatNobodyReads) {
  FrameGraph graph(one_triangle(), 16, 16);
  const ImageId a = graph.add_image({"a", Format::rgba8_unorm, 16, 16, 1});
  const ImageId b = graph.add_image({"b", Format::rgba8_unorm, 16, 16, 1});
  const ImageId unread = graph.add_image({"unread", Format::rgba8_unorm, 16, 16, 1});
  const ImageId out = graph.add_image({"out", Format::rgba8_unorm, 16, 16, 1});
  add_full_screen(graph, "overwritten", {}, a);
  graph.add_clear("clear", {a});
  add_full_screen(graph, "fill", {}, a);
  add_full_screen(graph, "for_unread", {a}, b);
  add_full_screen(graph, "unread", {b}, unread);
  add_full_screen(graph, "kept", {}, unread).keep = true;
  add_full_screen(graph, "show", {a}, out);
  add_full_screen(graph, "after", {out}, b);
  graph.set_output(out);
  const CompiledGraph compiled = compile(graph, {}, {});
  EXPECT_EQ(names(graph, compiled.order),
            (std::vector<std::string>{"clear", "fill", "for_unread", "unread", "kept", "show"}));
  EXPECT_EQ(names(graph, compiled.culled), (std::vector<std::string>{"overwritten", "after"}));
  EXPECT_EQ(compiled.barrier_before, (std::vector<char>{0, 0, 1, 1, 0, 0}));
}

TEST(FrameGraph, KeepsImagesFromTheirFirstUseToTheirLast) {
  FrameGraph graph(one_triangle(), 64, 32);
  std::vector<ImageId> chain;
  for (int i = 0; i < 6; ++i)
    chain.push_back(graph.add_image({"image" + std::to_string(i), Format::rgba16_float, 64, 32, 1}));
  add_full_screen(graph, "0", {}, chain[0]);
  for (std::size_t i = 1; i < chain.size(); ++i)
    add_full_screen(graph, std::to_string(i), {chain[i - 1]}, chain[i]);
  graph.set_output(chain.back());
  const CompiledGraph compiled = compile(graph, {}, {});
  const std::uint64_t image = 64 * 32 * 8;
  EXPECT_EQ(compiled.allocated_bytes, 6 * image);
  EXPECT_EQ(compiled.peak_bytes, 2 * image);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(compiled.images[static_cast<std::size_t>(i)].first_pass, i);
    EXPECT_EQ(compiled.images[static_cast<std::size_t>(i)].last_pass, std::min(i + 1, 5));
  }
}

TEST(FrameGraph, SaysWhatTileMemoryLoadsAndKeeps) {
  FrameGraph graph(one_triangle(), 16, 16);
  const ImageId color = graph.add_image({"color", Format::rgba8_unorm, 16, 16, 4});
  const ImageId depth = graph.add_image({"depth", Format::d24_unorm_s8, 16, 16, 4});
  const ImageId resolved = graph.add_image({"resolved", Format::rgba8_unorm, 16, 16, 1});
  const ImageId out = graph.add_image({"out", Format::rgba8_unorm, 16, 16, 1});
  graph.add_clear("clear", {color, depth});
  const auto draw = [&](const char* name) -> Pass& {
    Pass& pass = graph.add_pass(name, PassKind::draw);
    pass.samples = 4;
    pass.color = {color};
    pass.depth = depth;
    return pass;
  };
  draw("first");
  draw("second").depth_read_only = true;
  graph.add_resolve("resolve", color, resolved);
  add_full_screen(graph, "show", {resolved}, out);
  graph.set_output(out);
  const CompiledGraph compiled = compile(graph, {}, {});
  ASSERT_EQ(compiled.order.size(), 5u);
  const auto use = [&](int position, ImageId image) {
    const AttachmentUse u = attachment_use(graph, compiled, position, image);
    return std::pair(u.loaded, u.kept);
  };
  EXPECT_EQ(use(1, color), std::pair(false, true));  // cleared before; the second pass goes on with it
  EXPECT_EQ(use(1, depth), std::pair(false, true));
  EXPECT_EQ(use(2, color), std::pair(true, false));  // resolved from tile memory, then nobody needs it
  EXPECT_EQ(use(2, depth), std::pair(true, false));
  EXPECT_EQ(use(3, resolved), std::pair(false, true));
  EXPECT_EQ(use(4, out), std::pair(false, true));  // the display
  EXPECT_TRUE(resolves_from_tile(graph, compiled, 3));
  EXPECT_FALSE(resolves_from_tile(graph, compiled, 4));
}

// The multisampled images of docs/techniques/forward.md#multisampling at 1280x720.
TEST(FrameGraph, SumsTheMemoryOfMultisampling) {
  for (const int samples : {2, 4, 8}) {
    FrameGraph graph(one_triangle(), 1280, 720);
    const ImageId color = graph.add_image({"color", Format::rgba8_srgb, 1280, 720, samples});
    const ImageId depth = graph.add_image({"depth", Format::d24_unorm_s8, 1280, 720, samples});
    const ImageId out = graph.add_image({"out", Format::rgba8_srgb, 1280, 720, 1});
    graph.add_clear("clear", {color, depth});
    Pass& pass = graph.add_pass("draw", PassKind::draw);
    pass.samples = samples;
    pass.color = {color};
    pass.depth = depth;
    graph.add_resolve("resolve", color, out);
    graph.set_output(out);
    const CompiledGraph compiled = compile(graph, {}, {});
    EXPECT_DOUBLE_EQ(static_cast<double>(compiled.allocated_bytes) / kMiB, 56.25 * samples / 8 + 3.515625);
    EXPECT_DOUBLE_EQ(static_cast<double>(compiled.peak_bytes) / kMiB, 56.25 * samples / 8);
  }
}

/// A small valid graph, to be spoiled.
struct Draft {
  Draft() : graph(one_triangle(), 16, 16) {
    color = graph.add_image({"color", Format::rgba8_unorm, 16, 16, 1});
    depth = graph.add_image({"depth", Format::d24_unorm_s8, 16, 16, 1});
    integer = graph.add_image({"integer", Format::r32_uint, 16, 16, 1});
    multi = graph.add_image({"multi", Format::rgba8_unorm, 16, 16, 4});
    small = graph.add_image({"small", Format::rgba8_unorm, 8, 8, 1});
    unwritten = graph.add_image({"unwritten", Format::rgba8_unorm, 16, 16, 1});
    graph.add_clear("clear", {color, depth, integer, multi, small});
    graph.set_output(color);
  }
  Pass& draw() {
    Pass& pass = graph.add_pass("draw", PassKind::draw);
    pass.color = {color};
    pass.depth = depth;
    DrawBatch batch;
    batch.vertex = &mesh_position_program();
    batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>();
    batch.fragment = &test::constant_program();
    batch.fragment_uniforms = std::make_shared<glm::vec4>(1.0f);
    batch.draws = {{0, 0}};
    pass.batches = {batch};
    return pass;
  }
  Pass& transfer(PassKind kind, ImageId from, ImageId to) {
    Pass& pass = graph.add_pass("transfer", kind);
    pass.source = from;
    pass.targets = {to};
    return pass;
  }
  std::string codes() const {
    std::string all;
    for (const Diagnostic& d : validate(graph, features, FunctionalConfig{}))
      all += (all.empty() ? "" : " ") + d.code;
    return all;
  }
  FrameGraph graph;
  GpuFeatures features;
  ImageId color, depth, integer, multi, small, unwritten;
};

template <class Spoil>
std::string codes_of(Spoil&& spoil) {
  Draft draft;
  spoil(draft);
  return draft.codes();
}

TEST(Validate, AcceptsAValidGraph) {
  EXPECT_EQ(codes_of([](Draft& d) { d.draw(); }), "");
  EXPECT_EQ(codes_of([](Draft& d) { d.transfer(PassKind::resolve, d.multi, d.color); }), "");
}

TEST(Validate, G001Sizes) {
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().color = {d.small}; }), "G001");
  EXPECT_EQ(codes_of([](Draft& d) {
              d.graph.add_image({"huge", Format::rgba8_unorm, 16385, 1, 1});
            }),
            "G001");
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.add_image({"empty", Format::rgba8_unorm, 0, 4, 1}); }), "G001");
  EXPECT_EQ(codes_of([](Draft& d) { d.transfer(PassKind::copy, d.small, d.color); }), "G001");
}

TEST(Validate, G002SampleCounts) {
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.add_image({"three", Format::rgba8_unorm, 4, 4, 3}); }), "G002");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().color = {d.multi}; }), "G002");
  EXPECT_EQ(codes_of([](Draft& d) {
              Pass& pass = d.draw();
              pass.samples = 4;
              pass.color = {d.multi};
            }),
            "G002");  // the depth image
  EXPECT_EQ(codes_of([](Draft& d) {
              Pass& pass = d.draw();
              pass.samples = 3;
              pass.color = {};
              pass.depth = {};
              pass.batches.front().fragment = nullptr;
            }),
            "G002");
  EXPECT_EQ(codes_of([](Draft& d) {
              d.features.programmable_sample_positions = true;
              d.draw().batches.front().state.raster.sample_positions = {{0, 0}, {1, 1}};
            }),
            "G002");
}

TEST(Validate, G003Formats) {
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().depth = d.color; }).substr(0, 4), "G003");
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.add_image({"none", Format::none, 4, 4, 1}); }), "G003");
  EXPECT_EQ(codes_of([](Draft& d) {
              Pass& pass = d.draw();
              pass.color = {d.integer};
              pass.batches.front().state.blend = {{true}};
            }),
            "G003");
}

TEST(Validate, G004FeedbackLoops) {
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().sampled = {d.color}; }), "G004");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().sampled = {d.depth}; }), "G004");
  EXPECT_EQ(codes_of([](Draft& d) {
              Pass& pass = d.draw();
              pass.sampled = {d.depth};
              pass.depth_read_only = true;
            }),
            "");
  EXPECT_EQ(codes_of([](Draft& d) {
              Pass& pass = d.draw();
              pass.depth_read_only = true;
              pass.batches.front().state.depth.write = true;
            }),
            "G004");
}

TEST(Validate, G005ReadsBeforeWrites) {
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().sampled = {d.unwritten}; }), "G005");
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.set_output(d.unwritten); }), "G005");
}

TEST(Validate, G006Features) {
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.add_image({"many", Format::rgba8_unorm, 4, 4, 16}); }), "G006");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().batches.front().state.raster.conservative = true; }), "G006");
  EXPECT_EQ(codes_of([](Draft& d) {
              d.draw().batches.front().state.raster.sample_positions = {{0, 0}};
            }),
            "G006");
}

TEST(Validate, MixedSamplesNeedTheFeatureAndADivisor) {
  const auto mixed = [](Draft& d, int raster, int color) {
    d.features.native_msaa_max = 16;
    Pass& pass = d.draw();
    pass.samples = raster;
    pass.color = {d.graph.add_image({"mixed", Format::rgba8_unorm, 16, 16, color})};
    pass.depth = d.graph.add_image({"samples", Format::d24_unorm_s8, 16, 16, raster});
  };
  EXPECT_EQ(codes_of([&](Draft& d) { mixed(d, 8, 2); }), "G006");
  const auto with_feature = [&](int raster, int color) {
    return codes_of([&](Draft& d) {
      d.features.target_independent_raster = true;
      mixed(d, raster, color);
    });
  };
  EXPECT_EQ(with_feature(8, 2), "");
  EXPECT_EQ(with_feature(16, 1), "");
  EXPECT_EQ(with_feature(2, 8), "G002");
}

TEST(Validate, MulticastNeedsTheFeatureAndLayersToWrite) {
  const auto multicast = [](bool feature, std::vector<ViewportShift> viewports, int layers) {
    return codes_of([&](Draft& d) {
      d.features.viewport_multicast = feature;
      Pass& pass = d.draw();
      pass.viewports = std::move(viewports);
      pass.color = {d.graph.add_image({"array", Format::rgba8_unorm, 16, 16, 1, layers})};
      pass.depth = {};
    });
  };
  EXPECT_EQ(multicast(true, {{0, 0}, {-128, 16}}, 2), "");
  EXPECT_EQ(multicast(false, {{0, 0}, {-128, 16}}, 2), "G006");
  EXPECT_EQ(multicast(true, {{0, 0}, {-128, 16}}, 3), "G011");
  EXPECT_EQ(multicast(true, {}, 2), "G011");
  EXPECT_EQ(multicast(true, {{0, 0}, {257, 0}}, 2), "G011");
  EXPECT_EQ(multicast(true, std::vector<ViewportShift>(17), 17), "G011");
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.add_image({"none", Format::rgba8_unorm, 4, 4, 1, 0}); }), "G001");
}

TEST(Validate, CoverageStates) {
  const auto spoil = [](bool features, auto&& change) {
    return codes_of([&](Draft& d) {
      if (features) d.features = every_feature(32);
      change(d.draw().batches.front());
    });
  };
  const auto post_depth = [](DrawBatch& b) {
    b.state.coverage.post_depth = true;
    b.state.force_early_z = true;
  };
  EXPECT_EQ(spoil(false, post_depth), "G006");
  EXPECT_EQ(spoil(true, post_depth), "");
  EXPECT_EQ(spoil(true, [](DrawBatch& b) { b.state.coverage.post_depth = true; }), "G010");
  EXPECT_EQ(spoil(true, [](DrawBatch& b) { b.state.coverage.override_output = true; }), "G010");
  FragmentProgram program = test::constant_program();
  program.writes_mask = true;
  const auto replace = [&](DrawBatch& b) {
    b.fragment = &program;
    b.state.coverage.override_output = true;
  };
  EXPECT_EQ(spoil(false, replace), "G006");
  EXPECT_EQ(spoil(true, replace), "");
  EXPECT_EQ(spoil(true,
                  [&](DrawBatch& b) {
                    replace(b);
                    b.state.raster.sample_rate = true;
                  }),
            "G010");
}

TEST(Validate, G007Programs) {
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().batches.front().vertex = nullptr; }), "G007");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().batches.front().fragment = nullptr; }), "G007");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().batches.front().vertex = &mesh_surface_program(); }), "G007");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().color = {d.color, d.integer}; }), "G007");
  EXPECT_EQ(codes_of([](Draft& d) {
              Pass& pass = d.draw();
              pass.depth = {};
              pass.batches.front().state.depth.test = true;
            }),
            "G007");
  EXPECT_EQ(codes_of([](Draft& d) { d.draw().sampled.assign(kMaxImageSlots + 1, d.integer); }), "G007");
}

TEST(Validate, G008Output) {
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.set_output({}); }), "G008");
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.set_output(d.multi); }), "G008");
  EXPECT_EQ(codes_of([](Draft& d) { d.graph.set_output(d.depth); }), "G008");
}

TEST(Validate, G009Transfers) {
  EXPECT_EQ(codes_of([](Draft& d) { d.transfer(PassKind::resolve, d.color, d.color); }), "G009");
  EXPECT_EQ(codes_of([](Draft& d) { d.transfer(PassKind::copy, d.multi, d.color); }), "G009");
  EXPECT_EQ(codes_of([](Draft& d) { d.transfer(PassKind::copy, d.color, d.color).targets = {}; }), "G009");
}

}  // namespace
}  // namespace hwsim::pipeline
