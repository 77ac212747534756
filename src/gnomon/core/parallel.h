// Work in parallel: the only place that knows of threads.
#pragma once

#include <functional>

namespace gnomon {

// Calls body(i) for i in [0, n), on up to `threads` threads (0: as many as the machine has).
// Iterations may run in any order and at the same time; the call returns when all are done.
// Exceptions from body are passed on.
void parallel_for(int n, int threads, const std::function<void(int)>& body);

}  // namespace gnomon
