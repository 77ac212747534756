#include <fmt/format.h>
#include <gdal_frmts.h>
#include <gnomon/io/gdal_support.h>
#include <gnomon/io/read_picture.h>

#include <cpl_vsi.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

namespace gnomon {
namespace {

// Larger pictures than this (2^28 texels: a gigabyte) are none for surfaces.
constexpr std::int64_t kMostTexels = std::int64_t{1} << 28;

void register_drivers() {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALRegister_PNG();
    GDALRegister_JPEG();
    GDALRegister_BMP();
    GDALRegister_GIF();
  });
}

// Bytes as a file of GDAL's, gone at the end.
class InMemory {
 public:
  explicit InMemory(std::string_view bytes) {
    static std::atomic<std::uint64_t> number{0};
    path_ = fmt::format("/vsimem/gnomon_picture_{}", number++);
    // GDAL only reads them, but has no type to say so.
    auto* data = reinterpret_cast<GByte*>(const_cast<char*>(bytes.data()));
    if (VSILFILE* f = VSIFileFromMemBuffer(path_.c_str(), data, bytes.size(), FALSE)) VSIFCloseL(f);
  }
  ~InMemory() { VSIUnlink(path_.c_str()); }
  InMemory(const InMemory&) = delete;
  InMemory& operator=(const InMemory&) = delete;
  const char* path() const { return path_.c_str(); }

 private:
  std::string path_;
};

// One band as bytes, each to every fourth place from `to` on. 16 bits give their upper 8.
bool read_band(GDALRasterBandH band, int width, int height, std::uint8_t* to) {
  const std::size_t n = std::size_t(width) * std::size_t(height);
  if (GDALGetRasterDataType(band) == GDT_Byte) {
    return GDALRasterIO(band, GF_Read, 0, 0, width, height, to, width, height, GDT_Byte, 4,
                        4 * width) == CE_None;
  }
  std::vector<std::uint16_t> wide(n);
  if (GDALRasterIO(band, GF_Read, 0, 0, width, height, wide.data(), width, height, GDT_UInt16, 0,
                   0) != CE_None) {
    return false;
  }
  for (std::size_t k = 0; k < n; ++k) to[4 * k] = static_cast<std::uint8_t>(wide[k] >> 8);
  return true;
}

// Numbers of colours, in every fourth byte, become the colours.
void look_up(GDALColorTableH colours, std::vector<std::uint8_t>& rgba) {
  const int count = GDALGetColorEntryCount(colours);
  for (std::size_t k = 0; k < rgba.size(); k += 4) {
    const GDALColorEntry none{0, 0, 0, 255};
    const GDALColorEntry* c = rgba[k] < count ? GDALGetColorEntry(colours, rgba[k]) : &none;
    const short of[4] = {c->c1, c->c2, c->c3, c->c4};
    for (std::size_t b = 0; b < 4; ++b) rgba[k + b] = static_cast<std::uint8_t>(of[b]);
  }
}

}  // namespace

Result<Texture> read_picture(std::string_view bytes, const std::string& name) {
  register_drivers();
  const GdalErrors errors;
  const auto failed = [&](const char* why) { return Error{errors.first().value_or(why)}; };
  const InMemory file(bytes);
  const char* const drivers[] = {"PNG", "JPEG", "BMP", "GIF", nullptr};
  const Dataset picture(
      GDALOpenEx(file.path(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr));
  if (!picture) return failed("it is no PNG, JPEG, BMP or GIF");
  Texture out;
  out.name = name;
  out.width = GDALGetRasterXSize(picture.get());
  out.height = GDALGetRasterYSize(picture.get());
  const int bands = GDALGetRasterCount(picture.get());
  if (bands < 1 || bands > 4) return Error{fmt::format("it has {} bands", bands)};
  if (std::int64_t(out.width) * out.height > kMostTexels) {
    return Error{fmt::format("it has {} x {} texels", out.width, out.height)};
  }
  out.rgba.assign(4 * std::size_t(out.width) * std::size_t(out.height), 255);
  const auto read = [&](int band, std::size_t at) {
    return read_band(GDALGetRasterBand(picture.get(), band), out.width, out.height,
                     out.rgba.data() + at);
  };
  for (std::size_t c = 0; c < 3; ++c) {
    if (!read(bands < 3 ? 1 : static_cast<int>(c) + 1, c)) return failed("it is cut off");
  }
  if (bands % 2 == 0 && !read(bands, 3)) return failed("it is cut off");
  if (errors.first()) return failed("");
  for (const std::string& warning : errors.warnings()) {  // libjpeg fills up with grey
    if (warning.find("remature end") != std::string::npos) return failed("it is cut off");
  }
  GDALColorTableH colours = GDALGetRasterColorTable(GDALGetRasterBand(picture.get(), 1));
  if (bands == 1 && colours) look_up(colours, out.rgba);
  return out;
}

}  // namespace gnomon
