// What a user gets wrong: an exit code, a message with the file, the element and what to do, and
// nothing written.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <vector>

#include <apps/program.h>
#include <io/write_limits.h>

namespace {

namespace fs = std::filesystem;
using gnomon::testing::FileSizeLimit;

template <class T>
std::string bytes(std::initializer_list<T> values) {
  std::string out;
  for (const T v : values) {
    char raw[sizeof(T)];
    std::memcpy(raw, &v, sizeof(T));
    out.append(raw, sizeof(T));
  }
  return out;
}

std::string base64(const std::string& in) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t k = 0; k < in.size(); k += 3) {
    std::uint32_t block = 0;
    for (std::size_t j = 0; j < 3; ++j)
      block = block << 8 | (k + j < in.size() ? static_cast<unsigned char>(in[k + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      out += k + j > in.size() ? '=' : kDigits[block >> (18 - 6 * j) & 63];
  }
  return out;
}

// A tetrahedron of 10 m in each format; `x` and `index` stand where the fault goes.

std::string obj(const std::string& x = "0", const std::string& index = "4") {
  return "o Tower\nv " + x +
         " 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 " + index + "\n";
}

std::string off(const std::string& x = "0", const std::string& index = "3") {
  return "OFF\n4 4 0\n" + x + " 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 " +
         index + "\n";
}

std::string ply(const std::string& x = "0", const std::string& index = "3", int faces = 4) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
         "float "
         "z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n" + x +
         " 0 0\n10 0 0\n0 10 0\n0 0 10\n" +
         (faces ? "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 " + index + "\n" : std::string());
}

std::string stl(const std::string& x = "0") {
  std::string out = "solid tower\n";
  const std::string p[4] = {x + " 0 0", "10 0 0", "0 10 0", "0 0 10"};
  for (const auto& t : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const int k : t) out += "vertex " + p[k] + "\n";
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid tower\n";
}

std::string binary_stl(float x = 0, std::uint32_t count = 1) {
  return std::string(80, ' ') + bytes<std::uint32_t>({count}) +
         bytes<float>({0, 0, 0, x, 0, 0, 10, 0, 0, 0, 10, 5}) + std::string(2, '\0');
}

std::string gltf_buffer(float x, std::uint16_t index) {
  return bytes<float>({x, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10}) +
         bytes<std::uint16_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, index});
}

std::string gltf_json(const std::string& uri, const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"Tower","mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
         R"("buffers":[{"byteLength":72)" +
         (uri.empty() ? "" : ",\"uri\":\"" + uri + "\"") + "}]" + more + "}";
}

std::string gltf(float x = 0, std::uint16_t index = 3) {
  return gltf_json("data:application/octet-stream;base64," + base64(gltf_buffer(x, index)));
}

std::string glb(float x = 0, std::uint16_t index = 3) {
  std::string json = gltf_json("");
  while (json.size() % 4 != 0) json += ' ';
  const std::string buffer = gltf_buffer(x, index);
  const auto size = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  return "glTF" + bytes<std::uint32_t>({2, size(12 + 8 + json.size() + 8 + buffer.size())}) +
         bytes<std::uint32_t>({size(json.size()), 0x4E4F534Au}) + json +
         bytes<std::uint32_t>({size(buffer.size()), 0x004E4942u}) + buffer;
}

std::string city(const std::string& x = "0", const std::string& index = "3",
                 const std::string& crs = R"("metadata":{"referenceSystem":"EPSG:31256"},)") {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[1200,340700,40]},)" +
         crs +
         R"("CityObjects":{"Tower":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",)"
         R"("boundaries":[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,)" +
         index + R"(]]]}]}},"vertices":[[)" + x + R"(,0,0],[10,0,0],[0,10,0],[0,0,10]]})";
}

