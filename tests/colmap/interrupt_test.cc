#include "src/colmap/interrupt.h"

#include <gtest/gtest.h>

#include <csignal>

namespace tapa {
namespace {

TEST(Interrupt, NotesTheSignalAndRestoresTheHandlers) {
  struct sigaction before;
  sigaction(SIGINT, nullptr, &before);
  {
    const Interrupt interrupt;
    EXPECT_EQ(interrupt.Signal(), 0);
    std::raise(SIGTERM);
    EXPECT_EQ(interrupt.Signal(), SIGTERM);
  }
  struct sigaction after;
  sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
  const Interrupt again;
  EXPECT_EQ(again.Signal(), 0);
}

TEST(InterruptDeathTest, SecondSignalKills) {
  EXPECT_EXIT(
      {
        const Interrupt interrupt;
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace tapa
