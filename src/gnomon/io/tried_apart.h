// Work on untrusted files by code that may crash, hang or take all memory, tried out first in a
// process of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace gnomon {

struct TrialLimits {
  std::uint64_t seconds;  // of processor time
  std::uint64_t bytes;    // of address space, beyond what this process has; not kept to under
                          // AddressSanitizer, which needs all of it
};

// Runs `work` in a forked child and returns what it returned, at most 4000 bytes of it: "" by
// convention if all went well. Where the child crashes, or reaches a limit, the result says so
// ("its reader crashes on it"). What the child prints is not seen; nothing that it changes in
// memory outlives it. `work` may use the heap, but no other threads. Then the same work, which is
// to be deterministic, can be done here.
std::string tried_apart(const std::function<std::string()>& work, const TrialLimits& limits);

}  // namespace gnomon