std::string geojson(const std::string& x = "16.3", const std::string& type = "Polygon") {
  return R"({"type":"FeatureCollection","features":[{"type":"Feature","id":"Tower","properties":{"height":10},)"
         R"("geometry":{"type":")" +
         type + R"(","coordinates":)" +
         (type == "Point" ? "[" + x + ",48.2]"
                          : "[[[" + x + ",48.2],[16.301,48.2],[16.301,48.201],[" + x + ",48.2]]]") +
         "}}]}";
}

// 3 x 3 cells of 5 m, uncompressed, north up, without a CRS.
std::string geotiff(float corner = 7, float others = 3) {
  std::string out = "II" + bytes<std::uint16_t>({42}) + bytes<std::uint32_t>({8});
  const std::uint32_t scale = 8 + 2 + 12 * 12 + 4, tie = scale + 24, data = tie + 48;
  out += bytes<std::uint16_t>({12});
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t n,
                         std::uint32_t value) {
    out += bytes<std::uint16_t>({tag, type}) + bytes<std::uint32_t>({n, value});
  };
  entry(256, 3, 1, 3);
  entry(257, 3, 1, 3);
  entry(258, 3, 1, 32);
  entry(259, 3, 1, 1);
  entry(262, 3, 1, 1);
  entry(273, 4, 1, data);
  entry(277, 3, 1, 1);
  entry(278, 3, 1, 3);
  entry(279, 4, 1, 36);
  entry(339, 3, 1, 3);
  entry(33550, 12, 3, scale);
  entry(33922, 12, 6, tie);
  out += bytes<std::uint32_t>({0}) + bytes<double>({5, 5, 0, 0, 0, 0, 1200, 340700, 0});
  return out +
         bytes<float>({others, others, others, others, corner, others, others, others, others});
}

struct Format {
  const char* file;
  std::string whole;
  const char* place;  // the options that put it on Earth
};

std::vector<Format> formats() {
  const char* local = "--site 48.2,16.37 --up z";
  return {{"t.city.json", city(), ""},
          {"t.obj", obj(), local},
          {"t.gltf", gltf(), "--site 48.2,16.37"},
          {"t.glb", glb(), "--site 48.2,16.37"},
          {"t.stl", stl(), local},
          {"b.stl", binary_stl(), local},
          {"t.ply", ply(), local},
          {"t.off", off(), local},
          {"t.geojson", geojson(), ""},
          {"t.tif", geotiff(), "--crs EPSG:31256"}};
}

class BadInput : public gnomon::testing::Program {
 protected:
  std::string write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }
  // Fails with an error of one line that has all of `words`, and leaves no results.
  void refuses(const std::string& arguments, const std::vector<std::string>& words) {
    const int code = run(arguments);
    EXPECT_TRUE(code == 1 || code == 2) << code << ": " << arguments << "\n" << err_;
    EXPECT_TRUE(err_.starts_with("gnomon: error: ")) << arguments << "\n" << err_;
    for (const std::string& word : words)
      EXPECT_NE(err_.find(word), std::string::npos) << "no '" << word << "' in: " << err_;
    EXPECT_EQ(out_, "") << arguments;
    EXPECT_FALSE(fs::exists(results())) << arguments;
    if (std::getenv("GNOMON_SHOW_MESSAGES")) std::fputs(err_.c_str(), stderr);
  }
  std::string model_profile(const std::string& model, const std::string& place) const {
    return "profile " + model + " " + place + " " + day_ + " --pixel 4 -o " + results();
  }
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const auto& f : fs::recursive_directory_iterator(results()))
      found[f.path().string()] = f.is_regular_file() ? text(f.path()) : "";
    return found;
  }
};

TEST_F(BadInput, TheModelsOfTheseTestsAreGoodAsTheyStand) {
  for (const Format& f : formats()) {
    EXPECT_EQ(run(model_profile(write(f.file, f.whole), f.place)), 0) << f.file << ": " << err_;
    EXPECT_EQ(err_.find("error"), std::string::npos) << err_;
  }
}

