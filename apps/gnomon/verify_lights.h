// Lights that verify and verify-gl take from the command line.
#pragma once

#include <string>

#include <gnomon/trace/verification_cases.h>

namespace gnomon::app {

// "X,Y,Z[,sun|point]" in scene coordinates. Throws Failure.
NamedLight parse_light(const std::string& text);

}  // namespace gnomon::app
