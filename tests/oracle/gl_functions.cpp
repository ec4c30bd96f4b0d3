#include "oracle/gl_functions.h"

#ifdef HWSIM_HAVE_GL_HEADERS
#include <dlfcn.h>

#include <cstdlib>

namespace hwsim::oracle {
namespace {

template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(::dlsym(library, name));
}

}  // namespace

std::unique_ptr<GlContext> GlContext::create(std::string& why_not) {
  std::unique_ptr<GlContext> context(new GlContext);
  return context->open(why_not) ? std::move(context) : nullptr;
}

// The display is not terminated, nor the library closed: Mesa's threads may still run in it.
GlContext::~GlContext() {
  if (!egl_ || context_ == EGL_NO_CONTEXT) return;
  const auto make_current = symbol<PFNEGLMAKECURRENTPROC>(egl_, "eglMakeCurrent");
  const auto destroy = symbol<PFNEGLDESTROYCONTEXTPROC>(egl_, "eglDestroyContext");
  make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  destroy(display_, context_);
}

bool GlContext::load_functions(PFNEGLGETPROCADDRESSPROC get, std::string& why_not) {
  bool complete = true;
#define HWSIM_GL_LOAD(name, type)                                  \
  gl_.name = reinterpret_cast<PFNGL##type##PROC>(get("gl" #name)); \
  if (!gl_.name) complete = false, why_not = "OpenGL lacks gl" #name;
  HWSIM_GL_FUNCTIONS(HWSIM_GL_LOAD)
#undef HWSIM_GL_LOAD
  return complete;
}

bool GlContext::open(std::string& why_not) {
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);  // a machine with a GPU shall use llvmpipe all the same
  egl_ = ::dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!egl_) return why_not = "libEGL.so.1 cannot be opened", false;
  const auto get = symbol<PFNEGLGETPROCADDRESSPROC>(egl_, "eglGetProcAddress");
  const auto initialize = symbol<PFNEGLINITIALIZEPROC>(egl_, "eglInitialize");
  const auto bind_api = symbol<PFNEGLBINDAPIPROC>(egl_, "eglBindAPI");
  const auto create_context = symbol<PFNEGLCREATECONTEXTPROC>(egl_, "eglCreateContext");
  const auto make_current = symbol<PFNEGLMAKECURRENTPROC>(egl_, "eglMakeCurrent");
  if (!get || !initialize || !bind_api || !create_context || !make_current)
    return why_not = "libEGL.so.1 lacks functions of EGL 1.4", false;
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(get("eglGetPlatformDisplayEXT"));
  if (!get_display) return why_not = "EGL lacks EGL_EXT_platform_base", false;
  display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display_ == EGL_NO_DISPLAY || !initialize(display_, nullptr, nullptr))
    return why_not = "EGL has no display without a surface", false;
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  if (!bind_api(EGL_OPENGL_API)) return why_not = "EGL has no OpenGL", false;
  context_ = create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context_ == EGL_NO_CONTEXT || !make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    return why_not = "no OpenGL 4.5 core context", false;
  return load_functions(get, why_not);
}

}  // namespace hwsim::oracle
#endif