TEST_F(BadInput, FilesThatAreNotThereAreEmptyOrAreNoModelAreNamed) {
  for (const Format& f : formats()) {
    SCOPED_TRACE(f.file);
    refuses(model_profile((folder_ / f.file).string(), f.place), {f.file, "no such file", "check"});
    refuses(model_profile(write(f.file, ""), f.place), {f.file});
    refuses(model_profile(write(f.file, "This is a letter, not a model.\n"), f.place), {f.file});
    refuses(model_profile(write(f.file, std::string(1000, '\0')), f.place), {f.file});
    fs::remove(folder_ / f.file);
    fs::create_directories(folder_ / f.file);
    refuses(model_profile((folder_ / f.file).string(), f.place), {f.file});
    fs::remove(folder_ / f.file);
  }
}

TEST_F(BadInput, FilesThatAreCutOffAreRefusedOrReadNeverCrash) {
  std::size_t refused = 0;
  for (const Format& f : formats()) {
    for (const double share : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99}) {
      const auto size = static_cast<std::size_t>(share * static_cast<double>(f.whole.size()));
      const int code = run("convert " + write(f.file, f.whole.substr(0, size)) + " " + f.place +
                           " --ground none -o " + results() + ".obj");
      ASSERT_TRUE(code == 0 || code == 1) << f.file << " cut at " << size << ": " << code;
      if (code == 1) {
        ++refused;
        EXPECT_NE(err_.find(f.file), std::string::npos) << err_;
        EXPECT_FALSE(fs::exists(results() + ".obj")) << f.file;
      }
      fs::remove(results() + ".obj");
    }
  }
  EXPECT_GT(refused, 45u) << "of 70; what is cut at the end of a line of an OBJ is an OBJ";
}

