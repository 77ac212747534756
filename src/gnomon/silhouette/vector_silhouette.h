// find_silhouette() of silhouette.h, many edges at a time. The same result.
#pragma once

#include <cstdint>
#include <vector>

#include <gnomon/silhouette/silhouette.h>

namespace gnomon {

// `out` is replaced; ordered as in the EdgeTable. `sides`: light_sides() of the mesh that `edges`
// was built from.
void find_silhouette_in_vectors(Silhouette& out, const EdgeTable& edges,
                                const std::vector<std::int8_t>& sides);

}  // namespace gnomon
