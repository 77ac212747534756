#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gnomon/core/parallel.h>
#include <gnomon/core/result.h>
#include <gnomon/core/warnings.h>

namespace gnomon {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceForAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<std::atomic<int>> visits(1000);
    parallel_for(1000, threads, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
    for (const auto& v : visits) ASSERT_EQ(v, 1);
  }
  parallel_for(0, 2, [](int) { FAIL(); });
}

TEST(ParallelFor, PassesExceptionsOn) {
  EXPECT_THROW(parallel_for(10, 2,
                            [](int i) {
                              if (i == 5) throw std::runtime_error("five");
                            }),
               std::runtime_error);
}

TEST(ParallelFor, WithinAnotherVisitsEveryIndexOnce) {
  for (const int inner : {1, 2, 3}) {
    std::vector<std::atomic<int>> visits(400);
    parallel_for(20, 2, [&](int i) {
      parallel_for(20, inner, [&](int k) { ++visits[static_cast<std::size_t>(20 * i + k)]; });
    });
    for (const auto& v : visits) ASSERT_EQ(v, 1);
  }
}

TEST(ParallelFor, CalledByManyThreadsVisitsEveryIndexOnceForEach) {
  std::vector<std::atomic<int>> visits(4 * 1000);
  std::vector<std::thread> callers;
  for (int c = 0; c < 4; ++c) {
    callers.emplace_back([&visits, c] {
      for (int begin = 0; begin < 1000; begin += 50) {
        parallel_for(50, 2 + c % 2,
                     [&](int i) { ++visits[static_cast<std::size_t>(1000 * c + begin + i)]; });
      }
    });
  }
  for (std::thread& t : callers) t.join();
  for (const auto& v : visits) ASSERT_EQ(v, 1);
}

// Every call once left some kilobytes behind, and made the next one slower.
TEST(ParallelFor, CalledOverAndOverTakesNoMoreMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer keeps memory that is freed";
#endif
  const auto pages = [] {
    std::ifstream file("/proc/self/statm");
    long all = 0, resident = 0;
    file >> all >> resident;
    return resident;
  };
  if (pages() == 0) GTEST_SKIP() << "this system does not say how much memory is taken";
  const auto call = [](int times) {
    for (int k = 0; k < times; ++k) parallel_for(10, 2, [](int) {});
  };
  call(100);
  const long before = pages();
  call(4000);
  EXPECT_LT(pages() - before, 2000);
}

TEST(Result, ValueOfAnErrorThrowsItsMessage) {
  const Result<int> r = Error{"why"};
  EXPECT_FALSE(r);
  try {
    (void)r.value();
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "why");
  }
}

TEST(Warnings, SameSentenceIsCountedAndKeepsItsFirstElement) {
  Warnings w;
  warn(w, "odd face", "face 3");
  warn(w, "odd face", "face 9", 2);
  warn(w, "nothing", "x", 0);
  ASSERT_EQ(w.size(), 1u);
  EXPECT_EQ(w[0].count, 3u);
  EXPECT_EQ(w[0].first, "face 3");
}

}  // namespace
}  // namespace gnomon