TEST_F(BadInput, FaultyElementsAreNamed) {
  constexpr float kInf = std::numeric_limits<float>::infinity(),
                  kNan = std::numeric_limits<float>::quiet_NaN();
  const char* local = "--site 48.2,16.37 --up z";
  struct Case {
    const char* file;
    std::string content;
    const char* place;
    std::vector<std::string> words;
  };
  const std::vector<Case> cases = {
      {"t.city.json", city("0", "99"), "", {"Tower", "99"}},
      {"t.city.json", city("0", "-1"), "", {"Tower", "-1"}},
      {"t.city.json", city("NaN"), "", {"JSON"}},
      {"t.city.json", city("1e999"), "", {"1e999"}},
      {"t.city.json", city("1e300"), "", {"Tower", "too large"}},
      {"t.city.json", city("\"a\""), "", {"Tower", "vertex 0"}},
      {"t.city.json", R"({"type":"CityJSON","version":"2.0"})", "", {"no surfaces"}},
      {"t.city.json", R"({"type":"Banana"})", "", {"not CityJSON"}},
      {"t.obj", obj("0", "99"), local, {"99"}},
      {"t.obj", obj("0", "-99"), local, {"-99"}},
      {"t.obj", obj("0", "0"), local, {"0"}},
      {"t.obj", obj("nan"), local, {"nan", "line 2"}},
      {"t.obj", obj("inf"), local, {"inf", "line 2"}},
      {"t.obj", obj("1e999"), local, {"1e999", "line 2"}},
      {"t.obj", obj("zero"), local, {"zero", "line 2"}},
      {"t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", local, {"no surfaces"}},
      {"t.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", local, {"area"}},
      {"t.off", off("0", "99"), local, {"99"}},
      {"t.off", off("nan"), local, {"line 7", "vertex 0", "not finite"}},
      {"t.off", off("inf"), local, {"line 7", "vertex 0", "not finite"}},
      {"t.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", local, {"no surfaces"}},
      {"t.ply", ply("0", "99"), local, {"99"}},
      {"t.ply", ply("nan"), local, {"nan"}},
      {"t.ply", ply("inf"), local, {"inf"}},
      {"t.ply", ply("0", "3", 0), local, {"no surfaces"}},
      {"t.stl", stl("nan"), local, {"nan"}},
      {"t.stl", stl("inf"), local, {"inf"}},
      {"t.stl", "solid tower\nendsolid tower\n", local, {"no surfaces"}},
      {"b.stl", binary_stl(kNan), local, {"triangle"}},
      {"b.stl", binary_stl(kInf), local, {"triangle"}},
      {"b.stl", binary_stl(0, 1000), local, {"1000"}},
      {"t.gltf", gltf(0, 99), "--site 48,16", {"99"}},
      {"t.gltf", gltf(kNan), "--site 48,16", {"nan"}},
      {"t.gltf", gltf(kInf), "--site 48,16", {"inf"}},
      {"t.gltf", gltf_json("gone.bin"), "--site 48,16", {"gone.bin"}},
      {"t.gltf", R"({"asset":{"version":"2.0"}})", "--site 48,16", {"no surfaces"}},
      {"t.gltf", R"({"asset":{"version":"2.0"},)", "--site 48,16", {"JSON"}},
      {"t.glb", glb(0, 99), "--site 48,16", {"99"}},
      {"t.glb", glb(kNan), "--site 48,16", {"nan"}},
      {"t.glb", glb(kInf), "--site 48,16", {"inf"}},
      {"t.geojson", geojson("NaN"), "", {"not finite"}},
      {"t.geojson", geojson("1e999"), "", {"not finite"}},
      {"t.geojson", geojson("\"a\""), "", {"feature 1 (id Tower)", "whole"}},
      {"t.geojson", geojson("16.3", "Point"), "", {"polygons"}},
      {"t.geojson", R"({"type":"FeatureCollection","features":[]})", "", {"no features"}},
      {"t.geojson", R"({"type":"FeatureCollection","features":[)", "", {"Unterminated"}},
      {"t.tif", geotiff(kNan, kNan), "--crs EPSG:31256", {"no cell has data"}},
      {"t.tif", geotiff(kInf, kInf), "--crs EPSG:31256", {"inf", "column 0"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.file + (": " + c.content.substr(0, 200)));
    std::vector<std::string> words = c.words;
    words.push_back(c.file);
    refuses(model_profile(write(c.file, c.content), c.place), words);
  }
}

TEST_F(BadInput, NoCrsAndNoSiteIsAnErrorThatSaysWhatToAdd) {
  for (const Format& f : formats()) {
    if (std::string(f.file) == "t.geojson") continue;  // is in degrees by its definition
    const std::string whole = std::string(f.file) == "t.city.json" ? city("0", "3", "") : f.whole;
    refuses(model_profile(write(f.file, whole), ""), {f.file, "--crs", "--site"});
  }
}

TEST_F(BadInput, OptionsThatContradictOrCannotBeAreRefused) {
  const std::string model = write("t.city.json", city());
  const auto with = [&](const std::string& more) {
    return "profile " + model + " " + more + " -o " + results();
  };
  const std::string day = "--date 2024-09-18 --tz Europe/Vienna ";
  refuses(with(day + "--from 17:00 --to 09:00"), {"--from", "earlier", "--to"});
  refuses(with(day + "--from 25:00"), {"--from", "25:00", "HH:MM"});
  refuses(with("--date 2024-02-30 --tz UTC"), {"2024-02-30", "YYYY-MM-DD"});
  refuses(with("--date 2024-09-18 --tz Europe/Wien"), {"Europe/Wien", "\"Europe/Vienna\""});
  refuses(with("--date 2024-09-18 --tz europe/vienna"), {"\"Europe/Vienna\""});
  refuses(with(day + "--pixel 0.00001"), {"GB", "--pixel"});
  refuses(with(day + "--view camera --size 32767x32767"), {"GB", "--size"});
  refuses(with(day + "--ground atuo"), {"atuo", "auto"});
  refuses(with(day + "--crs EPSG:99999999"), {"EPSG:99999999"});
  refuses(with(day + "--no-cast RofSurface"), {"RofSurface", "--no-cast"});
  refuses(with(day + "--receive Twoer"), {"Twoer", "\"Tower\""});
  refuses(with(day + "--threads 0"), {"--threads"});
  refuses(with("--dat 2024-09-18"), {"--dat", "Did you mean --date?"});
  refuses(with(day + "--pixle=4"), {"--pixle", "Did you mean --pixel?"});
  refuses("shadow " + model + " --outptu " + results(), {"Did you mean --output?"});
  refuses("profle " + model, {"profle", "Did you mean profile?"});
  refuses("", {"subcommand"});
  refuses("shadow " + model + " --date 2024-09-18 --at 14:00 --tz Europe/Wien -o " + results(),
          {"\"Europe/Vienna\""});
}

TEST_F(BadInput, OutputFoldersThatCannotBeWrittenAreNamed) {
  const std::string model = write("t.city.json", city()), in_the_way = write("file", "kept");
  const std::string args = "profile " + model + " " + day_ + " --pixel 4 -o ";
  // Root may write everywhere, but not into a file, nor where there are no files to be made.
  for (const std::string& output :
       {in_the_way, in_the_way + "/below", std::string("/proc/gnomon"), std::string("/proc"),
        (folder_ / std::string(300, 'x')).string()}) {
    const std::string named = output.ends_with("/below") ? in_the_way : output;
    refuses(args + output, {named, "choose a"});
    refuses("shadow " + model + " --light 1249,340770,200 --pixel 4 -o " + output, {named});
  }
  refuses("convert " + model + " -o " + in_the_way + "/t.obj", {in_the_way, "choose"});
  refuses(args + "''", {"-o"});
  EXPECT_EQ(text(in_the_way), "kept");
}

TEST_F(BadInput, ATargetThatIsAFolderIsFoundBeforeAnyResultIsMoved) {
  fs::create_directories(results() + "/summary.json");
  EXPECT_EQ(run(model_profile(write("t.city.json", city()), "")), 1);
  EXPECT_NE(err_.find("results/summary.json"), std::string::npos) << err_;
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(BadInput, AFullDiskLeavesTheEarlierRunAsItWasAndNamesTheFile) {
  const std::string model = write("t.city.json", city());
  const std::string command = model_profile(model, "");
  ASSERT_EQ(run(command), 0) << err_;
  const auto before = files();
  const std::string kept = results() + "-kept";
  for (const rlim_t size : {600, 2000, 5000, 20000, 60000}) {
    SCOPED_TRACE(size);
    for (const bool fresh : {false, true}) {
      if (fresh) fs::rename(results(), kept);
      {
        const FileSizeLimit limit(size);
        EXPECT_EQ(run(command + " --title other"), 1) << err_;
      }
      EXPECT_NE(err_.find(results() + "/"), std::string::npos) << err_;
      EXPECT_EQ(err_.find("unfinished"), std::string::npos) << err_;
      if (fresh) {
        EXPECT_FALSE(fs::exists(results()));
        fs::rename(kept, results());
      }
      EXPECT_EQ(files(), before);
    }
  }
  const FileSizeLimit limit(1000);
  EXPECT_EQ(run("convert " + vienna_ + " -o " + (folder_ / "v.obj").string()), 1);
  EXPECT_NE(err_.find("v.obj"), std::string::npos) << err_;
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_FALSE(entry.path().filename().string().starts_with("v.")) << entry.path();
}

TEST_F(BadInput, DegenerateAndDuplicatedFacesAreCountedInWarnings) {
  const std::string model = write("t.obj", obj() + "f 1 2 4\nf 4 2 1\nf 1 1 2\nv 5 0 0\nf 1 2 5\n");
  ASSERT_EQ(run(model_profile(model, "--site 48.2,16.37 --up z")), 0) << err_;
  EXPECT_NE(err_.find("lie exactly on others"), std::string::npos) << err_;
  EXPECT_NE(err_.find("2 times, first: object \"Tower\""), std::string::npos) << err_;
  EXPECT_NE(err_.find("Triangles without area were dropped"), std::string::npos) << err_;
  EXPECT_NE(text(results() + "/summary.json").find("lie exactly on others"), std::string::npos);
}

}  // namespace
