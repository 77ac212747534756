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

void KeepFirstAndLastLit(const std::uint8_t* mask, int n, std::uint16_t begin, std::uint16_t end,
                         std::uint16_t* first, std::uint16_t* last) {
  const hn::ScalableTag<std::uint16_t> du;
  const hn::Rebind<std::uint8_t, decltype(du)> bytes;
  const auto zero = hn::Zero(du), from = hn::Set(du, begin), to = hn::Set(du, end);
  const int lanes = static_cast<int>(hn::Lanes(du));
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    const auto dark = hn::Ne(hn::PromoteTo(du, hn::LoadU(bytes, mask + i)), zero);
    const auto f = hn::LoadU(du, first + i), l = hn::LoadU(du, last + i);
    hn::StoreU(hn::IfThenElse(dark, f, hn::Min(f, from)), du, first + i);
    hn::StoreU(hn::IfThenElse(dark, l, hn::Max(l, to)), du, last + i);
  }
  keep_first_and_last_lit_reference(mask + i, n - i, begin, end, first + i, last + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(KeepFirstAndLastLit);

void keep_first_and_last_lit(const std::uint8_t* mask, int n, std::uint16_t begin,
                             std::uint16_t end, std::uint16_t* first, std::uint16_t* last) {
  HWY_DYNAMIC_DISPATCH(KeepFirstAndLastLit)(mask, n, begin, end, first, last);
}

void keep_first_and_last_lit_reference(const std::uint8_t* mask, int n, std::uint16_t begin,
                                       std::uint16_t end, std::uint16_t* first,
                                       std::uint16_t* last) {
  for (int k = 0; k < n; ++k) {
    if (mask[k] != 0) continue;
    first[k] = std::min(first[k], begin);
    last[k] = std::max(last[k], end);
  }
}

}  // namespace gnomon
#endif
