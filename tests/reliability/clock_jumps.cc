// Preloaded into a program, lets the clock of the day jump by hours, forth and
// back, every 20 ms, as when somebody sets it or summer time is taken for a
// change of it. The clock that only goes forward (CLOCK_MONOTONIC) is left
// alone.

#include <dlfcn.h>
#include <sys/time.h>

#include <ctime>

namespace {

using ClockGettime = int(clockid_t, timespec*);

int RealGettime(clockid_t clock, timespec* time) {
  static auto* const next =
      reinterpret_cast<ClockGettime*>(dlsym(RTLD_NEXT, "clock_gettime"));
  return next(clock, time);
}

// In seconds.
time_t Jump() {
  constexpr time_t kHours[] = {0, 5, -7, 30 * 24, -1};
  timespec now;
  RealGettime(CLOCK_MONOTONIC, &now);
  const long step = now.tv_sec * 50 + now.tv_nsec / 20000000;
  return 3600 * kHours[step % 5];
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = RealGettime(clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) {
    time->tv_sec += Jump();
  }
  return result;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now;
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return result;
}

time_t time(time_t* result) noexcept {
  timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (result != nullptr) {
    *result = now.tv_sec;
  }
  return now.tv_sec;
}

}  // extern "C"
