// Where a time zone is at home: to notice a place that does not go with its clock.
#pragma once

#include <optional>
#include <string>

#include <gnomon/core/place.h>

namespace gnomon {

// The place that the time zone database names for an IANA zone, mostly its largest town ("Europe/
// Vienna": Vienna); height 0. Nothing for UTC, solar, former names of zones ("Asia/Calcutta"),
// unknown ones, and where this machine has no zone.tab.
std::optional<Place> zone_reference(const std::string& zone);

}  // namespace gnomon
