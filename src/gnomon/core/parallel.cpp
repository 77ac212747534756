#include <gnomon/core/parallel.h>

#ifdef GNOMON_HAVE_TBB
#include <memory>
#include <mutex>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace gnomon {

#ifdef GNOMON_HAVE_TBB
namespace {

// Arenas are given up only when oneTBB's threads have left them, which they do not do between calls
// that follow each other closely: a new one for each call is 7 KB that stay, and every call takes
// longer than the one before. So they are kept, for the next call with as many threads. Nothing is
// given up at the program's end, when oneTBB may have gone before.
class Arenas {
 public:
  std::unique_ptr<tbb::task_arena> take(int threads) {
    const std::lock_guard lock(mutex_);
    for (auto a = free_.begin(); a != free_.end(); ++a) {
      if ((*a)->max_concurrency() != threads) continue;
      std::unique_ptr<tbb::task_arena> found = std::move(*a);
      free_.erase(a);
      return found;
    }
    return std::make_unique<tbb::task_arena>(threads);
  }
  void give(std::unique_ptr<tbb::task_arena> arena) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(arena));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<tbb::task_arena>> free_;
};
Arenas& arenas() {
  static Arenas& all = *new Arenas;
  return all;
}

class TakenArena {
 public:
  explicit TakenArena(int threads) : arena_(arenas().take(threads)) {}
  ~TakenArena() { arenas().give(std::move(arena_)); }
  TakenArena(const TakenArena&) = delete;
  TakenArena& operator=(const TakenArena&) = delete;
  tbb::task_arena& operator*() { return *arena_; }

 private:
  std::unique_ptr<tbb::task_arena> arena_;
};

thread_local bool in_body = false;

struct InBody {
  bool before = in_body;
  InBody() { in_body = true; }
  ~InBody() { in_body = before; }
  InBody(const InBody&) = delete;
  InBody& operator=(const InBody&) = delete;
};

}  // namespace

void parallel_for(int n, int threads, const std::function<void(int)>& body) {
  if (threads <= 0) threads = tbb::info::default_concurrency();
  if (n <= 1 || threads == 1) {
    for (int i = 0; i < n; ++i) body(i);
    return;
  }
  // More threads than cores are allowed when asked for (results must not depend on it).
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<size_t>(threads));
  const auto loop = [&] {
    tbb::parallel_for(
        0, n,
        [&](int i) {
          const InBody marked;
          body(i);
        },
        tbb::simple_partitioner());
  };
  if (in_body && tbb::this_task_arena::max_concurrency() == threads) {
    // Whoever waits for these must not take up what is around them meanwhile.
    tbb::this_task_arena::isolate(loop);
    return;
  }
  TakenArena arena(threads);
  (*arena).execute(loop);
}
#else
void parallel_for(int n, int, const std::function<void(int)>& body) {
  for (int i = 0; i < n; ++i) body(i);
}
#endif

}  // namespace gnomon
