#include <gnomon/gl/context.h>

#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include <epoxy/egl.h>

namespace gnomon::gl {

struct HeadlessContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  ~State() {
    if (display == EGL_NO_DISPLAY) return;
    if (context != EGL_NO_CONTEXT) {
      if (eglGetCurrentContext() == context)
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(display, context);
    }
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    // The display stays initialized: it is one per process, and others may use it.
  }
};

HeadlessContext::HeadlessContext(std::unique_ptr<State> state) : state_(std::move(state)) {}
HeadlessContext::HeadlessContext(HeadlessContext&&) noexcept = default;
HeadlessContext& HeadlessContext::operator=(HeadlessContext&&) noexcept = default;
HeadlessContext::~HeadlessContext() = default;

void HeadlessContext::make_current() const {
  eglMakeCurrent(state_->display, state_->surface, state_->surface, state_->context);
}

Result<HeadlessContext> HeadlessContext::create(Api api) {
  auto state = std::make_unique<State>();
  EGLDisplay display = EGL_NO_DISPLAY;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  }
  if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || eglInitialize(display, &major, &minor) == EGL_FALSE) {
    return Error{
        "There is no EGL display to draw on; on Debian, libegl1 and libgl1-mesa-dri bring one that "
        "needs no graphics card."};
  }
  state->display = display;
  const bool es = api == Api::opengl_es;
  const std::string name = es ? "OpenGL ES 3.0" : "OpenGL 3.3 core";
  if (eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) == EGL_FALSE) {
    return Error{"This EGL has no " + std::string(es ? "OpenGL ES" : "OpenGL") + "."};
  }
  const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                     es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglChooseConfig(display, wanted.data(), &config, 1, &count);
  const std::array<EGLint, 7> core{EGL_CONTEXT_MAJOR_VERSION,
                                   3,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   3,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_NONE};
  const std::array<EGLint, 5> embedded{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0,
                                       EGL_NONE};
  state->context = eglCreateContext(display, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT,
                                    es ? embedded.data() : core.data());
  if (state->context == EGL_NO_CONTEXT) return Error{"EGL makes no context of " + name + "."};
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) {
    const std::array<EGLint, 5> size{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    state->surface = eglCreatePbufferSurface(display, config, size.data());
  }
  if (eglMakeCurrent(display, state->surface, state->surface, state->context) == EGL_FALSE)
    return Error{"EGL does not make its context of " + name + " current."};
  return HeadlessContext(std::move(state));
}

}  // namespace gnomon::gl
