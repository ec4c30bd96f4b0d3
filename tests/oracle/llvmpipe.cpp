#include "oracle/llvmpipe.h"

#ifdef HWSIM_HAVE_GL_HEADERS

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "oracle/gl_functions.h"

namespace hwsim::oracle {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec4 position;
layout(location = 1) in vec3 color;
uniform mat4 clip_from_position;
out vec3 vertex_color;
void main() { vertex_color = color; gl_Position = clip_from_position * position; })";
constexpr const char* kPrimitiveShader = R"(#version 450 core
uniform uint first_primitive;
layout(location = 0) out uint primitive;
void main() { primitive = first_primitive + uint(gl_PrimitiveID); })";
constexpr const char* kGouraudShader = R"(#version 450 core
in vec3 vertex_color;
layout(location = 0) out vec4 color;
void main() { color = vec4(vertex_color, 1.0); })";
constexpr const char* kEmptyShader = "#version 450 core\nvoid main() {}";
// One sample of a multisample target, copied to a target that can be read back.
constexpr const char* kFullScreenShader = R"(#version 450 core
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0.5, 1); })";
constexpr const char* kFetchShader = R"(#version 450 core
uniform usampler2DMS primitives;
uniform sampler2DMS depths;
uniform int sample_index;
layout(location = 0) out uvec2 value;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  value.x = texelFetch(primitives, at, sample_index).x;
  value.y = floatBitsToUint(texelFetch(depths, at, sample_index).x);
})";

bool is_native(int samples) { return samples == 1 || samples == 4; }

class Target {
 public:
  Target(const GlFunctions& gl, const RenderSettings& s, int samples, GLenum color_format) : gl_(gl) {
    gl.GenTextures(2, textures_);
    gl.GenFramebuffers(1, &framebuffer_);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    const GLenum target = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    const GLenum formats[] = {color_format, GL_DEPTH_COMPONENT32F},
                 points[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (int i = 0; i < 2; ++i) {
      if (formats[i] == GL_NONE) continue;
      gl.BindTexture(target, textures_[i]);
      if (samples > 1)
        gl.TexImage2DMultisample(target, samples, formats[i], s.width, s.height, GL_TRUE);
      else
        gl.TexStorage2D(target, 1, formats[i], s.width, s.height);
      gl.FramebufferTexture2D(GL_FRAMEBUFFER, points[i], target, textures_[i], 0);
    }
    if (color_format == GL_NONE) gl.DrawBuffer(GL_NONE);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("llvmpipe: the framebuffer is not complete");
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  ~Target() {
    gl_.DeleteFramebuffers(1, &framebuffer_);
    gl_.DeleteTextures(2, textures_);
  }
  void bind() const { gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }
  GLuint color() const { return textures_[0]; }
  GLuint depth() const { return textures_[1]; }

 private:
  const GlFunctions& gl_;
  GLuint textures_[2] = {0, 0};
  GLuint framebuffer_ = 0;
};

class DeviceMesh {
 public:
  DeviceMesh(const GlFunctions& gl, const ClipMesh& mesh)
      : matrix(mesh.clip_from_position),
        first_primitive(mesh.first_primitive),
        index_count(static_cast<GLsizei>(mesh.indices.size())),
        gl_(gl) {
    gl.GenVertexArrays(1, &array_);
    gl.GenBuffers(3, buffers_);
    gl.BindVertexArray(array_);
    fill(GL_ARRAY_BUFFER, buffers_[0], mesh.positions);
    gl.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    if (!mesh.colors.empty()) {
      fill(GL_ARRAY_BUFFER, buffers_[1], mesh.colors);
      gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
      gl.EnableVertexAttribArray(1);
    }
    fill(GL_ELEMENT_ARRAY_BUFFER, buffers_[2], mesh.indices);
  }
  DeviceMesh(const DeviceMesh&) = delete;
  DeviceMesh& operator=(const DeviceMesh&) = delete;
  ~DeviceMesh() {
    gl_.DeleteVertexArrays(1, &array_);
    gl_.DeleteBuffers(3, buffers_);
  }
  void bind() const { gl_.BindVertexArray(array_); }

  std::array<float, 16> matrix;
  std::uint32_t first_primitive;
  GLsizei index_count;

 private:
  template <class T>
  void fill(GLenum target, GLuint buffer, const std::vector<T>& data) {
    gl_.BindBuffer(target, buffer);
    gl_.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STATIC_DRAW);
  }
  const GlFunctions& gl_;
  GLuint array_ = 0;
  GLuint buffers_[3] = {0, 0, 0};
};

using DeviceMeshes = std::vector<std::unique_ptr<DeviceMesh>>;

// Takes the viewport's origin and size, in pixels.
struct Viewport {
  float x, y, width, height;
};

}  // namespace

