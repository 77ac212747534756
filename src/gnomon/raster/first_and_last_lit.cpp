#include <gnomon/raster/first_and_last_lit.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/first_and_last_lit.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void KeepFirstAndLastLit(const std::int32_t* counts, int n, std::uint16_t begin, std::uint16_t end,
                         std::uint16_t* first, std::uint16_t* last) {
  const hn::ScalableTag<std::int32_t> di;
  const hn::Rebind<std::int16_t, decltype(di)> d16;
  const hn::Rebind<std::uint16_t, decltype(di)> du;
  const auto zero = hn::Zero(d16);
  const auto from = hn::Set(du, begin), to = hn::Set(du, end);
  const int lanes = static_cast<int>(hn::Lanes(di));
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    // Narrowing saturates, which keeps the sign.
    const auto shaded =
        hn::RebindMask(du, hn::Gt(hn::DemoteTo(d16, hn::LoadU(di, counts + i)), zero));
    const auto f = hn::LoadU(du, first + i), l = hn::LoadU(du, last + i);
    hn::StoreU(hn::IfThenElse(shaded, f, hn::Min(f, from)), du, first + i);
    hn::StoreU(hn::IfThenElse(shaded, l, hn::Max(l, to)), du, last + i);
  }
  keep_first_and_last_lit_reference(counts + i, n - i, begin, end, first + i, last + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(KeepFirstAndLastLit);

void keep_first_and_last_lit(const std::int32_t* counts, int n, std::uint16_t begin,
                             std::uint16_t end, std::uint16_t* first, std::uint16_t* last) {
  HWY_DYNAMIC_DISPATCH(KeepFirstAndLastLit)(counts, n, begin, end, first, last);
}

void keep_first_and_last_lit_reference(const std::int32_t* counts, int n, std::uint16_t begin,
                                       std::uint16_t end, std::uint16_t* first,
                                       std::uint16_t* last) {
  for (int k = 0; k < n; ++k) {
    if (counts[k] > 0) continue;
    first[k] = std::min(first[k], begin);
    last[k] = std::max(last[k], end);
  }
}

}  // namespace gnomon
#endif
