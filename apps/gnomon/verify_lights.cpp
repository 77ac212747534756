#include "verify_lights.h"

#include <cmath>
#include <sstream>
#include <vector>

#include <gnomon/core/exact.h>

#include "commands.h"

namespace gnomon::app {

NamedLight parse_light(const std::string& text) {
  const auto wrong = [&] {
    return Failure("--light " + text +
                   ": expected X,Y,Z[,sun|point], e.g. 0.3,-0.5,0.4 or 10,20,35.5,point");
  };
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (parts.size() < 3 || parts.size() > 4) throw wrong();
  const bool is_point = parts.size() == 4 && parts[3] == "point";
  if (parts.size() == 4 && !is_point && parts[3] != "sun") throw wrong();
  Vec3 v(0.0);
  for (int k = 0; k < 3; ++k) {
    const std::string& part = parts[static_cast<std::size_t>(k)];
    std::size_t used = 0;
    try {
      v[k] = std::stod(part, &used);
    } catch (const std::exception&) {
      throw wrong();
    }
    if (used != part.size() || !std::isfinite(v[k]) || std::fabs(v[k]) > kLargestCoordinate)
      throw wrong();
  }
  const Light light = snapped(is_point ? point(v) : direction(v));
  if (light == Light(0.0)) throw Failure("--light " + text + ": a direction must not be zero");
  return {text, light};
}

}  // namespace gnomon::app
