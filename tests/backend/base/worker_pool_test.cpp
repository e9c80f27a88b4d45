#include "backend/base/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <vector>

namespace loopgrid {
namespace {

TEST(WorkerPool, TouchesEveryIndexOnce) {
  for (int threads : {1, 2, 3, 8}) {
    WorkerPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (std::size_t count : {0u, 1u, 2u, 7u, 8u, 9u, 1000u}) {
      std::vector<int> touched(count, 0);
      pool.Run(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++touched[i];
      });
      EXPECT_EQ(touched, std::vector<int>(count, 1)) << threads << " threads";
    }
  }
}

TEST(WorkerPool, TakesLessThanOneThreadAsOne) {
  for (int threads : {0, -5}) EXPECT_EQ(WorkerPool(threads).threads(), 1);
}

TEST(WorkerPool, RunsAllPartsAtTheSameTime) {
  constexpr int kThreads = 4;
  WorkerPool pool(kThreads);
  std::atomic<int> arrived = 0;
  std::mutex mutex;
  std::set<std::thread::id> ids;
  pool.Run(kThreads, [&](std::size_t, std::size_t) {
    ++arrived;
    while (arrived < kThreads) std::this_thread::yield();  // for ever, if one had to wait its turn
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(ids.size(), 4u);
  EXPECT_TRUE(ids.count(std::this_thread::get_id()) == 1) << "the caller works too";
}

TEST(WorkerPool, HasFinishedWhenRunReturns) {
  WorkerPool pool(3);
  std::vector<int> values(300, 0);  // not atomic: a race would be seen by the sanitizer
  for (int round = 1; round <= 2000; ++round) {
    pool.Run(values.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) values[i] = round;
    });
    ASSERT_EQ(values, std::vector<int>(300, round));
  }
}

TEST(WorkerPool, ComesAndGoesWithoutWork) {
  for (int i = 0; i < 100; ++i) const WorkerPool pool(1 + i % 4);
}

}  // namespace
}  // namespace loopgrid
