#pragma once
// A technique as data: passes that declare what they read and write. From it follow the passes that are
// needed, the lifetimes and so the memory footprint, the barriers and the command stream. Building a graph
// runs nothing.
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hwsim/config/gpu_features.h"
#include "hwsim/format.h"
#include "hwsim/work_trace.h"
#include "pipeline/graph/pipeline_state.h"
#include "pipeline/scene/scene.h"
#include "pipeline/shade/program.h"

namespace hwsim::pipeline {

struct ImageId {
  int index = -1;
  explicit operator bool() const { return index >= 0; }
  friend bool operator==(ImageId, ImageId) = default;
};
struct BufferId {
  int index = -1;
  explicit operator bool() const { return index >= 0; }
  friend bool operator==(BufferId, BufferId) = default;
};

struct ImageDesc {
  std::string name;
  Format format = Format::none;
  int width = 0;
  int height = 0;
  int samples = 1;
};
struct BufferDesc {
  std::string name;
  std::uint64_t words = 0;  ///< 32-bit words
  /// Scene data that is there before the frame, as meshes and textures are: it is none of the frame's memory.
  std::shared_ptr<const std::vector<std::uint32_t>> contents = nullptr;
};

/// Bytes as allocated: width * height * samples * bytes per element. No padding: the papers' figures have
/// none.
std::uint64_t allocated_bytes(const ImageDesc& image);
std::uint64_t allocated_bytes(const BufferDesc& buffer);

/// Triangles of a mesh part chosen when the graph is built, three indices into the mesh's vertices each.
struct IndexList {
  std::vector<std::uint32_t> indices;
  std::uint32_t first_vertex = 0, vertex_count = 0;  ///< the range that they use
  std::uint64_t bytes() const { return 4 * indices.size(); }
};
std::shared_ptr<const IndexList> make_index_list(std::vector<std::uint32_t> indices);

/// One draw call: an instance's mesh part, or a list of its triangles.
struct DrawCall {
  int instance = 0;
  int part = 0;
  std::shared_ptr<const IndexList> list = nullptr;
};

/// Draws that share state and programs.
struct DrawBatch {
  PipelineState state;
  const VertexProgram* vertex = nullptr;
  const GeometryProgram* geometry = nullptr;  ///< optional
  const FragmentProgram* fragment = nullptr;  ///< none: depth only
  std::shared_ptr<const void> vertex_uniforms;
  std::shared_ptr<const void> geometry_uniforms;
  std::shared_ptr<const void> fragment_uniforms;
  std::vector<DrawCall> draws;

  /// What the rasterizer interpolates.
  int raster_scalars() const {
    return geometry != nullptr ? geometry->varying_scalars : vertex->varying_scalars;
  }
};

enum class ResolveMode { average, max };

struct Pass {
  std::string name;
  PassKind kind = PassKind::draw;
  int width = 0, height = 0;  ///< viewport in pixels
  int samples = 1;            ///< raster samples

  std::vector<ImageId> color;  ///< attachments of draw and full-screen passes
  ImageId depth;
  bool depth_read_only = false;
  std::vector<ImageId> sampled;       ///< images that shaders read, in the order of their slots
  std::vector<BufferId> storage;      ///< buffers that shaders read or write, in the order of their slots
  std::uint64_t storage_written = 0;  ///< bit i: storage[i] is written

  std::vector<DrawBatch> batches;  // draw
  PipelineState state;             // full_screen
  const FragmentProgram* fragment = nullptr;
  const ComputeProgram* compute = nullptr;
  int groups_x = 0, groups_y = 0;        // compute
  std::shared_ptr<const void> uniforms;  // full_screen and compute

  std::vector<ImageId> targets;                ///< clear: images; copy and resolve: the destination
  ImageId source;                              ///< copy and resolve
  ResolveMode resolve = ResolveMode::average;  ///< depth: max
  glm::vec4 clear_color{0.0f};
  float clear_depth = 1.0f;
  std::uint8_t clear_stencil = 0;
  bool keep = false;  ///< never culled: a simulated workload without output
};

class FrameGraph {
 public:
  FrameGraph(std::shared_ptr<const Scene> scene, int width, int height)
      : scene_(std::move(scene)), width_(width), height_(height) {}

  ImageId add_image(ImageDesc desc);
  BufferId add_buffer(BufferDesc desc);
  Pass& add_pass(std::string name, PassKind kind);
  Pass& add_clear(std::string name, std::vector<ImageId> targets, glm::vec4 color = glm::vec4(0.0f));
  Pass& add_resolve(std::string name, ImageId source, ImageId target);
  void set_output(ImageId image) { output_ = image; }

  const Scene& scene() const { return *scene_; }
  std::shared_ptr<const Scene> shared_scene() const { return scene_; }
  int width() const { return width_; }
  int height() const { return height_; }
  ImageId output() const { return output_; }
  const ImageDesc& image(ImageId id) const { return images_.at(static_cast<std::size_t>(id.index)); }
  const BufferDesc& buffer(BufferId id) const { return buffers_.at(static_cast<std::size_t>(id.index)); }
  std::span<const ImageDesc> images() const { return images_; }
  std::span<const BufferDesc> buffers() const { return buffers_; }
  std::span<const Pass> passes() const { return passes_; }

 private:
  std::shared_ptr<const Scene> scene_;
  int width_, height_;
  ImageId output_;
  std::vector<ImageDesc> images_;
  std::vector<BufferDesc> buffers_;
  std::vector<Pass> passes_;
};

/// What follows from a graph.
struct CompiledGraph {
  struct Lifetime {
    int first_pass = -1, last_pass = -1;  ///< indices into `order`; -1: never used
  };
  std::vector<int> order;   ///< passes that run, in order of submission (indices into FrameGraph::passes)
  std::vector<int> culled;  ///< passes whose results nobody reads
  std::vector<char> barrier_before;  ///< one for each of `order`: it reads or overwrites what a pass since
                                     ///< the last barrier wrote
  std::vector<Lifetime> images, buffers;
  std::uint64_t peak_bytes = 0;       ///< the largest sum of live images and buffers
  std::uint64_t allocated_bytes = 0;  ///< sum over all that are used, without reuse of memory
};

/// Throws InputError with every violation found (codes G0xx), as a driver's debug layer reports them: format
/// and sample-count mismatches, feedback loops, images read before anything wrote them, multisampled images
/// presented or filtered without a resolve, features that this GPU lacks.
CompiledGraph compile(const FrameGraph& graph, const GpuFeatures& features,
                      const FunctionalConfig& functional);

}  // namespace hwsim::pipeline
