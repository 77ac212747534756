#include <gnomon/raster/add_where_positive.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gnomon/raster/add_where_positive.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gnomon {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void AddWherePositive(const std::int32_t* counts, int n, std::uint32_t weight,
                      std::uint32_t* sums) {
  const hn::ScalableTag<std::int32_t> d;
  const auto w = hn::Set(d, static_cast<std::int32_t>(weight)), zero = hn::Zero(d);
  const int lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    auto* s =
        reinterpret_cast<std::int32_t*>(sums + i);  // same size; wrapping addition is the same
    const auto add = hn::IfThenElseZero(hn::Gt(hn::LoadU(d, counts + i), zero), w);
    hn::StoreU(hn::Add(hn::LoadU(d, s), add), d, s);
  }
  for (; i < n; ++i) sums[i] += counts[i] > 0 ? weight : 0;
}

const char* Name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace gnomon
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon {

HWY_EXPORT(AddWherePositive);
HWY_EXPORT(Name);

void add_where_positive(const std::int32_t* counts, int n, std::uint32_t weight,
                        std::uint32_t* sums) {
  HWY_DYNAMIC_DISPATCH(AddWherePositive)(counts, n, weight, sums);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(Name)(); }

}  // namespace gnomon
#endif
