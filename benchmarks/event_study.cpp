// Shading events pixel by pixel: those of AGAA, SBAA and the simple/complex reference, over the whole frame,
// in the pixels that the reference calls complex, and as waves execute them: JSON on standard output, for
// scripts/counts.py.
//
//   event_study [--size=1280x720] [--jobs=2] scene
//
// A pixel without any surface counts one event everywhere, as the counter lit_samples has it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "algos/techniques.h"
#include "hwsim/gpu/every_feature.h"
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/memory/gpu_image.h"
#include "study_input.h"

namespace hwsim::benchmarks {
namespace {
using pipeline::FragmentBatch;
using pipeline::FrameGraph;

constexpr int kSamples = 8;
/// Configured to lose nothing (AGAA, section 5; docs/techniques/deferred.md#simple-and-complex). Attributes
/// at pixel centers, as for the published times (configs/published/mapping/techniques.csv).
constexpr const char* kReference =
    "deferred_simple_complex:samples=8,z_scale=0,normal_dot_min=1,centroid=off";
constexpr const char* kAggregates = "agaa:c=2,msaa=8";
constexpr const char* kTop = "sbaa_top:n=6,msaa=8";
constexpr const char* kMerge = "sbaa_merge:n=6,msaa=8";

struct Study {
  int width_px = 1280, height_px = 720, jobs = 2;
  std::string scene;
};

/// Events of each pixel, row by row.
using Events = std::vector<int>;

/// body(lane, x, y) gives red of every pixel of a batch.
template <class Body>
void for_each_pixel(FragmentBatch& batch, const Body& body) {
  for (std::size_t lane = 0; lane < pipeline::kBlockLanes; ++lane) {
    for (auto& channel : batch.color[0]) channel[lane] = 0.0f;
    batch.color[0][0][lane] = body(batch.pixel_x[lane], batch.pixel_y[lane]);
  }
}

/// Whether the reference's first pass marked the pixel: image 0 is depth with stencil.
void read_stencil(FragmentBatch& batch, const void*) {
  const pipeline::GpuImage& image = *batch.resources->images[0];
  for_each_pixel(batch, [&](int x, int y) {
    if (x >= image.width || y >= image.height) return 0.0f;
    const auto block = static_cast<std::size_t>(image.block_index(x, y));
    if (image.cleared[block] != 0) return 1.0f;
    const std::size_t samples = static_cast<std::size_t>(image.samples) * pipeline::kBlockLanes;
    const auto lane = static_cast<std::size_t>(pipeline::lane_of(x & 7, y & 7));
    return image.stencil[block * samples + lane] != 0 ? static_cast<float>(kSamples) : 1.0f;
  });
}

/// Aggregates with any sample: image 0 is the target that holds their masks in alpha.
void read_masks(FragmentBatch& batch, const void*) {
  const pipeline::GpuImage& image = *batch.resources->images[0];
  for_each_pixel(batch, [&](int x, int y) {
    float events = 0.0f;
    if (x >= image.width || y >= image.height) return events;
    for (int aggregate = 0; aggregate < image.samples; ++aggregate) {
      float texel[4];
      pipeline::read_texel(image, x, y, aggregate, texel);
      events += texel[3] > 0.0f ? 1.0f : 0.0f;
    }
    return std::max(events, 1.0f);
  });
}

/// Records that were written: buffer 0, [pixel][slot], whose first words are never 0. Uniforms: the study and
/// the slots of a pixel.
struct RecordUniforms {
  int width_px = 0, height_px = 0, slots = 0;
};
void read_records(FragmentBatch& batch, const void* uniforms) {
  const auto& u = *static_cast<const RecordUniforms*>(uniforms);
  const std::uint32_t* words = batch.resources->buffers[0];
  const auto slots = static_cast<std::size_t>(u.width_px) * static_cast<std::size_t>(u.height_px) *
                     static_cast<std::size_t>(u.slots);
  const std::size_t record = batch.resources->buffer_words[0] / slots;
  for_each_pixel(batch, [&](int x, int y) {
    float events = 0.0f;
    if (x >= u.width_px || y >= u.height_px) return events;
    const auto first = static_cast<std::size_t>(y * u.width_px + x) * static_cast<std::size_t>(u.slots);
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(u.slots); ++slot)
      events += words[(first + slot) * record] != 0 ? 1.0f : 0.0f;
    return std::max(events, 1.0f);
  });
}

/// A technique's frame, and a pass after it that shows the events instead of the picture.
struct Probe {
  algos::FrameRequest request;
  FrameGraph graph;

  Probe(const std::string& technique, const algos::FrameRequest& asked)
      : request(asked), graph(algos::build_frame(algos::parse_technique(technique), request)) {}

  pipeline::ImageId image_named(std::string_view name) const {
    for (std::size_t i = 0; i < graph.images().size(); ++i)
      if (graph.images()[i].name == name) return {static_cast<int>(i)};
    std::fprintf(stderr, "no image %s\n", std::string(name).c_str());
    std::exit(1);
  }