struct Llvmpipe::Impl {
  std::unique_ptr<GlContext> context;
  const GlFunctions& gl;
  std::string renderer;
  int max_viewport_px = 0;
  GLuint primitive_program = 0, gouraud_program = 0, depth_program = 0, fetch_program = 0, empty_array = 0;

  explicit Impl(std::unique_ptr<GlContext> c);
  ~Impl();
  GLuint shader(GLenum kind, const char* source);
  GLuint program(const char* vertex, const char* fragment);
  DeviceMeshes upload(const std::vector<ClipMesh>& meshes);
  void set_state(const RenderSettings& settings, const Viewport& viewport, SampleOffset shift);
  void draw(GLuint program, const DeviceMeshes& meshes);
  void clear(bool has_color, bool integer);
  SampleImage render(const RenderSettings& settings, const Viewport& viewport,
                     const std::vector<ClipMesh>& meshes);
  void read_single(const RenderSettings& settings, SampleImage& image, int sample);
  void read_multi(const RenderSettings& settings, SampleImage& image, const Target& target);
  double draw_seconds(const RenderSettings& settings, DrawKind kind, const Viewport& viewport,
                      const std::vector<ClipMesh>& meshes);
  Viewport wide_viewport(const RenderSettings& settings) const;
  ClipMesh mesh_from(const RenderSettings& settings, const std::vector<FixedTriangle>& triangles) const;
};

Llvmpipe::Impl::Impl(std::unique_ptr<GlContext> c) : context(std::move(c)), gl(context->gl()) {
  renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER)) + std::string(", ") +
             reinterpret_cast<const char*>(gl.GetString(GL_VERSION));
  GLint extent[2] = {0, 0};
  gl.GetIntegerv(GL_MAX_VIEWPORT_DIMS, extent);
  max_viewport_px = 1 << static_cast<int>(std::log2(std::min(extent[0], extent[1])));
  primitive_program = program(kVertexShader, kPrimitiveShader);
  gouraud_program = program(kVertexShader, kGouraudShader);
  depth_program = program(kVertexShader, kEmptyShader);
  fetch_program = program(kFullScreenShader, kFetchShader);
  gl.GenVertexArrays(1, &empty_array);
  // The y axis is turned by the coordinates, not by GL_UPPER_LEFT: with that, llvmpipe decides ties
  // otherwise.
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.FrontFace(GL_CW);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
}

Llvmpipe::Impl::~Impl() {
  for (const GLuint p : {primitive_program, gouraud_program, depth_program, fetch_program})
    gl.DeleteProgram(p);
  gl.DeleteVertexArrays(1, &empty_array);
}

GLuint Llvmpipe::Impl::shader(GLenum kind, const char* source) {
  const GLuint name = gl.CreateShader(kind);
  gl.ShaderSource(name, 1, &source, nullptr);
  gl.CompileShader(name);
  return name;
}

GLuint Llvmpipe::Impl::program(const char* vertex, const char* fragment) {
  const GLuint parts[] = {shader(GL_VERTEX_SHADER, vertex), shader(GL_FRAGMENT_SHADER, fragment)};
  const GLuint name = gl.CreateProgram();
  for (const GLuint part : parts) gl.AttachShader(name, part);
  gl.LinkProgram(name);
  for (const GLuint part : parts) gl.DeleteShader(part);
  GLint linked = 0;
  gl.GetProgramiv(name, GL_LINK_STATUS, &linked);
  if (!linked) throw std::runtime_error("llvmpipe: a shader does not compile");
  return name;
}

