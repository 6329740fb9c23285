#include "src/colmap/display.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <iostream>

#ifdef GUI_ENABLED
#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#endif

namespace tapa {
namespace {

// Opens a window that is not shown, and draws nothing into it.
bool OpenWindow() {
#ifdef GUI_ENABLED
  int argc = 1;
  char name[] = "colmap";
  char* argv[] = {name, nullptr};
  const QGuiApplication application(argc, argv);
  QOpenGLContext context;
  QOffscreenSurface surface;
  surface.create();
  return surface.isValid() && context.create() && context.makeCurrent(&surface);
#else
  return false;
#endif
}

bool TryWindow() {
  constexpr unsigned kMaxSeconds = 30;
  std::cout << std::flush;
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    alarm(kMaxSeconds);
    _exit(OpenWindow() ? 0 : 1);
  }
  int status = 1;
  return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

}  // namespace

bool CanUseOpenGl() {
  static const bool can = [] {
    const bool has_window = TryWindow();
    if (!has_window) {
      std::cout << "There is no display with OpenGL: the CPU is used for "
                   "features."
                << std::endl;
    }
    return has_window;
  }();
  return can;
}

}  // namespace tapa
