// What captions and the terminal say of a study.
#pragma once

#include <string>

#include <gnomon/profile/study_times.h>

namespace gnomon::app {

// "18 September 2024, 09:00 - 17:00 Europe/Vienna"; of a range "1 April 2024 - 30 September 2024,
// every 7th day, sunrise - sunset Europe/Vienna".
std::string window_text(const StudyTimes& times, const Samples& samples, const Place& place);

// "8 steps of 1h"; of a range "mean per day over 27 days, 324 steps of 1h".
std::string steps_text(const StudyTimes& times, const Samples& samples);

// "12 shadows laid over each other, at the ends of the steps (2 of 14 are night)": `shown` of the
// study's instants in view.png, see picture_lights.h.
std::string overlay_text(const Samples& samples, int shown);

// The folder of one study of several: the date as typed, with '_' for the '/' that a name cannot
// hold.
std::string folder_name(const std::string& date);

}  // namespace gnomon::app
