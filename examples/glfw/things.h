// What is drawn: some boxes on a ground, one of which moves, as does the lamp.
#pragma once

#include <cmath>
#include <vector>

#include <gnomon/gnomon.h>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

inline gnomon::TriMesh box(const gnomon::Vec3& size) {  // on the ground, wound outwards
  gnomon::TriMesh m;
  for (int k = 0; k < 8; ++k)  // bit 0 chooses x, bit 1 y, bit 2 z
    m.positions.push_back(
        {size.x * ((k & 1) - 0.5), size.y * (((k >> 1) & 1) - 0.5), size.z * (k >> 2)});
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

struct Thing {
  gnomon::TriMesh mesh;
  glm::dmat4 place;
};

inline std::vector<Thing> things() {
  const auto at = [](double x, double y, double z) {
    return glm::translate(glm::dmat4(1.0), {x, y, z});
  };
  return {{box({2, 2, 1}), at(0, 0, 3)},  // moves: flight_of()
          {box({40, 40, 1}), at(0, 0, -1)},
          {box({4, 3, 5}), at(-5, 2, 0)},
          {box({3, 6, 2}), at(4, 4, 0)},
          {box({1, 1, 7}), at(3, -5, 0)}};
}

inline glm::dmat4 flight_of(int frame) {
  const double turn = 0.01 * frame;
  return glm::rotate(glm::translate(glm::dmat4(1.0), {4 * std::sin(turn), -1, 3.5}), 3 * turn,
                     glm::dvec3(0.3, 0.2, 1));
}

inline gnomon::Light lamp_of(int frame) {
  const double turn = 0.02 * frame;
  return gnomon::point({9 * std::cos(turn), 9 * std::sin(turn), 12});
}

// As an engine has it: scene to clip space, the far plane at infinity.
inline glm::dmat4 view_matrix(int width, int height) {
  return glm::infinitePerspective(0.8, double(width) / height, 0.5) *
         glm::lookAt(glm::dvec3(14, -20, 16), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1));
}
