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

#include "hwsim/gpu/gpu_features.h"
#include "hwsim/trace/format.h"
#include "hwsim/trace/work_trace.h"
#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"
#include "pipeline/image/image_io.h"
#include "pipeline/scene/scene.h"
#include "pipeline/state/pipeline_state.h"

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
  int layers =
      1;  ///< more than 1: an array image; shaders read sample s of layer l as sample l * samples + s
  /// Color: positions of a pixel that name one of its samples as theirs, in a map beside the texels (CSAA,
  /// EQAA; docs/techniques/forward.md#coverage-sampling). More than `samples`; 0: no map.
  int coverage_samples = 0;
};
struct BufferDesc {
  std::string name;
  std::uint64_t words = 0;  ///< 32-bit words
  /// Scene data that is there before the frame, as meshes and textures are: it is none of the frame's memory.
  std::shared_ptr<const std::vector<std::uint32_t>> contents = nullptr;
};

/// Formats of the same bits, between which views and copies are free: the sRGB codes of an image as they are,
/// or decoded.
bool same_bits(Format a, Format b);

/// Bytes as allocated: width * height * samples * layers * bytes per element. No padding: the papers' figures
/// have none.
std::uint64_t allocated_bytes(const ImageDesc& image);
/// Size of a pixel's coverage map: for each position the number of a sample, or none. 0 without a map.
std::uint64_t coverage_map_bytes(int samples, int coverage_samples);
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
  Uniforms vertex_uniforms;
  Uniforms geometry_uniforms;
  Uniforms fragment_uniforms;
  std::vector<DrawCall> draws;
  /// The geometry program's points come from a tessellator (GpuFeatures::tessellator_points): none of them
  /// passes through a buffer, nor is their number limited.
  bool tessellated_points = false;

  /// What the rasterizer interpolates.
  int raster_scalars() const {
    return geometry != nullptr ? geometry->varying_scalars : vertex->varying_scalars;
  }
};

enum class ResolveMode { average, max };
class FrameGraph;

struct Pass {
  std::string name;
  PassKind kind = PassKind::draw;
  int width = 0, height = 0;  ///< viewport in pixels
  int samples = 1;            ///< raster samples
  int coverage_samples = 0;   ///< positions at which coverage is found, the first `samples` of which have
                              ///< depth and color (ImageDesc::coverage_samples); 0: `samples`
  bool drop_orphans = false;  ///< see memory/coverage_map.h
  /// Viewport multicast (docs/techniques/forward.md#multicast): vertices are shaded once, and every primitive
  /// is rasterized into layer l of the attachments under viewport l. Empty: one viewport, and attachments of
  /// one layer.
  std::vector<ViewportShift> viewports;

  std::vector<ImageId> color;  ///< attachments of draw and full-screen passes
  ImageId depth;
  bool depth_read_only = false;
  std::vector<ImageId> sampled;   ///< images that shaders read, in the order of their slots
  std::vector<Format> views;      ///< as which shaders read `sampled`; none: its format, and no map at all
  std::vector<BufferId> storage;  ///< buffers that shaders read or write, in the order of their slots
  std::uint64_t storage_written = 0;  ///< bit i: storage[i] is written
  /// Compute: one of `sampled`, a depth image whose tiles the program may read as the planes that they are
  /// compressed to (GpuFeatures::compressed_depth_read).
  ImageId depth_planes;
  /// The planes are given: the GPU need not let programs read them, and no pass of the frame makes them.
  bool depth_planes_given = false;

  std::vector<DrawBatch> batches;  // draw
  PipelineState state;             // full_screen
  const FragmentProgram* fragment = nullptr;
  const ComputeProgram* compute = nullptr;
  int groups_x = 0, groups_y = 0;  // compute
  Uniforms uniforms;               // full_screen and compute