DeviceMeshes Llvmpipe::Impl::upload(const std::vector<ClipMesh>& meshes) {
  DeviceMeshes uploaded;
  for (const ClipMesh& mesh : meshes) uploaded.push_back(std::make_unique<DeviceMesh>(gl, mesh));
  return uploaded;
}

// A sample at offset o sees what a pixel's center sees when the picture moves by -o; 1/16 px is exact in a
// float.
void Llvmpipe::Impl::set_state(const RenderSettings& settings, const Viewport& viewport, SampleOffset shift) {
  gl.ViewportIndexedf(0, viewport.x - static_cast<float>(shift.x) / 16.0f,
                      viewport.y - static_cast<float>(shift.y) / 16.0f, viewport.width, viewport.height);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(settings.depth_test == DepthTest::less ? GL_LESS : GL_ALWAYS);
  (settings.cull == Cull::back ? gl.Enable : gl.Disable)(GL_CULL_FACE);
  gl.CullFace(GL_BACK);
}

void Llvmpipe::Impl::draw(GLuint program_name, const DeviceMeshes& meshes) {
  gl.UseProgram(program_name);
  const GLint matrix = gl.GetUniformLocation(program_name, "clip_from_position");
  const GLint first = gl.GetUniformLocation(program_name, "first_primitive");
  for (const auto& mesh : meshes) {
    mesh->bind();
    gl.UniformMatrix4fv(matrix, 1, GL_FALSE, mesh->matrix.data());
    if (first >= 0) gl.Uniform1ui(first, mesh->first_primitive);
    gl.DrawElements(GL_TRIANGLES, mesh->index_count, GL_UNSIGNED_INT, nullptr);
  }
}

void Llvmpipe::Impl::clear(bool has_color, bool integer) {
  const GLuint none[4] = {0, 0, 0, 0};
  const GLfloat black[4] = {0, 0, 0, 1}, far_depth = 1.0f;
  if (has_color && integer) gl.ClearBufferuiv(GL_COLOR, 0, none);
  if (has_color && !integer) gl.ClearBufferfv(GL_COLOR, 0, black);
  gl.ClearBufferfv(GL_DEPTH, 0, &far_depth);
}

SampleImage Llvmpipe::Impl::render(const RenderSettings& settings, const Viewport& viewport,
                                   const std::vector<ClipMesh>& meshes) {
  const std::span<const SampleOffset> offsets = standard_offsets(settings.samples);
  if (offsets.empty()) throw std::invalid_argument("llvmpipe: samples must be 1, 2, 4, 8 or 16");
  SampleImage image(settings.width, settings.height, settings.samples);
  image.depth.resize(image.primitive.size());
  const DeviceMeshes uploaded = upload(meshes);
  const bool native = is_native(settings.samples);
  const Target target(gl, settings, native ? settings.samples : 1, GL_R32UI);
  const int passes = native ? 1 : settings.samples;
  for (int pass = 0; pass < passes; ++pass) {
    target.bind();
    set_state(settings, viewport, native ? SampleOffset{} : offsets[static_cast<std::size_t>(pass)]);
    clear(true, true);
    draw(primitive_program, uploaded);
    if (!native || settings.samples == 1) read_single(settings, image, pass);
  }
  if (native && settings.samples > 1) read_multi(settings, image, target);
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("llvmpipe: an OpenGL error");
  return image;
}

void Llvmpipe::Impl::read_single(const RenderSettings& settings, SampleImage& image, int sample) {
  const std::size_t pixels = image.primitive.size() / static_cast<std::size_t>(image.samples);
  std::vector<std::uint32_t> primitive(pixels);
  std::vector<float> depth(pixels);
  gl.ReadPixels(0, 0, settings.width, settings.height, GL_RED_INTEGER, GL_UNSIGNED_INT, primitive.data());
  gl.ReadPixels(0, 0, settings.width, settings.height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t to = i * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(sample);
    image.primitive[to] = primitive[i];
    image.depth[to] = depth[i];
  }
}

