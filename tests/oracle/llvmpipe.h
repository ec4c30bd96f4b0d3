#pragma once
// Mesa's software rasterizer, llvmpipe, as an independent implementation: OpenGL 4.5 core, EGL without a
// surface.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "oracle/fixed_triangle.h"

namespace hwsim::oracle {

enum class DepthTest { always, less };
enum class Cull { none, back };  ///< the front is counter-clockwise with y up, as glTF has it

/// Positions go through `clip_from_position` (column-major); clip z in [0, w]. `colors` (RGB) may be empty.
struct ClipMesh {
  std::vector<std::array<float, 4>> positions;
  std::vector<std::array<float, 3>> colors;
  std::vector<std::uint32_t> indices;
  std::array<float, 16> clip_from_position{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::uint32_t first_primitive = 1;  ///< number of its first triangle
};

struct RenderSettings {
  int width = 0, height = 0;
  int samples =
      1;  ///< 1, 4: as llvmpipe has them; 2, 8, 16: a single-sample pass a sample, the viewport shifted
  DepthTest depth_test = DepthTest::always;
  Cull cull = Cull::none;
};

enum class DrawKind { depth_only, gouraud };  ///< depth_only: no color is written

class Llvmpipe {
 public:
  /// Null, and the reason, where EGL, OpenGL 4.5 or their headers at build time are missing. The context is
  /// current on the calling thread, and the object is used on it alone.
  static std::unique_ptr<Llvmpipe> create(std::string& why_not);
  ~Llvmpipe();
  Llvmpipe(const Llvmpipe&) = delete;
  Llvmpipe& operator=(const Llvmpipe&) = delete;

  const std::string& renderer() const;  ///< name and version
  /// Largest |coordinate| in pixels from the target's center that is drawn without clipping.
  int unclipped_extent_px() const;
  /// Sample positions of the native 4x mode, in index order.
  std::vector<SampleOffset> native_offsets(int samples);

  SampleImage render(const RenderSettings& settings, const std::vector<FixedTriangle>& triangles);
  SampleImage render(const RenderSettings& settings, const std::vector<ClipMesh>& meshes);

  /// Seconds of one clear and draw with its glFinish, after one that is not counted; buffers are filled
  /// beforehand.
  double draw_seconds(const RenderSettings& settings, DrawKind kind, const std::vector<ClipMesh>& meshes);
  double draw_seconds(const RenderSettings& settings, DrawKind kind,
                      const std::vector<FixedTriangle>& triangles);

 private:
  struct Impl;
  explicit Llvmpipe(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hwsim::oracle
