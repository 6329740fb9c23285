#include "src/colmap/terminal_line.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "src/colmap/guest.h"
#include "util/string.h"

namespace tapa {
namespace {

// Begins the line anew. This does not go through std::cerr, of which the
// graphical interface keeps a log.
constexpr char kErase[] = "\r\033[K";
// What is beyond the edge is not shown, rather than on a line that would stay.
constexpr char kNoWrap[] = "\033[?7l";
constexpr char kWrap[] = "\033[?7h";

std::string TimeText(double seconds) {
  const long s = std::lround(std::max(0.0, std::min(seconds, 1e9)));
  return colmap::StringPrintf("%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

std::string TimeToGo(double share, double seconds) {
  return colmap::StringPrintf(
      "%5.1f %%  %s to go", 100 * share,
      share > 0 ? TimeText(seconds * (1 - share) / share).c_str() : "?");
}

TerminalLine::TerminalLine()
    : is_terminal_(!IsGuest() && isatty(STDERR_FILENO)) {}

void TerminalLine::Show(const std::string& text) {
  if (is_terminal_) {
    std::fputs((kNoWrap + (kErase + text) + kWrap).c_str(), stderr);
    is_shown_ = true;
  }
}

void TerminalLine::Clear() {
  if (is_shown_) {
    std::fputs(kErase, stderr);
    is_shown_ = false;
  }
}

}  // namespace tapa
