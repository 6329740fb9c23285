#include "src/colmap/interrupt.h"

#include "src/colmap/guest.h"

namespace tapa {
namespace {

volatile std::sig_atomic_t received_signal = 0;

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