  /// `pass` reads what it is given; the frame itself stays alive as its last input.
  Events run(void (*shader)(FragmentBatch&, const void*), std::vector<pipeline::ImageId> images,
             std::vector<pipeline::BufferId> buffers, pipeline::Uniforms uniforms, int jobs) {
    pipeline::FragmentProgram program;
    program.name = "events";
    program.run = shader;
    images.push_back(graph.output());
    const auto shown = graph.add_image({"events", Format::rgba32_float, graph.width(), graph.height(), 1});
    pipeline::Pass& pass = graph.add_pass("events", PassKind::full_screen);
    pass.sampled = std::move(images);
    pass.storage = std::move(buffers);
    pass.color = {shown};
    pass.fragment = &program;
    pass.uniforms = std::move(uniforms);
    graph.set_output(shown);
    pipeline::EmulationOptions options;
    options.jobs = jobs;
    const pipeline::Emulation done = pipeline::emulate(graph, request.features, FunctionalConfig{}, options);
    Events events;
    events.reserve(done.color.pixels.size());
    for (const glm::vec4& pixel : done.color.pixels) events.push_back(static_cast<int>(pixel.x));
    check_sum(events, done.trace);
    return events;
  }

  /// The pixels' events are the frame's counter.
  void check_sum(const Events& events, const WorkTrace& trace) const {
    std::uint64_t pixels = 0, counted = 0;
    for (const int e : events) pixels += static_cast<std::uint64_t>(e);
    for (const PassWork& pass : trace.passes)
      for (const auto& chunk : pass.chunks) counted += chunk.technique[algos::BaseCounters::lit_samples];
    if (pixels == counted) return;
    std::fprintf(stderr, "%llu events in pixels, %llu counted\n", static_cast<unsigned long long>(pixels),
                 static_cast<unsigned long long>(counted));
    std::exit(1);
  }
};

Events events_of(const std::string& technique, const algos::FrameRequest& request, const Study& study) {
  Probe probe(technique, request);
  if (technique == kReference)
    return probe.run(read_stencil, {probe.image_named("depth")}, {}, std::make_shared<int>(0), study.jobs);
  if (technique == kAggregates)
    return probe.run(read_masks, {probe.image_named("aggregate_chroma")}, {}, std::make_shared<int>(0),
                     study.jobs);
  const auto uniforms = std::make_shared<RecordUniforms>(RecordUniforms{study.width_px, study.height_px, 6});
  return probe.run(read_records, {}, {pipeline::BufferId{0}}, uniforms, study.jobs);
}

/// Means over pixels: of the whole frame, of complex pixels; and of the worst pixel of each wave of 8x4
/// pixels, over all waves and over those that hold a complex pixel.
struct Means {
  double frame = 0.0, complex = 0.0, waves = 0.0, complex_waves = 0.0;
};

Means means(const Events& events, const Events& reference, const Study& study, double* complex_share,
            double* complex_wave_share) {
  double frame = 0, complex = 0, pixels = 0, waves = 0, all_worst = 0, complex_waves = 0, complex_worst = 0;
  for (int y0 = 0; y0 < study.height_px; y0 += 4) {
    for (int x0 = 0; x0 < study.width_px; x0 += 8) {
      int worst = 0;
      bool any_complex = false;
      for (int y = y0; y < std::min(y0 + 4, study.height_px); ++y) {
        for (int x = x0; x < std::min(x0 + 8, study.width_px); ++x) {
          const auto i = static_cast<std::size_t>(y * study.width_px + x);
          worst = std::max(worst, events[i]);
          frame += events[i];
          if (reference[i] < kSamples) continue;
          any_complex = true;
          complex += events[i];
          pixels += 1;
        }
      }
      waves += 1;
      all_worst += worst;
      complex_waves += any_complex ? 1 : 0;
      complex_worst += any_complex ? worst : 0;
    }
  }
  const double all = static_cast<double>(events.size());
  *complex_share = pixels / all;
  *complex_wave_share = complex_waves / waves;
  return {frame / all, complex / std::max(pixels, 1.0), all_worst / waves,
          complex_worst / std::max(complex_waves, 1.0)};
}

void print_events(const Study& study) {
  algos::FrameRequest request =
      open_study({.scene = study.scene, .resolution = {study.width_px, study.height_px}, .shadows = false});
  request.features = every_feature(8);
  const std::vector<std::pair<const char*, const char*>> techniques = {
      {"reference", kReference}, {"agaa", kAggregates}, {"top", kTop}, {"merge", kMerge}};
  Events reference;
  double share = 0.0, wave_share = 0.0;
  std::printf("{");
  for (const auto& [name, technique] : techniques) {
    const Events events = events_of(technique, request, study);
    if (reference.empty()) reference = events;
    const Means m = means(events, reference, study, &share, &wave_share);
    std::printf(R"("%s": {"frame": %.6f, "complex": %.6f, "waves": %.6f, "complex_waves": %.6f}, )", name,
                m.frame, m.complex, m.waves, m.complex_waves);
  }
  std::printf("\"complex_share\": %.6f, \"complex_wave_share\": %.6f}\n", share, wave_share);
}

/// False where an argument is not understood.
bool parse(const std::string& argument, Study& study) {
  if (argument.starts_with("--jobs=")) return (study.jobs = std::atoi(argument.c_str() + 7)) > 0;
  if (argument.starts_with("--size="))
    return std::sscanf(argument.c_str() + 7, "%dx%d", &study.width_px, &study.height_px) == 2;
  study.scene = argument;
  return !argument.starts_with("-");
}

}  // namespace
}  // namespace hwsim::benchmarks

int main(int argc, char** argv) {
  using namespace hwsim;
  using namespace hwsim::benchmarks;
  Study study;
  bool understood = argc > 1;
  for (int i = 1; i < argc; ++i) understood = understood && parse(argv[i], study);
  if (!understood) {
    std::fprintf(stderr, "usage: event_study [--size=WIDTHxHEIGHT] [--jobs=N] SCENE\n");
    return 2;
  }
  try {
    print_events(study);
  } catch (const InputError& error) {
    return report(error);
  }
  return 0;
}
