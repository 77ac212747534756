// Frames of an MD2 file, of which Assimp hands over one.
// Based on: id Software, Quake II source code (qfiles.h), 2001.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/result.h>
#include <gnomon/io/rig.h>

namespace gnomon {

// Quake II's clock: its server sends ten frames a second, and models are made for that.
inline constexpr double kFramesPerSecond = 10;

struct KeyFrames {
  std::vector<std::string> names;         // of the animations, as animation_names() has them
  std::vector<RigClip> clips;             // likewise
  std::vector<std::size_t> first;         // likewise: the first frame
  std::vector<std::vector<Vec3>> points;  // per frame, per vertex of the file
  std::vector<std::array<std::size_t, 3>> triangles;  // vertices of the file

  // The frames of an animation over the vertices that Assimp makes: three to a triangle. Normals
  // are those of smooth surfaces: the mean of the triangles around a vertex, by their areas.
  std::vector<RigShape> shapes(std::size_t animation, bool normals) const;
};

// Frames follow each other in an animation as long as their names are equal up to the digits at the
// end: one or two of them count the frame, more belong to the name ("pain101" is frame 01 of
// "pain1"). Errors: cut off.
Result<KeyFrames> read_md2_frames(std::string_view bytes, const std::string& path);

}  // namespace gnomon
