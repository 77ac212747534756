// An OpenGL context without window or display: EGL on Mesa's surfaceless platform where it is there
// (no graphics card needed), else EGL's default display.
#pragma once

#include <memory>

#include <gnomon/core/result.h>

namespace gnomon::gl {

enum class Api { opengl, opengl_es };  // OpenGL 3.3 core or later; OpenGL ES 3.0 or later

// Current on the thread that made it, until it is destroyed. It draws into framebuffer objects
// only.
class HeadlessContext {
 public:
  // Errors: no EGL, no such API, no context of that version.
  static Result<HeadlessContext> create(Api api = Api::opengl);
  HeadlessContext(HeadlessContext&&) noexcept;
  HeadlessContext& operator=(HeadlessContext&&) noexcept;
  ~HeadlessContext();

  void make_current() const;

 private:
  struct State;
  explicit HeadlessContext(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gnomon::gl
