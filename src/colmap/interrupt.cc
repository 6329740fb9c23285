#include "src/colmap/interrupt.h"

#include <atomic>

#include "src/colmap/guest.h"

namespace tapa {
namespace {

// Whichever thread the system interrupts notes it, and another one asks.
std::atomic<int> received_signal(0);
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal must not wait for a lock");

void NoteSignal(int signal) {
  received_signal = signal;
  // A second one is deadly, whichever of the two it is.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

Interrupt::Interrupt() : is_off_(IsGuest()) {
  received_signal = 0;
  if (is_off_) {
    return;
  }
  struct sigaction action = {};
  action.sa_handler = NoteSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
}

Interrupt::~Interrupt() {
  if (is_off_) {
    return;
  }
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
}

int Interrupt::Signal() const { return received_signal; }

}  // namespace tapa
