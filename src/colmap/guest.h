#ifndef TAPA_SRC_COLMAP_GUEST_H_
#define TAPA_SRC_COLMAP_GUEST_H_

#include <functional>
#include <string>

namespace tapa {

// What the program that this code is a guest in wants to hear, from any thread.
struct GuestListener {
  // One line, such as a command prints behind "ERROR: ".
  std::function<void(const std::string&)> on_error;
  // After an error, that the calling thread goes no further.
  std::function<void()> on_fatal;
};

// From now on the program is not ours but somebody's who calls us, such as
// Python's interpreter: signals and the terminal are left to it, it hears of
// errors instead of stderr, and what would end the program only keeps the
// thread that finds it from going on. To be called once.
void BecomeGuest(GuestListener listener);
bool IsGuest();

// Of a guest only.
void TellHost(const std::string& error);
// The calling thread sleeps forever, with all that it holds, since COLMAP's
// checks fail where no exception can pass.
[[noreturn]] void EndGuestThread();

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_GUEST_H_
