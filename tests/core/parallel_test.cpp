#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
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
