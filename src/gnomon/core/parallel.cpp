#include <gnomon/core/parallel.h>

#ifdef GNOMON_HAVE_TBB
#include <memory>

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
// longer than the one before. So a thread keeps its last one.
struct KeptArena {
  int threads = 0;
  std::unique_ptr<tbb::task_arena> arena;
};
thread_local KeptArena kept;
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
  if (in_body) {  // Whoever waits for these must not take up what is around them meanwhile.
    if (tbb::this_task_arena::max_concurrency() == threads) {
      tbb::this_task_arena::isolate(loop);
    } else {
      tbb::task_arena(threads).execute(loop);
    }
    return;
  }
  if (kept.threads != threads) {
    kept.arena = std::make_unique<tbb::task_arena>(threads);
    kept.threads = threads;
  }
  kept.arena->execute(loop);
}
#else
void parallel_for(int n, int, const std::function<void(int)>& body) {
  for (int i = 0; i < n; ++i) body(i);
}
#endif

}  // namespace gnomon
