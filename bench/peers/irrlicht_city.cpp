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
#include <stdexcept>
#include <string>
#include <vector>

#include "city_frames.h"
#include "city_view.h"

namespace gnomon::bench {
namespace {

using irr::core::vector3df;

struct Options : FrameCommand {
  std::string boxes, ground;
  std::string method = "zpass";
  int block = 1;        // boxes across and deep that one volume is made of
  double infinity = 0;  // metres; 0: as short as the ground allows
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

// How far beyond a box's vertices its volume must reach to be below the ground, for all these
// lamps. What is farther below is never seen, but costs pixels.
float reach(const irr::scene::IMeshBuffer& box, const std::vector<vector3df>& lamps) {
  float longest = 0;
  for (irr::u32 i = 0; i < box.getVertexCount(); ++i) {
    const vector3df& v = box.getPosition(i);
    for (const vector3df& lamp : lamps)
      longest = std::max(longest, v.Z / (lamp.Z - v.Z) * (v - lamp).getLength());
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
    std::vector<vector3df> lamps = {mirrored(kLamp)};
    kept_ = add_volumes(lamps);
    for (int k = 0; k < kLampFrames; ++k) lamps.push_back(mirrored(moving_lamp(k)));
    live_ = add_volumes(lamps);
    show(Shadows::kept);
    frame(kLamp);  // makes the volumes that are kept
    keep_volumes();
  }

  enum class Shadows { none, live, kept };
  void show(Shadows shadows) {
    live_->setVisible(shadows == Shadows::live);
    kept_->setVisible(shadows == Shadows::kept);
  }

  // From the empty to the whole picture; that it is shown is not timed.
  FrameTime frame(const Vec3& lamp) {
    device_->run();
    const FrameWatch watch;
    draw_frame(lamp);
    const FrameTime time = watch.read();
    driver_->endScene();
    return time;
  }

  // The picture, as it is before it is shown (what the window keeps is up to the X server): three
  // bytes a pixel, row 0 at the top.
  std::vector<std::uint8_t> picture(Shadows shadows, const Vec3& lamp) {
    show(shadows);
    draw_frame(lamp);
    const auto row = 3 * static_cast<std::size_t>(o_.size);
    std::vector<std::uint8_t> upside_down(row * row / 3), rgb;
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_BACK);
    glReadPixels(0, 0, o_.size, o_.size, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
    driver_->endScene();
    for (auto end = upside_down.end(); end != upside_down.begin(); end -= std::ptrdiff_t(row))
      rgb.insert(rgb.end(), end - std::ptrdiff_t(row), end);
    return rgb;
  }

  void write_png(std::vector<std::uint8_t> rgb, const std::string& path) {
    const Owned<irr::video::IImage> image(driver_->createImageFromData(
        irr::video::ECF_R8G8B8, driver_->getScreenSize(), rgb.data(), true, false));
    if (!image || !driver_->writeImageToFile(image.get(), path.c_str())) {
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

  // The origin of the volume's node that the box belongs to: the middle of its block. Irrlicht 1.8
  // takes the lamp's position in the node's frame for the direction towards the lamp, from every
  // face: the sides that it finds are right only as far as the lamp lies the same way from the
  // origin.
  vector3df origin_of(const irr::scene::IMeshBuffer& box) const {
    const vector3df c = box.getBoundingBox().getCenter();
    const double block = o_.block * scenes::kBoxPitch, corner = scenes::kBoxCityHalf;
    const auto middle = [&](float x) {
      return static_cast<float>((std::floor((x + corner) / block) + 0.5) * block - corner);
    };
    return {middle(c.X), middle(c.Y), 0};
  }

  // Shadow volumes hang on nodes with a mesh that draws nothing: so they have origins and meshes of
  // their own, and all boxes are still drawn by one call.
  irr::scene::ISceneNode* add_volumes(const std::vector<vector3df>& lamps) {
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
      part.reach = std::max(part.reach, reach(box, lamps));
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

std::vector<FrameCase> measure(City& city, const Options& o) {
  const auto show = [&](City::Shadows shadows) { return [&city, shadows] { city.show(shadows); }; };
  const auto still = [](int) { return kLamp; };
  std::vector<FrameCase> cases = {{"no shadows", show(City::Shadows::none), still},
                                  {"lamp still, volumes kept", show(City::Shadows::kept), still},
                                  {"lamp still", show(City::Shadows::live), still},
                                  {"lamp moving", show(City::Shadows::live), moving_lamp}};
  measure(cases, o.rounds, o.frames, [&](const Vec3& lamp) { return city.frame(lamp); });
  return cases;
}

int run(const Options& o) {
  City city(o);
  if (!o.picture.empty()) {
    const Vec3 lamp = o.picture_frame < 0 ? kLamp : moving_lamp(o.picture_frame);
    city.write_png(city.picture(City::Shadows::live, lamp), o.picture);
  }
  const auto check = [&](City::Shadows shadows, const Vec3& lamp) {
    return check_city(city.picture(shadows, lamp), city.picture(City::Shadows::none, lamp), o.size,
                      lamp);
  };
  const FrameChecks checks{check(City::Shadows::kept, kLamp), check(City::Shadows::live, kLamp),
                           check(City::Shadows::live, moving_lamp(kMovedFrame))};
  const std::vector<FrameCase> cases = measure(city, o);

  const std::string what =
      fmt::format("{}, {} x {} boxes a volume, {}", o.method, o.block, o.block,
                  o.infinity > 0 ? fmt::format("{} m long", o.infinity) : "as long as needed");
  nlohmann::ordered_json results = {
      {"program", "Irrlicht " + city.version()},
      {"gl_renderer", reinterpret_cast<const char*>(glGetString(GL_RENDERER))},
      {"boxes", city.boxes()},
      {"size", o.size},
      {"method", o.method},
      {"block", o.block},
      {"infinity_m", o.infinity}};
  add_json(results, cases, checks);
  fmt::print("| {} | Irrlicht {} | {} |{}\n", o.size, city.version(), what,
             to_columns(cases, checks));
  if (!o.json.empty()) {
    std::ofstream out(o.json);
    out << results.dump(1) << std::endl;
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
      "median, least and processor's milliseconds per frame)"};
  app.add_option("BOXES", o.boxes, "OBJ with a group for each box")->required();
  app.add_option("GROUND", o.ground, "OBJ of the ground")->required();
  gnomon::bench::add_options(app, o);
  app.add_option("--method", o.method, "Counting")
      ->check(CLI::IsMember({"zpass", "zfail"}))
      ->capture_default_str();
  app.add_option("--block", o.block,
                 "Boxes across and deep that one volume is made of; more than 1 is right only for "
                 "lamps outside the streets' strips that the block lies in")
      ->check(CLI::IsMember({1, 2, 4, 5, 10, 20}))
      ->capture_default_str();
  app.add_option("--infinity", o.infinity,
                 "Metres from a box to its volume's end (0: as few as needed to reach the ground)")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return gnomon::bench::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "peer_irrlicht: %s\n", e.what());
    return 1;
  }
}
