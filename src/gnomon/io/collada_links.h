// Instances in a Collada text whose geometry, controller or node is not in it: Assimp leaves them
// out without a word.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gnomon {

struct BrokenLinks {
  std::size_t count = 0;
  std::string first;  // for a message: <instance_node url="#tower">
};

// Looks at the names of elements and at their attributes alone. `xml` need not be well-formed.
BrokenLinks broken_links_of_collada(std::string_view xml);

}  // namespace gnomon
