// Which triangle each pixel's ray meets first: the samples of a view.
#pragma once

#include <gnomon/core/exact.h>
#include <gnomon/scene/scene.h>
#include <gnomon/view/receivers.h>

namespace gnomon {

// The receivers of the scene as seen in the view. Exact: coverage and depth order are decided by
// view/predicates.h wherever floating point cannot; coplanar triangles over one pixel: the one with
// the lowest index. Preconditions: welded mesh; surface_of and surfaces filled (a scene made by
// hand has none by itself); view dimensions positive.
Receivers visible_surfaces(const Scene& scene, const View& view, int threads = 0,
                           ExactStats* stats = nullptr);

}  // namespace gnomon
