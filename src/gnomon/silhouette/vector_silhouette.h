// find_silhouette() of silhouette.h, many edges at a time. The same result.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// `out` is replaced; ordered as in the EdgeTable. `sides`: light_sides() of the mesh that `edges`
// was built from. More than one thread (0: all) pays from some 20 000 edges on, and takes memory
// for another copy of the result meanwhile.
void find_silhouette_in_vectors(Silhouette& out, const EdgeTable& edges,
                                const std::vector<std::int8_t>& sides, int threads = 1);

}  // namespace gnomon
