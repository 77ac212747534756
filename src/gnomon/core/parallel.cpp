#include <gnomon/core/parallel.h>

#ifdef GNOMON_HAVE_TBB
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace gnomon {

#ifdef GNOMON_HAVE_TBB
void parallel_for(int n, int threads, const std::function<void(int)>& body) {
  if (threads <= 0) threads = tbb::info::default_concurrency();
  if (n <= 1 || threads == 1) {
    for (int i = 0; i < n; ++i) body(i);
    return;
  }
  // More threads than cores are allowed when asked for (results must not depend on it).
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        0, n, [&](int i) { body(i); }, tbb::simple_partitioner());
  });
}
#else
void parallel_for(int n, int, const std::function<void(int)>& body) {
  for (int i = 0; i < n; ++i) body(i);
}
#endif

}  // namespace gnomon
