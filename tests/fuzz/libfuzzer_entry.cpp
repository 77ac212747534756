// libFuzzer's side of a target; built once per target, whose name is GNOMON_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.h"

// What a target throws ends the process, which libFuzzer takes for a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gnomon::fuzz::GNOMON_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
