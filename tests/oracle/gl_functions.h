#pragma once
// OpenGL without linking it: functions come from libEGL, opened at run time.
#ifdef HWSIM_HAVE_GL_HEADERS
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <memory>
#include <string>

namespace hwsim::oracle {

// NAME, type of its pointer
#define HWSIM_GL_FUNCTIONS(X)                         \
  X(AttachShader, ATTACHSHADER)                       \
  X(BindBuffer, BINDBUFFER)                           \
  X(BindFramebuffer, BINDFRAMEBUFFER)                 \
  X(BindTexture, BINDTEXTURE)                         \
  X(BindVertexArray, BINDVERTEXARRAY)                 \
  X(ActiveTexture, ACTIVETEXTURE)                     \
  X(BufferData, BUFFERDATA)                           \
  X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)   \
  X(ClearBufferfv, CLEARBUFFERFV)                     \
  X(ClearBufferuiv, CLEARBUFFERUIV)                   \
  X(ClipControl, CLIPCONTROL)                         \
  X(CompileShader, COMPILESHADER)                     \
  X(CreateProgram, CREATEPROGRAM)                     \
  X(CreateShader, CREATESHADER)                       \
  X(CullFace, CULLFACE)                               \
  X(DeleteBuffers, DELETEBUFFERS)                     \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS)           \
  X(DeleteProgram, DELETEPROGRAM)                     \
  X(DeleteShader, DELETESHADER)                       \
  X(DeleteTextures, DELETETEXTURES)                   \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS)           \
  X(DepthFunc, DEPTHFUNC)                             \
  X(Disable, DISABLE)                                 \
  X(DrawArrays, DRAWARRAYS)                           \
  X(DrawBuffer, DRAWBUFFER)                           \
  X(DrawElements, DRAWELEMENTS)                       \
  X(Enable, ENABLE)                                   \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) \
  X(Finish, FINISH)                                   \
  X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)       \
  X(FrontFace, FRONTFACE)                             \
  X(GenBuffers, GENBUFFERS)                           \
  X(GenFramebuffers, GENFRAMEBUFFERS)                 \
  X(GenTextures, GENTEXTURES)                         \
  X(GenVertexArrays, GENVERTEXARRAYS)                 \
  X(GetError, GETERROR)                               \
  X(GetIntegerv, GETINTEGERV)                         \
  X(GetMultisamplefv, GETMULTISAMPLEFV)               \
  X(GetProgramiv, GETPROGRAMIV)                       \
  X(GetShaderInfoLog, GETSHADERINFOLOG)               \
  X(GetString, GETSTRING)                             \
  X(GetUniformLocation, GETUNIFORMLOCATION)           \
  X(LinkProgram, LINKPROGRAM)                         \
  X(PixelStorei, PIXELSTOREI)                         \
  X(ReadPixels, READPIXELS)                           \
  X(ShaderSource, SHADERSOURCE)                       \
  X(TexImage2DMultisample, TEXIMAGE2DMULTISAMPLE)     \
  X(TexStorage2D, TEXSTORAGE2D)                       \
  X(Uniform1i, UNIFORM1I)                             \
  X(Uniform1ui, UNIFORM1UI)                           \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV)               \
  X(UseProgram, USEPROGRAM)                           \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER)         \
  X(ViewportIndexedf, VIEWPORTINDEXEDF)

struct GlFunctions {
#define HWSIM_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
  HWSIM_GL_FUNCTIONS(HWSIM_GL_MEMBER)
#undef HWSIM_GL_MEMBER
};

/// An OpenGL 4.5 core context without a surface, current on the thread that made it.
class GlContext {
 public:
  static std::unique_ptr<GlContext> create(std::string& why_not);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  const GlFunctions& gl() const { return gl_; }

 private:
  GlContext() = default;
  bool open(std::string& why_not);
  bool load_functions(PFNEGLGETPROCADDRESSPROC get, std::string& why_not);

  void* egl_ = nullptr;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  GlFunctions gl_;
};

}  // namespace hwsim::oracle
#endif
