// Scenes like the three that the second paper measured its silhouettes on: Geometry of shadows in
// real time, section 8, Tables 1 and 2 and Figures 5 to 7. The originals are not published: these
// have their numbers of triangles and casters, their latitudes and what the Figures name, and are
// otherwise our own.
//
// All are welded, metres, z up and around the origin, on a level ground at z = 0, the same at every
// call, with a colour for each material. No two triangles are the same, none has zero area, and
// bodies share no vertices. Bodies are closed and wound outwards. But a closed body has an even
// number of triangles, and two of the paper's numbers of casters are odd, so that not everything
// was closed there either: here gusset plates, signs and canopies are open, as architects' files
// have them, and objects of their own. The level ground is open too. Longitudes are ours.
#pragma once

#include <cstddef>

#include <gnomon/scene/scene.h>

namespace gnomon::scenes {

struct PaperCounts {
  std::size_t triangles, casting;  // of the first columns of Tables 1 and 2
};
inline constexpr PaperCounts kLatticeTower{11353, 11155};
inline constexpr PaperCounts kIndustryArea{13615, 13585};
inline constexpr PaperCounts kOfficeBuilding{182038, 147296};  // facade and concrete

// Figure 6, in the spirit of the Eiffel Tower: 300 m high, four curved legs of lattice that join,
// arches, three platforms, a mast, at 48.8 N 2.3 E. Objects: "ground" (receives only), "masonry",
// "leg_1" to "leg_4", "shaft", "arches", "platform_1" to "platform_3", "mast", and the open
// "gussets".
Scene lattice_tower();

// Figure 5: halls with saw-tooth roofs, silos, tanks, chimneys, a cooling tower, pipe bridges, a
// conveyor, sheds, at 45.2 N 9.2 E. Objects: "ground" (receives only) and one or more for each of
// these ("hall_1", "silos", ...); "signs" and "canopies" are open.
Scene industry_area();

// What casts; everything receives.
enum class OfficeCasters { facade_and_concrete, all };

// Figure 7, a curved tower on a podium like Hollein's proposal for Uniqa, at 48.2 N 16.4 E. One
// object for each structural component, so that a caller can choose: "concrete" (core, slabs,
// columns), "facade" (mullions, panels, louvres), "glass", "interior", which are groups and
// materials of the same names, and "ground" (materials "paving" and "water"). All bodies are
// closed.
Scene office_building(OfficeCasters casters);

}  // namespace gnomon::scenes
