// Scenes like those that the papers were measured on, with their cameras and the ways of their
// lamps. None of the originals is published; what is known of each stands at its declaration.
#pragma once

#include <string>
#include <vector>

#include <gnomon/scene/scene.h>
#include <gnomon/view/view.h>

namespace gnomon::scenes {

struct Lamp {
  Vec3 at{0, 0, 0};      // scene coordinates, metres
  Vec3 colour{1, 1, 1};  // of its light
};

struct PaperScene {
  std::string name;  // as on the command line
  std::string what;  // a clause for tables
  Scene scene;       // the floor (and walls) only receive; every other surface is a closed body
  Vec3 eye{0, 0, 0}, target{0, 0, 0};
  double fov = 0.8;  // vertical, radians
};

View view_of(const PaperScene& scene, int width, int height);

// Figure 6 and Table 2 of Roettger, Irion and Ertl, Shadow Volumes Revisited, 2002: an animation of
// a scene, shown with a shadow mask of full and of half resolution. All that the text says: convex
// bodies take one volume each; Figure 3 has a cylinder and a rectangle over a ground floor; without
// shadows 256 and 512 pixels squared take the same time (90 and 89 frames a second), so the scene
// is bound by its triangles there, not by pixels. Here: 64 small convex bodies (cylinders, tilted
// plates, spheres, cones) standing on a floor or above it, 8 386 triangles.
PaperScene convex_bodies();

// The same floor, camera and lamp with bodies that a view ray enters more than once: rings, gears,
// stairs, L-shaped houses. The paper's clamp at 1 loses their counts.
PaperScene concave_bodies();

// Figure 4 of Everitt and Kilgard, Practical and Robust Stenciled Shadow Volumes, 2002: game
// characters in a game-like room, by 3 coloured lamps (34 frames a second at 640 x 480 on a
// GeForce4 Ti 4600, more than 80 by 1 lamp) and by 12 clustered ones (8). Here: six figures, turned
// bodies with arms, between pillars in a corner of a room.
PaperScene figures_in_a_room();

// Phase 0 <= phase < 1 of the lamp's round over convex_bodies() and concave_bodies(). It circles
// the bodies, high when it is on the eye's side and low when it is behind them: then the volumes
// run towards the eye and sweep over the whole picture, and frames take longest.
Lamp lamp_on_its_round(double phase);

// 1 or 3 lamps that circle in the room, white or red, green and blue; or 12 that share one round,
// 0.25 m around its point. Precondition: count is 1, 3 or 12.
std::vector<Lamp> lamps_of_the_room(int count, double phase);

}  // namespace gnomon::scenes
