// Which mesh formats are taken by their extension, and what must be known of each of them.
#pragma once

#include <filesystem>
#include <vector>

namespace gnomon {

// Who reads it. Only kAssimp and kIfc, kDae, kFbx, which need a word of their own, go to Assimp.
enum class MeshReader { kGltf, kStl, kPly, kOff, kAssimp, kDae, kFbx, kIfc };

// Where the up axis of a format comes from. Assimp hands a scene over with y up or as it is in the
// file; found out with files of each format whose up axis is known.
enum class UpAxis {
  kStated,   // by the file or its format's specification; with y up from Assimp, but for FBX
  kY,        // not stated, usually y; as in the file
  kZ,        // not stated, usually z; as in the file
  kZTurned,  // not stated, usually z; Assimp turns it to y up, always
};

struct MeshFormat {
  const char* extension;  // lower case, with the dot
  const char* name;       // for people
  const char* importer;   // how aiImporterDesc::mName starts; empty where Assimp takes no part
  MeshReader reader;
  UpAxis up;
  bool unit_stated;  // by the file or its format's specification
  double unit;       // metres per unit of what the reader hands over, where nothing else is asked
};

// Nothing where the extension (of any case) is none of them.
const MeshFormat* mesh_format(const std::filesystem::path& path);

}  // namespace gnomon
