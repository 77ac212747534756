#include <gnomon/raster/count_bands.h>

#include <algorithm>

#include <gnomon/raster/fill_polygons.h>
#include <gnomon/raster/fill_strips.h>

namespace gnomon {
namespace {

static_assert(kBandRows <= kStripRowsMax);
static_assert(kBandRows % (1 << kCellShift) == 0);  // whole cells

}  // namespace

BandCounter::BandCounter(const Casters& casters, const Receivers& receivers, const ViewSetup& view,
                         BandMemory& memory, int band)
    : casters_(casters),
      receivers_(receivers),
      view_(view),
      memory_(memory),
      band_(static_cast<std::size_t>(band)) {
  memory_.first_row = band * kBandRows;
  memory_.rows = std::min(kBandRows, receivers.view.height - memory_.first_row);
  memory_.filled = false;
}

CountRect BandCounter::counts(const LightSetup& s, int light) {
  const int width = receivers_.view.width, stride = width + kQuadPadding;
  memory_.rows_of_counts.assign(
      static_cast<std::size_t>(memory_.rows) * static_cast<std::size_t>(stride), 0);
  std::int32_t* counts = memory_.rows_of_counts.data();
  const auto for_each_sample = [&](const auto& f) {
    for (int row = 0; row < memory_.rows; ++row) {
      const std::uint32_t* triangle =
          receivers_.triangle.data() + static_cast<std::ptrdiff_t>(memory_.first_row + row) * width;
      std::int32_t* c = counts + static_cast<std::ptrdiff_t>(row) * stride;
      for (int x = 0; x < width; ++x) {
        if (triangle[x] != kNoTriangle) f(triangle[x], c[x]);
      }
    }
  };
  if (s.eye_count != 0) for_each_sample([&](std::uint32_t, std::int32_t& c) { c = s.eye_count; });
  if (fill(s))
    take_counts(memory_.counts.get(), memory_.stride, width, memory_.rows, counts, stride);
  if (!s.unlit.empty()) {
    for_each_sample([&](std::uint32_t t, std::int32_t& c) {
      if (s.unlit[t] != 0) c = std::max(c, 1);
    });
  }
  return {light, 0, memory_.first_row, width, memory_.rows, stride, counts};
}

MaskRect BandCounter::mask(const LightSetup& s, int light) {
  const int width = receivers_.view.width;
  memory_.rows_of_mask.resize(static_cast<std::size_t>(kBandRows) *
                              static_cast<std::size_t>(width));
  take(s, memory_.rows_of_mask.data());
  return {light, 0, memory_.first_row, width, memory_.rows, width, memory_.rows_of_mask.data()};
}

void BandCounter::mask(const LightSetup& s, std::uint8_t* to) {
  take(s, to + static_cast<std::ptrdiff_t>(memory_.first_row) * receivers_.view.width);
}

// `to`: of the band, rows as long as the picture is wide.
void BandCounter::take(const LightSetup& s, std::uint8_t* to) {
  const int width = receivers_.view.width;
  if (!s.unlit.empty() || s.eye_count != 0) {
    const CountRect c = counts(s, 0);
    for (int row = 0; row < c.rows; ++row, to += width) {
      const std::int32_t* from = c.counts + static_cast<std::ptrdiff_t>(row) * c.stride;
      for (int x = 0; x < width; ++x) to[x] = from[x] > 0 ? 1 : 0;
    }
  } else if (fill(s)) {
    take_mask(memory_.counts.get(), memory_.stride, width, memory_.rows, to, width);
  } else {
    std::fill_n(to, static_cast<std::ptrdiff_t>(memory_.rows) * width, std::uint8_t{0});
  }
}

// False if nothing was added to the interleaved counts.
bool BandCounter::fill(const LightSetup& s) {
  const std::span<const std::uint32_t> selected = s.strip_bins.of(band_);
  const std::span<const std::uint32_t> polygons = s.bins.of(band_);
  std::span<const std::uint32_t> casters;
  if (!view_.casters.empty()) casters = view_.caster_bins.of(band_);
  if (selected.empty() && polygons.empty() && casters.empty()) return false;
  need_nearness();
  ExactDecisions exact(casters_, view_, receivers_, s);
  StripJob job;
  job.strips = s.strips.data();
  job.selected = selected.data();
  job.count = selected.size();
  job.slope = static_cast<float>(s.strip_light.k);
  job.first_row = memory_.first_row;
  job.rows = memory_.rows;
  job.nearness = memory_.nearness.get();
  job.counts = memory_.counts.get();
  job.stride = memory_.stride;
  job.exact = &exact;
  fill_strips(job);
  PolygonJob rest;
  rest.polygons = s.polygons.data();
  rest.selected = polygons.data();
  rest.count = polygons.size();
  rest.first_row = memory_.first_row;
  rest.rows = memory_.rows;
  rest.width = receivers_.view.width;
  rest.nearness = memory_.nearness.get();
  rest.counts = memory_.counts.get();
  rest.stride = memory_.stride;
  rest.nearness_floor = receivers_.nearness_floor;
  rest.exact = &exact;
  fill_polygons(rest);
  rest.polygons = view_.casters.data();
  rest.selected = casters.data();
  rest.count = casters.size();
  rest.signs = s.triangle_sides.data();
  fill_polygons(rest);
  stats.spans += exact.spans;
  stats.depths += exact.depths;
  stats.close += exact.close;
  return true;
}

void BandCounter::need_nearness() {
  BandMemory& m = memory_;
  if (m.filled) return;
  m.filled = true;
  const int width = receivers_.view.width;
  if (!m.nearness) {
    m.stride = quad_stride(width);
    const std::size_t n = static_cast<std::size_t>(kBandRows / kQuadRows) * m.stride;
    m.nearness = hwy::AllocateAligned<float>(n);
    m.counts = hwy::AllocateAligned<std::int32_t>(n);
    std::fill_n(m.nearness.get(), n, 0.0F);
    std::fill_n(m.counts.get(), n, 0);
  }
  interleave_rows(receivers_.nearness.data() +
                      static_cast<std::size_t>(m.first_row) * static_cast<std::size_t>(width),
                  width, m.rows, m.nearness.get(), m.stride);
}

}  // namespace gnomon
