// The sun-path diagram: where in the sky the sun stands through the days of a study, as SVG.
//
// Projection: equidistant zenithal. The zenith is the centre, the horizon the circle of radius 1,
// and the distance from the centre is (90 degrees - altitude) / 90 degrees. True north is up and
// east at the right, as on a map (not as seen looking up). Altitudes are apparent: with refraction.
#pragma once

#include <string>
#include <vector>

#include <gnomon/core/place.h>
#include <gnomon/core/result.h>
#include <gnomon/core/vec.h>
#include <gnomon/profile/study_times.h>
#include <gnomon/sun/sun.h>

namespace gnomon {

// x to the right (east), y down (south), the horizon at distance 1. `azimuth` from true north,
// `altitude` above the horizon; radians.
Vec2 sun_path_point(double azimuth, double altitude);

// A stretch of time with the sun's centre above the horizon.
struct SkyArc {
  std::vector<Vec2> points;  // as sun_path_point, in the order of time, every few minutes
  Instant begin, end;
  bool closed = false;  // the sun is up all the while, a day of solar time: the end meets the
                        // beginning (but for the change of declination in a day, 0.4 degrees at
                        // most)
};

// The parts of begin..end in which the sun is up, cut at the horizon; none: it stays down. A time
// up of less than the step of 4 minutes may be missed: the sun then climbs less than 0.01 degrees.
// Precondition: begin < end.
std::vector<SkyArc> sky_arcs(Instant begin, Instant end, const Place& place,
                             const Atmosphere& air = {});

// The same for the 24 h around the transit nearest to `noon`; midnight sun gives one closed arc.
std::vector<SkyArc> day_arcs(Instant noon, const Place& place, const Atmosphere& air = {});

struct SunPathDay {
  std::string label;              // "18 September 2024"
  Instant begin, end;             // the study's window, drawn thick; begin < end
  std::vector<TimeSample> steps;  // dots; those with the sun down are left out
};

struct SunPath {
  Place place;
  double true_north = 0;  // as Frame::true_north, radians: the grid's north is marked on the rim
                          // where it is half a degree or more off
  std::string zone;       // of the hour marks: as in time_zone.h
  Atmosphere air = {};
  std::vector<SunPathDay> days;
};

// An <svg> element for a page or, alone, a file: every size follows from its viewBox, 400 units
// wide. Each day's arc has marks at the full hours of the zone's clock; grey arcs are those of the
// solstices and the March equinox in the year of the first day. What stays below the horizon is
// said in the legend. Errors: as utc_to_clock; no day, a window that does not end after it begins.
Result<std::string> sun_path_svg(const SunPath& path);

}  // namespace gnomon
