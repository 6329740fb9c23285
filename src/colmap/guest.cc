#include "src/colmap/guest.h"

#include <unistd.h>

#include <atomic>
#include <utility>

namespace tapa {
namespace {

// Never deleted: threads that are left may still use it.
std::atomic<const GuestListener*> host{nullptr};

}  // namespace

void BecomeGuest(GuestListener listener) {
  host = new GuestListener(std::move(listener));
}

bool IsGuest() { return host != nullptr; }

void TellHost(const std::string& error) { host.load()->on_error(error); }

void EndGuestThread() {
  host.load()->on_fatal();
  for (;;) {
    pause();
  }
}

}  // namespace tapa