void Llvmpipe::Impl::read_multi(const RenderSettings& settings, SampleImage& image, const Target& target) {
  const Target copy(gl, settings, 1, GL_RG32UI);
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.ViewportIndexedf(0, 0.0f, 0.0f, static_cast<float>(settings.width), static_cast<float>(settings.height));
  gl.UseProgram(fetch_program);
  gl.BindVertexArray(empty_array);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, target.color());
  gl.ActiveTexture(GL_TEXTURE1);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, target.depth());
  gl.ActiveTexture(GL_TEXTURE0);
  gl.Uniform1i(gl.GetUniformLocation(fetch_program, "primitives"), 0);
  gl.Uniform1i(gl.GetUniformLocation(fetch_program, "depths"), 1);
  const std::size_t pixels = image.primitive.size() / static_cast<std::size_t>(image.samples);
  std::vector<std::array<std::uint32_t, 2>> values(pixels);
  for (int s = 0; s < image.samples; ++s) {
    gl.Uniform1i(gl.GetUniformLocation(fetch_program, "sample_index"), s);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    gl.ReadPixels(0, 0, settings.width, settings.height, GL_RG_INTEGER, GL_UNSIGNED_INT, values.data());
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::size_t to = i * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(s);
      image.primitive[to] = values[i][0];
      image.depth[to] = std::bit_cast<float>(values[i][1]);
    }
  }
}

double Llvmpipe::Impl::draw_seconds(const RenderSettings& settings, DrawKind kind, const Viewport& viewport,
                                    const std::vector<ClipMesh>& meshes) {
  const DeviceMeshes uploaded = upload(meshes);
  const bool native = is_native(settings.samples), gouraud = kind == DrawKind::gouraud;
  const Target target(gl, settings, native ? settings.samples : 1, gouraud ? GL_RGBA8 : GL_NONE);
  const std::span<const SampleOffset> offsets = standard_offsets(settings.samples);
  double seconds = 0.0;
  for (int repeat = 0; repeat < 2; ++repeat) {  // the first one compiles the shaders for this state
    gl.Finish();
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t pass = 0; pass < (native ? 1 : offsets.size()); ++pass) {
      set_state(settings, viewport, native ? SampleOffset{} : offsets[pass]);
      clear(gouraud, false);
      draw(gouraud ? gouraud_program : depth_program, uploaded);
    }
    gl.Finish();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return seconds;
}

// A power of two, so that window coordinates pass through clip space without rounding, centered on the
// target.
Viewport Llvmpipe::Impl::wide_viewport(const RenderSettings& settings) const {
  const auto size = static_cast<float>(max_viewport_px);
  return {static_cast<float>(settings.width / 2) - size / 2,
          static_cast<float>(settings.height / 2) - size / 2, size, size};
}

ClipMesh Llvmpipe::Impl::mesh_from(const RenderSettings& settings,
                                   const std::vector<FixedTriangle>& triangles) const {
  ClipMesh mesh;
  const std::int32_t center_x = settings.width / 2 * kSubpixelsPerPixel,
                     center_y = settings.height / 2 * kSubpixelsPerPixel;
  const float half_extent = static_cast<float>(max_viewport_px / 2 * kSubpixelsPerPixel);
  for (const FixedTriangle& triangle : triangles)
    for (const FixedVertex& v : triangle.vertices) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back({static_cast<float>(v.x - center_x) / half_extent,
                                static_cast<float>(v.y - center_y) / half_extent, v.depth, 1.0f});
      mesh.colors.push_back({v.depth, 1.0f - v.depth, 0.5f});
    }
  return mesh;
}

namespace {

// GL's row 0 is our top row.
std::vector<ClipMesh> with_y_down(std::vector<ClipMesh> meshes) {
  for (ClipMesh& mesh : meshes)
    for (std::size_t column = 0; column < 4; ++column) {
      float& to_clip_y = mesh.clip_from_position[4 * column + 1];
      to_clip_y = -to_clip_y;
    }
  return meshes;
}

Viewport full_viewport(const RenderSettings& settings) {
  return {0.0f, 0.0f, static_cast<float>(settings.width), static_cast<float>(settings.height)};
}

}  // namespace

