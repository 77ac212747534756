// How high a footprint is, from its attributes: see docs/footprints.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/io/footprint_file.h>
#include <gnomon/io/footprint_layer.h>

namespace gnomon {

struct FootprintHeights {
  double from = 0, to = 0;     // metres above the base, 0 <= from < to
  std::optional<double> base;  // absolute, metres; empty: the ground
};

struct HeightAnswer {
  std::optional<FootprintHeights> heights;
  std::string problem;  // why there are none: "height is \"tall\""; empty: no attribute at all
};

// Attributes that are looked for, in lower case, in the order of preference.
struct FootprintAttributes {
  std::vector<std::string> height, floors, base;
  explicit FootprintAttributes(const FootprintOptions& options);
  // All that heights_of() and the rules for OpenStreetMap's tags look at.
  std::vector<std::string> all() const;
};

HeightAnswer heights_of(const FootprintFeature& feature, const FootprintAttributes& names,
                        double floor_height);

// The value of an attribute, without spaces around it; empty where there is none.
std::string_view value_of(const FootprintFeature& feature, std::string_view name);

}  // namespace gnomon
