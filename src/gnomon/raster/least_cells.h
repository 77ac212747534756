// The lowest nearness under any rectangle of the picture (LeastCells, view/receivers.h): made once
// per view, used for all lights.
#pragma once

#include <gnomon/scene/scene.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

// Of the nearness of receivers that lie on the scene's triangles. Stored nearness is taken for what
// it may be off by (Receivers::nearness); where it is unknown, its triangle's lowest corner is
// taken, or 0 in front of a camera.
LeastCells least_cells(const Scene& scene, const Receivers& receivers, int threads);

// No sample of the pixels [x0, x1] x [y0, y1] (cut to the picture) is less near. Looks at 16 cells
// at most.
double least_under(const LeastCells& cells, int x0, int x1, int y0, int y1);

}  // namespace gnomon
