// Everything that users of the library usually need; io (load_scene, write_*) is included where it
// is built.
#pragma once

#include <gnomon/core/exact.h>
#include <gnomon/core/vec.h>
#include <gnomon/profile/profile.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/raster/count_shadows.h>
#include <gnomon/raster/visible_surfaces.h>
#include <gnomon/scene/scene.h>
#include <gnomon/shadow/cast_shadows.h>
#include <gnomon/sun/sun.h>
#include <gnomon/view/view.h>
#include <gnomon/volume/shadow_volume.h>

#ifdef GNOMON_HAVE_IO
#include <gnomon/io/load_scene.h>
#include <gnomon/io/write_geotiff.h>
#endif