  std::vector<ImageId> targets;  ///< clear: images; copy and resolve: the destination; full-screen and
                                 ///< compute: images that shaders store to
  ImageId source;                ///< copy and resolve
  ResolveMode resolve = ResolveMode::average;  ///< depth: max
  glm::vec4 clear_color{0.0f};
  float clear_depth = 1.0f;
  std::uint8_t clear_stencil = 0;
  std::vector<Format>
      target_views;  ///< as which shaders store to `targets`; missing or none: the image's format
  float full_screen_depth = 0.0f;  ///< where the triangle lies that covers the screen
  bool keep = false;               ///< never culled, though the output does not need it

  Format view_of(const FrameGraph& graph, std::size_t slot) const;
  Format target_view_of(const FrameGraph& graph, std::size_t slot) const;
};

class FrameGraph {
 public:
  FrameGraph(std::shared_ptr<const Scene> scene, int width, int height)
      : scene_(std::move(scene)), width_(width), height_(height) {}

  ImageId add_image(ImageDesc desc);
  /// An image that is in memory before the frame starts: a table, or what a filter is to work on. Formats of
  /// one 32-bit word a texel.
  ImageId add_image(ImageDesc desc, std::shared_ptr<const RawImage> contents);
  BufferId add_buffer(BufferDesc desc);
  Pass& add_pass(std::string name, PassKind kind);
  Pass& add_clear(std::string name, std::vector<ImageId> targets, glm::vec4 color = glm::vec4(0.0f));
  Pass& add_resolve(std::string name, ImageId source, ImageId target);
  /// What is presented, read as `view`; none: the image's format.
  void set_output(ImageId image, Format view = Format::none) {
    output_ = image;
    output_view_ = view;
  }

  /// What is presented becomes linear light beyond 1 too: its format, and that of what is resolved into it,
  /// are half floats.
  void make_output_linear();

  /// None of the passes added so far is culled: something else than the output is looked at.
  void keep_passes() {
    for (Pass& pass : passes_) pass.keep = true;
  }

  const Scene& scene() const { return *scene_; }
  std::shared_ptr<const Scene> shared_scene() const { return scene_; }
  int width() const { return width_; }
  int height() const { return height_; }
  ImageId output() const { return output_; }
  Format output_view() const { return output_view_ == Format::none ? image(output_).format : output_view_; }
  /// Null: nothing before a pass writes it.
  const RawImage* contents(ImageId id) const {
    return contents_.at(static_cast<std::size_t>(id.index)).get();
  }
  const ImageDesc& image(ImageId id) const { return images_.at(static_cast<std::size_t>(id.index)); }
  const BufferDesc& buffer(BufferId id) const { return buffers_.at(static_cast<std::size_t>(id.index)); }
  std::span<const ImageDesc> images() const { return images_; }
  std::span<const BufferDesc> buffers() const { return buffers_; }
  std::span<const Pass> passes() const { return passes_; }

 private:
  std::shared_ptr<const Scene> scene_;
  int width_, height_;
  ImageId output_;
  Format output_view_ = Format::none;
  std::vector<ImageDesc> images_;
  std::vector<std::shared_ptr<const RawImage>> contents_;  ///< by image
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
  std::uint64_t allocated_bytes = 0;  ///< sum over all but those of culled passes, without reuse of memory
};

/// What a GPU with tile memory has to do for an attachment of a pass.
struct AttachmentUse {
  bool loaded = false;  ///< an earlier pass left contents, and not by a clear
  bool kept = false;    ///< a later pass needs them, other than a resolve just after this one; or the display
};
AttachmentUse attachment_use(const FrameGraph& graph, const CompiledGraph& compiled, int position,
                             ImageId image);

/// The pass at `position` resolves an image that the one just before it drew.
bool resolves_from_tile(const FrameGraph& graph, const CompiledGraph& compiled, int position);

/// Throws InputError with every violation found (codes G0xx), as a driver's debug layer reports them: format
/// and sample-count mismatches, feedback loops, images read before anything wrote them, multisampled images
/// presented or filtered without a resolve, features that this GPU lacks.
CompiledGraph compile(const FrameGraph& graph, const GpuFeatures& features,
                      const FunctionalConfig& functional);

}  // namespace hwsim::pipeline