Llvmpipe::Llvmpipe(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Llvmpipe::~Llvmpipe() = default;

std::unique_ptr<Llvmpipe> Llvmpipe::create(std::string& why_not) {
  std::unique_ptr<GlContext> context = GlContext::create(why_not);
  if (!context) return nullptr;
  auto impl = std::make_unique<Impl>(std::move(context));
  if (impl->renderer.find("llvmpipe") == std::string::npos)
    return why_not = "OpenGL runs on " + impl->renderer + ", not on llvmpipe", nullptr;
  return std::unique_ptr<Llvmpipe>(new Llvmpipe(std::move(impl)));
}

const std::string& Llvmpipe::renderer() const { return impl_->renderer; }
int Llvmpipe::unclipped_extent_px() const { return impl_->max_viewport_px / 2; }

std::vector<SampleOffset> Llvmpipe::native_offsets(int samples) {
  const Target target(impl_->gl, {.width = 8, .height = 8}, samples, GL_R32UI);
  std::vector<SampleOffset> offsets;
  for (GLuint s = 0; s < static_cast<GLuint>(samples); ++s) {
    GLfloat position[2] = {0, 0};
    impl_->gl.GetMultisamplefv(GL_SAMPLE_POSITION, s, position);
    offsets.push_back({static_cast<int>(std::lround(position[0] * 16.0f)) - 8,
                       static_cast<int>(std::lround(position[1] * 16.0f)) - 8});
  }
  return offsets;
}

SampleImage Llvmpipe::render(const RenderSettings& settings, const std::vector<FixedTriangle>& triangles) {
  return impl_->render(settings, impl_->wide_viewport(settings), {impl_->mesh_from(settings, triangles)});
}

SampleImage Llvmpipe::render(const RenderSettings& settings, const std::vector<ClipMesh>& meshes) {
  return impl_->render(settings, full_viewport(settings), with_y_down(meshes));
}

double Llvmpipe::draw_seconds(const RenderSettings& settings, DrawKind kind,
                              const std::vector<ClipMesh>& meshes) {
  return impl_->draw_seconds(settings, kind, full_viewport(settings), with_y_down(meshes));
}

double Llvmpipe::draw_seconds(const RenderSettings& settings, DrawKind kind,
                              const std::vector<FixedTriangle>& triangles) {
  return impl_->draw_seconds(settings, kind, impl_->wide_viewport(settings),
                             {impl_->mesh_from(settings, triangles)});
}

}  // namespace hwsim::oracle
#else
#include <stdexcept>

namespace hwsim::oracle {

struct Llvmpipe::Impl {
  std::string renderer;
};

namespace {
[[noreturn]] void refuse() { throw std::logic_error("llvmpipe: this build has no OpenGL headers"); }
}  // namespace

Llvmpipe::Llvmpipe(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Llvmpipe::~Llvmpipe() = default;
std::unique_ptr<Llvmpipe> Llvmpipe::create(std::string& why_not) {
  why_not = "built without the headers of EGL and OpenGL (libegl-dev, libgl-dev)";
  return nullptr;
}
const std::string& Llvmpipe::renderer() const { return impl_->renderer; }
int Llvmpipe::unclipped_extent_px() const { refuse(); }
std::vector<SampleOffset> Llvmpipe::native_offsets(int) { refuse(); }
SampleImage Llvmpipe::render(const RenderSettings&, const std::vector<FixedTriangle>&) { refuse(); }
SampleImage Llvmpipe::render(const RenderSettings&, const std::vector<ClipMesh>&) { refuse(); }
double Llvmpipe::draw_seconds(const RenderSettings&, DrawKind, const std::vector<ClipMesh>&) { refuse(); }
double Llvmpipe::draw_seconds(const RenderSettings&, DrawKind, const std::vector<FixedTriangle>&) {
  refuse();
}

}  // namespace hwsim::oracle
#endif
