#pragma once
// From assembled vertices to triangles ready for rasterization: clipping, culling, set-up.
#include <array>

#include "pipeline/emulate/pass_context.h"
#include "pipeline/raster/clip.h"

namespace hwsim::pipeline {

ScreenVertex to_screen(const double* clip, int width_px, int height_px);

/// A vertex with what clipping and set-up ask of it.
ShadedVertex place_vertex(const float (&clip)[4], const GuardBand& band, int width_px, int height_px);

/// Where a primitive's vertices and varyings lie.
struct VertexSource {
  const ShadedVertex* vertices = nullptr;
  const float* varyings = nullptr;  ///< vertex v's begin at varyings + v * stride
  std::size_t stride = 0, scalars = 0;
  bool temporary = false;  ///< varyings are copied to the item, where shading finds them later
};

SetupRules setup_rules(const PassContext& context, const DrawInfo& draw);

/// Half the size of a state's points, 1/256 px.
std::int32_t point_half(const PipelineState& state);

/// Clips, culls and sets up the primitives of one draw, and appends what is left to an item.
class PrimitiveSetup {
 public:
  PrimitiveSetup(const PassContext& context, const VertexSource& source, GeometryItem& item);
  void set_source(const VertexSource& source) { source_ = source; }

  /// Where the following primitives' work is charged, and the number they carry.
  void start_primitive(std::uint32_t primitive, PassCounters& counters);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// `count` triangles of vertices given by `indices` less `first_vertex`, from the primitive started on.
  void add_triangles(const std::uint32_t* indices, std::uint32_t count, std::uint32_t first_vertex);
  void add_point(std::uint32_t v);
  void add_line(std::uint32_t a, std::uint32_t b);

 private:
  using Vertices = std::array<std::uint32_t, 3>;
  std::array<std::uint64_t, 4> place_triangles(const std::uint32_t* indices, std::uint32_t count,
                                               std::uint32_t first_vertex);
  void keep_point(const ScreenVertex& center, std::uint32_t v);
  void add_quad(const std::array<ScreenVertex, 4>& corner, const std::array<std::uint32_t, 4>& v);
  void add_clipped(const Vertices& v);
  ClipVertex clip_vertex(std::uint32_t v, std::size_t corner) const;
  void cull_outside();
  std::uint32_t own_vertices() const;
  std::uint32_t kept_vertex(std::uint32_t v);
  void append_varyings(const Vertices& v, const std::array<double, 3>& weights);
  void place(const ScreenVertex (&screen)[3], const Vertices& v);
  void count(SetupResult result, std::uint64_t triangles = 1);

  const PassContext& c_;
  const DrawInfo& draw_;
  GeometryItem& item_;
  VertexSource source_;
  GuardBand band_;
  SetupRules rules_;
  PassCounters* counters_ = nullptr;
  std::uint32_t primitive_ = 0;
};

}  // namespace hwsim::pipeline
