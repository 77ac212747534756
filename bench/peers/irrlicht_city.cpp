// The box city drawn by Irrlicht 1.8 with its stencil shadow volumes, timed.
//
// Irrlicht is left-handed and its OBJ reader mirrors x: camera and lamp are mirrored with the
// model, so that the picture is not. How it is used, and why: bench/README.md.

// Irrlicht's XML reader is not valid C++20 (it repeats a template's arguments at its constructor):
// of it only this name is needed.
#define __IRR_XML_H_INCLUDED__
namespace irr::io {
template <class Char, class Base>
class IIrrXMLReader;
}
#include <irrlicht.h>

#include <GL/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "../report.h"
#include "city_view.h"

namespace gnomon::bench {
namespace {

using irr::core::vector3df;

struct Options {
  std::string boxes, ground;
  int size = 512;
  std::string method = "zpass";
  std::string volumes = "box";
  double infinity = 0;  // metres; 0: as short as the ground allows
  int rounds = 4, frames = 25;
  std::string picture, json;
  bool unshadowed = false;
  int picture_frame = -1;  // of the moving lamp; -1: the still lamp
};

struct Drop {
  void operator()(irr::IReferenceCounted* p) const { p->drop(); }
};
template <class T>
using Owned = std::unique_ptr<T, Drop>;

template <class T>
T* there(T* p, const std::string& what) {
  if (p == nullptr) throw std::runtime_error(what);
  return p;
}

vector3df mirrored(const Vec3& p) {
  return {static_cast<float>(-p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

irr::video::SColorf grey(double part) {
  const float f = static_cast<float>(part);
  return {f, f, f};
}

// Appends the triangles of `from`, moved by -origin.
void append(irr::scene::SMeshBuffer& to, const irr::scene::IMeshBuffer& from,
            const vector3df& origin) {
  const auto* first = static_cast<const irr::video::S3DVertex*>(from.getVertices());
  std::vector<irr::video::S3DVertex> vertices(first, first + from.getVertexCount());
  for (auto& v : vertices) v.Pos -= origin;
  to.append(vertices.data(), from.getVertexCount(), from.getIndices(), from.getIndexCount());
  to.recalculateBoundingBox();
}

Owned<irr::scene::SMesh> mesh_of(irr::scene::SMeshBuffer* buffer) {
  Owned<irr::scene::SMesh> mesh(new irr::scene::SMesh);
  mesh->addMeshBuffer(buffer);
  mesh->recalculateBoundingBox();
  return mesh;
}

// How far beyond a box's vertices the volume must reach to be below the ground, for the lamp still
// and moving. What reaches below the ground behind it is never seen, but costs pixels.
float reach(const irr::scene::IMeshBuffer& box) {
  std::vector<vector3df> lamps = {mirrored(kLamp)};
  for (int k = 0; k < kLampFrames; ++k) lamps.push_back(mirrored(moving_lamp(k)));
  float longest = 0;
  for (irr::u32 i = 0; i < box.getVertexCount(); ++i) {
    const vector3df& v = box.getPosition(i);
    for (const vector3df& lamp : lamps) {
      const vector3df ray = v - lamp;
      longest = std::max(longest, v.Z / (lamp.Z - v.Z) * ray.getLength());
    }
  }
  return 1.01f * longest + 1;
}

class City {
 public:
  explicit City(const Options& o) : o_(o) {
    irr::SIrrlichtCreationParameters p;
    p.DriverType = irr::video::EDT_OPENGL;
    const auto size = static_cast<irr::u32>(o.size);
    p.WindowSize = {size, size};
    p.Stencilbuffer = true;
    p.AntiAlias = 0;
    p.Vsync = false;
    p.LoggingLevel = irr::ELL_ERROR;
    device_.reset(there(irr::createDeviceEx(p), "Irrlicht opens no window; is there an X server?"));
    scene_ = device_->getSceneManager();
    driver_ = device_->getVideoDriver();
    if (!driver_->queryFeature(irr::video::EVDF_STENCIL_BUFFER)) {
      throw std::runtime_error("Irrlicht has got no stencil buffer; give Xvfb a depth of 24 bits.");
    }
    if (driver_->getScreenSize() != p.WindowSize) {
      throw std::runtime_error("The window is smaller than asked for; make Xvfb's screen larger.");
    }
    scene_->getParameters()->setAttribute(irr::scene::OBJ_LOADER_IGNORE_MATERIAL_FILES, true);
    read_models();
    add_camera_and_lamp();
    live_ = add_volumes();
    kept_ = add_volumes();
    show(Shadows::kept);
    frame(kLamp);  // makes the volumes that are kept
    keep_volumes();
  }

  enum class Shadows { none, live, kept };
  void show(Shadows shadows) {
    live_->setVisible(shadows == Shadows::live);
    kept_->setVisible(shadows == Shadows::kept);
  }

  // Milliseconds from the empty to the whole picture; that it is shown is not timed.
  double frame(const Vec3& lamp) {
    device_->run();
    const Watch watch;
    draw_frame(lamp);
    const double ms = 1000 * watch.seconds();
    driver_->endScene();
    return ms;
  }

  // The picture of that lamp, as it is before it is shown: of the window itself, X
  // servers keep only what they like.
  void write_picture(const std::string& path, Shadows shadows, const Vec3& lamp) {
    show(shadows);
    frame(lamp);
    draw_frame(lamp);
    const irr::core::dimension2du size = driver_->getScreenSize();
    const Owned<irr::video::IImage> image(driver_->createImage(irr::video::ECF_R8G8B8, size));
    std::vector<std::uint8_t> rgb(std::size_t{3} * size.Width * size.Height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_BACK);
    glReadPixels(0, 0, o_.size, o_.size, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    driver_->endScene();
    for (irr::u32 y = 0; y < size.Height; ++y) {  // OpenGL's first row is the lowest
      for (irr::u32 x = 0; x < size.Width; ++x) {
        const std::uint8_t* c = &rgb[std::size_t{3} * (y * size.Width + x)];
        image->setPixel(x, size.Height - 1 - y, irr::video::SColor(255, c[0], c[1], c[2]));
      }
    }
    if (!driver_->writeImageToFile(image.get(), path.c_str())) {
      throw std::runtime_error("Cannot write " + path);
    }
  }

  int boxes() const { return static_cast<int>(boxes_->getMeshBufferCount()); }
  std::string version() const { return device_->getVersion(); }

 private:
  void draw_frame(const Vec3& lamp) {
    lamp_->setPosition(mirrored(lamp));
    driver_->beginScene(true, true, irr::video::SColor(255, 0, 0, 0));
    scene_->drawAll();
    glFinish();
  }

  irr::scene::IMesh* read(const std::string& path) {
    return there(there(scene_->getMesh(path.c_str()), "Irrlicht does not read " + path)->getMesh(0),
                 "There is nothing in " + path);
  }

  // One buffer with flat normals, in the graphics memory.
  void draw(irr::scene::IMesh* mesh, const irr::video::SColor& colour) {
    auto* manipulator = scene_->getMeshManipulator();
    Owned<irr::scene::SMeshBuffer> all(new irr::scene::SMeshBuffer);
    for (irr::u32 k = 0; k < mesh->getMeshBufferCount(); ++k) {
      append(*all, *mesh->getMeshBuffer(k), {});
    }
    const Owned<irr::scene::SMesh> joined = mesh_of(all.get());
    const Owned<irr::scene::IMesh> apart(manipulator->createMeshUniquePrimitives(joined.get()));
    manipulator->recalculateNormals(apart.get(), false);
    const Owned<irr::scene::IMesh> welded(manipulator->createMeshWelded(apart.get()));
    manipulator->setVertexColors(welded.get(), colour);
    welded->setHardwareMappingHint(irr::scene::EHM_STATIC);
    irr::scene::IMeshSceneNode* node = scene_->addMeshSceneNode(welded.get());
    irr::video::SMaterial& material = node->getMaterial(0);
    material.ColorMaterial = irr::video::ECM_DIFFUSE_AND_AMBIENT;
    material.AntiAliasing = irr::video::EAAM_OFF;
  }

  void read_models() {
    boxes_ = read(o_.boxes);
    draw(boxes_, {255, 214, 205, 190});
    draw(read(o_.ground), {255, 170, 178, 165});
  }

  void add_camera_and_lamp() {
    const CityCamera view;
    irr::scene::ICameraSceneNode* camera =
        scene_->addCameraSceneNode(nullptr, mirrored(view.eye), mirrored(view.target));
    camera->setUpVector(mirrored(view.up));
    camera->setFOV(static_cast<float>(view.fov));
    camera->setAspectRatio(1);
    camera->setNearValue(static_cast<float>(view.near_plane));
    camera->setFarValue(static_cast<float>(view.far_plane));
    scene_->setAmbientLight(grey(kAmbient));
    scene_->setShadowColor({static_cast<irr::u32>(255 * (1 - kAmbient)), 0, 0, 0});
    lamp_ = scene_->addLightSceneNode(nullptr, mirrored(kLamp), grey(1 - kAmbient));
    irr::video::SLight light = lamp_->getLightData();
    light.Radius = 1e5f;  // metres; farther ones cast no shadow
    light.Attenuation = {1, 0, 0};
    lamp_->setLightData(light);
    lamp_->setAutomaticCulling(irr::scene::EAC_OFF);
  }

  // The origin of the volume's node that the box belongs to. Irrlicht 1.8 takes the lamp's position
  // in the node's frame for the direction towards it: signs of faces are right only where the
  // origin is as good as the face itself.
  vector3df origin_of(const irr::scene::IMeshBuffer& box) const {
    vector3df c = box.getBoundingBox().getCenter();
    c.Z = 0;
    if (o_.volumes == "box") return c;
    if (o_.volumes == "city") return {};
    const float quarter = static_cast<float>(scenes::kBoxCityHalf / 2);
    return {std::copysign(quarter, c.X), std::copysign(quarter, c.Y), 0};
  }

  // Shadow volumes hang on nodes with a mesh that draws nothing: so they have origins and meshes of
  // their own, and all boxes are still drawn by one call.
  irr::scene::ISceneNode* add_volumes() {
    struct Part {
      Owned<irr::scene::SMeshBuffer> mesh{new irr::scene::SMeshBuffer};
      float reach = 0;
    };
    std::map<std::pair<float, float>, Part> parts;
    for (irr::u32 k = 0; k < boxes_->getMeshBufferCount(); ++k) {
      const irr::scene::IMeshBuffer& box = *boxes_->getMeshBuffer(k);
      const vector3df origin = origin_of(box);
      Part& part = parts[{origin.X, origin.Y}];
      append(*part.mesh, box, origin);
      part.reach = std::max(part.reach, reach(box));
    }
    Owned<irr::scene::SMeshBuffer> nothing(new irr::scene::SMeshBuffer);
    nothing->Material.Lighting = false;
    const Owned<irr::scene::SMesh> empty = mesh_of(nothing.get());
    irr::scene::ISceneNode* all = scene_->addEmptySceneNode();
    for (const auto& [xy, part] : parts) {
      irr::scene::IMeshSceneNode* node =
          scene_->addMeshSceneNode(empty.get(), all, -1, {xy.first, xy.second, 0});
      node->setAutomaticCulling(irr::scene::EAC_OFF);
      node->addShadowVolumeSceneNode(
          mesh_of(part.mesh.get()).get(), -1, o_.method == "zfail",
          o_.infinity > 0 ? static_cast<float>(o_.infinity) : part.reach);
    }
    all->setAutomaticCulling(irr::scene::EAC_OFF);
    return all;
  }

  // Irrlicht makes the volumes anew whenever it draws the node that they were made for; hung on
  // another one they stay as they are.
  void keep_volumes() {
    irr::scene::ISceneNode* all = scene_->addEmptySceneNode();
    for (irr::scene::ISceneNode* node : kept_->getChildren()) {
      irr::scene::ISceneNode* keeper = scene_->addEmptySceneNode(all);
      keeper->setPosition(node->getPosition());
      (*node->getChildren().begin())->setParent(keeper);
    }
    all->setAutomaticCulling(irr::scene::EAC_OFF);
    kept_->remove();
    kept_ = all;
  }

  const Options& o_;
  Owned<irr::IrrlichtDevice> device_;
  irr::scene::ISceneManager* scene_ = nullptr;
  irr::video::IVideoDriver* driver_ = nullptr;
  irr::scene::IMesh* boxes_ = nullptr;  // a buffer for each
  irr::scene::ILightSceneNode* lamp_ = nullptr;
  irr::scene::ISceneNode *live_ = nullptr, *kept_ = nullptr;
};

struct Case {
  std::string name;
  City::Shadows shadows;
  bool moving;
  std::vector<double> ms{};
};

void measure(City& city, const Options& o, std::vector<Case>& cases) {
  constexpr int kWarmUp = 3;                         // frames at the beginning of each turn
  for (int round = -1; round < o.rounds; ++round) {  // round -1 warms up
    for (Case& c : cases) {
      city.show(c.shadows);
      for (int k = -kWarmUp; k < o.frames; ++k) {
        const double ms =
            city.frame(c.moving ? moving_lamp(std::max(round, 0) * o.frames + k) : kLamp);
        if (round >= 0 && k >= 0) c.ms.push_back(ms);
      }
    }
  }
}

int run(const Options& o) {
  City city(o);
  const std::string gl = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (!o.picture.empty()) {
    city.write_picture(o.picture, o.unshadowed ? City::Shadows::none : City::Shadows::live,
                       o.picture_frame < 0 ? kLamp : moving_lamp(o.picture_frame));
  }
  std::vector<Case> cases = {{"none", City::Shadows::none, false},
                             {"still, volumes kept", City::Shadows::kept, false},
                             {"still", City::Shadows::live, false},
                             {"moving", City::Shadows::live, true}};
  measure(city, o, cases);
  nlohmann::ordered_json results = {{"program", "Irrlicht " + city.version()},
                                    {"gl", gl},
                                    {"boxes", city.boxes()},
                                    {"size", o.size},
                                    {"method", o.method},
                                    {"volumes", o.volumes},
                                    {"infinity", o.infinity}};
  for (Case& c : cases) {
    const double mean = std::accumulate(c.ms.begin(), c.ms.end(), 0.0) / double(c.ms.size());
    fmt::print("| Irrlicht {}, {}, one volume per {}, {} | {} | {} | {:.1f} | {:.1f} | {:.1f} |\n",
               city.version(), o.method, o.volumes,
               o.infinity > 0 ? fmt::format("{} m", o.infinity) : "to the ground", o.size, c.name,
               median(c.ms), *std::min_element(c.ms.begin(), c.ms.end()), mean);
    results["ms"][c.name] = c.ms;
  }
  if (!o.json.empty()) {
    std::ofstream out(o.json);
    out << results.dump() << std::endl;
    if (!out) throw std::runtime_error("Cannot write " + o.json);
  }
  return 0;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  gnomon::bench::Options o;
  CLI::App app{
      "The box city with Irrlicht's shadow volumes: rows of a Markdown table (picture's size, "
      "lamp, median, least and mean "
      "milliseconds per frame)"};
  app.add_option("BOXES", o.boxes, "OBJ with a group for each box")->required();
  app.add_option("GROUND", o.ground, "OBJ of the ground")->required();
  app.add_option("--size", o.size, "Pixels across and down")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--method", o.method, "Counting")
      ->check(CLI::IsMember({"zpass", "zfail"}))
      ->capture_default_str();
  app.add_option("--volumes", o.volumes,
                 "A volume for each box, each quarter of the city, or the city; only the first is "
                 "right for any lamp")
      ->check(CLI::IsMember({"box", "quarter", "city"}))
      ->capture_default_str();
  app.add_option("--infinity", o.infinity,
                 "Metres from a box to its volume's end (0: as few as needed to reach the ground)")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  app.add_option("--rounds", o.rounds, "Turns of each case")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--frames", o.frames, "Frames timed in each turn")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--picture", o.picture, "Write the picture to this PNG");
  app.add_flag("--unshadowed", o.unshadowed, "Leave the shadows out of it");
  app.add_option("--picture-frame", o.picture_frame,
                 "Of the moving lamp's frames, the picture's (-1: the still lamp)")
      ->capture_default_str();
  app.add_option("--json", o.json, "Write all times to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "peer_irrlicht: %s\n", e.what());
    return 1;
  }
}
