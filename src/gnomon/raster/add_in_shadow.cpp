#include <gnomon/raster/add_in_shadow.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/add_in_shadow.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void AddInShadow(const std::uint8_t* mask, int n, std::uint32_t weight, std::uint32_t* sums) {
  const hn::ScalableTag<std::uint32_t> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const auto w = hn::Set(d, weight), zero = hn::Zero(d);
  const int lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    const auto dark = hn::Ne(hn::PromoteTo(d, hn::LoadU(bytes, mask + i)), zero);
    hn::StoreU(hn::Add(hn::LoadU(d, sums + i), hn::IfThenElseZero(dark, w)), d, sums + i);
  }
  for (; i < n; ++i) sums[i] += mask[i] != 0 ? weight : 0;
}

const char* Name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(AddInShadow);
HWY_EXPORT(Name);

void add_in_shadow(const std::uint8_t* mask, int n, std::uint32_t weight, std::uint32_t* sums) {
  HWY_DYNAMIC_DISPATCH(AddInShadow)(mask, n, weight, sums);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(Name)(); }

}  // namespace gnomon
#endif
