#include <gnomon/core/lower_case.h>
#include <gnomon/io/assimp_formats.h>

#include <array>

namespace gnomon {
namespace {

using enum MeshReader;

// Not taken although Assimp has readers for them: .dxf (3D solids are skipped without a word),
// .blend (modifiers are, and files newer than 2.8 fail), .raw, .xml, .prj, .3d, .step (these
// extensions mostly mean something else), .ase, .x3d (any text is read, and a file that is cut off
// as if it were whole), motion and terrain formats, and all that keeps a model in several files.
constexpr std::array<MeshFormat, 20> kFormats = {{
    {".gltf", "glTF", "", kGltf, UpAxis::kStated, true, 1.0},
    {".glb", "GLB", "", kGltf, UpAxis::kStated, true, 1.0},
    {".stl", "STL", "", kStl, UpAxis::kZ, false, 1.0},
    {".ply", "PLY", "", kPly, UpAxis::kZ, false, 1.0},
    {".off", "OFF", "", kOff, UpAxis::kZ, false, 1.0},
    {".dae", "Collada", "Collada", kDae, UpAxis::kStated, true, 1.0},
    {".zae", "Collada", "Collada", kAssimp, UpAxis::kStated, true, 1.0},
    {".fbx", "FBX", "Autodesk FBX", kFbx, UpAxis::kStated, true, 0.01},
    {".ifc", "IFC", "Industry Foundation Classes", kIfc, UpAxis::kStated, true, 1.0},
    {".3ds", "3DS", "Discreet 3DS", kAssimp, UpAxis::kZTurned, false, 1.0},
    {".md2", "MD2", "Quake II", kAssimp, UpAxis::kZTurned, false, 1.0},
    {".md3", "MD3", "Quake III", kAssimp, UpAxis::kZTurned, false, 1.0},
    {".md5mesh", "MD5", "Doom 3", kAssimp, UpAxis::kZTurned, false, 1.0},
    {".smd", "SMD", "Valve SMD", kAssimp, UpAxis::kZ, false, 1.0},
    {".3mf", "3MF", "3mf", kAssimp, UpAxis::kZ, false, 0.001},
    {".amf", "AMF", "Additive manufacturing", kAssimp, UpAxis::kZ, false, 0.001},
    {".x", "DirectX", "Direct3D", kAssimp, UpAxis::kY, false, 1.0},
    {".lwo", "LightWave", "LightWave/Modo", kAssimp, UpAxis::kY, false, 1.0},
    {".b3d", "Blitz3D", "BlitzBasic", kAssimp, UpAxis::kY, false, 1.0},
    {".ms3d", "MilkShape 3D", "Milkshape", kAssimp, UpAxis::kY, false, 1.0},
}};

}  // namespace

const MeshFormat* mesh_format(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  for (const MeshFormat& f : kFormats) {
    if (extension == f.extension) return &f;
  }
  return nullptr;
}

}  // namespace gnomon
