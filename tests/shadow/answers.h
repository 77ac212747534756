// All that Gnomon answers about one view under given lights, as bits that can be compared and
// hashed: tests of what must be the same whoever computes it.
#pragma once

#include <gnomon/shadow/cast_shadows.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace gnomon::test {

// FNV-1a, 64 bits, over the bytes of integers, lowest byte first on every machine.
// Based on: Fowler, Noll, Vo: The FNV Non-Cryptographic Hash Algorithm, 1991.
class Hash {
 public:
  template <class T>
  void add(T value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t k = 0; k < sizeof(T); ++k, bits >>= 8) {
      value_ ^= bits & 0xffu;
      value_ *= 0x100000001b3u;
    }
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const T& v : values) add(v);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

struct Answers {
  std::vector<std::uint32_t> triangles;  // which triangle each sample is on
  // Light by light, each row-major: of count_shadows(), of mask_shadows().
  std::vector<std::vector<std::int32_t>> counts;
  std::vector<std::vector<std::uint8_t>> masks;
  std::vector<std::uint8_t> first, last;    // cast_shadows() of these two lights, each on its own
  std::vector<std::uint32_t> shadow_ticks;  // and what follows: of shadow_profile() over all lights
  std::vector<std::uint8_t> valid;
  std::vector<std::uint32_t> ticks;  // of daylight, milliseconds of a tick
  std::vector<std::uint16_t> first_lit, last_lit;
  std::vector<std::int32_t> lit_from_ms, lit_to_ms;
  bool operator==(const Answers&) const = default;
};

// Counts of every light, row-major.
inline std::vector<std::vector<std::int32_t>> gathered_counts(const Casters& casters,
                                                              const Receivers& r,
                                                              std::span<const Light> lights,
                                                              int threads) {
  std::vector<std::vector<std::int32_t>> counts(lights.size(),
                                                std::vector<std::int32_t>(r.triangle.size()));
  std::vector<std::int32_t*> to;
  for (std::vector<std::int32_t>& c : counts) to.push_back(c.data());
  count_shadows(casters, r, lights, to, threads);
  return counts;
}

// One step of a day for each light. They are of different lengths, some begin or end together, some
// have the sun down.
inline std::vector<TimeSample> steps_of(std::span<const Light> lights) {
  std::vector<TimeSample> steps;
  std::int32_t clock = 6 * 3600000;
  for (const Light& light : lights) {
    const auto k = static_cast<std::int32_t>(steps.size());
    TimeSample& s = steps.emplace_back();
    s.weight_ms = 300000u + 1009u * static_cast<std::uint32_t>(k % 7);
    s.clock_begin_ms = clock;
    if (k % 5 != 0) clock += static_cast<std::int32_t>(s.weight_ms);
    s.clock_end_ms = clock;
    s.light = light;
    s.up = k % 11 != 3;
  }
  return steps;
}

inline Answers answers(const Scene& scene, const View& view, std::span<const Light> lights,
                       int threads) {
  Answers a;
  const Casters casters = prepare_casters(scene);
  const Receivers r = visible_surfaces(scene, view, threads);
  a.triangles = r.triangle;
  a.counts = gathered_counts(casters, r, lights, threads);
  a.masks.assign(lights.size(), std::vector<std::uint8_t>(r.triangle.size()));
  std::vector<std::uint8_t*> to;
  for (auto& m : a.masks) to.push_back(m.data());
  mask_shadows(casters, r, lights, to, threads);
  const ShadowOptions options{threads, {}, nullptr, true};
  a.first = cast_shadows(casters, r, lights.front(), options).state;
  a.last = cast_shadows(casters, r, lights.back(), options).state;
  Profile p = shadow_profile(casters, r, steps_of(lights), options);
  a.shadow_ticks = std::move(p.shadow_ticks);
  a.valid = std::move(p.valid);
  a.ticks = {p.daylight_ticks, p.tick_ms};
  a.first_lit = std::move(p.first_lit);
  a.last_lit = std::move(p.last_lit);
  a.lit_from_ms = std::move(p.lit_from_ms);
  a.lit_to_ms = std::move(p.lit_to_ms);
  return a;
}

// Calls f(name, hash) for each part: of two builds that disagree, the first part that does tells
// where to look.
template <class F>
void for_each_part(const Answers& a, const F& f) {
  const auto part = [&](const char* name, const auto&... values) {
    Hash h;
    (h.add(values), ...);
    f(name, h.value());
  };
  part("triangles", a.triangles);
  part("counts", a.counts);
  part("masks", a.masks);
  part("cast_shadows", a.first, a.last);
  part("shadow_profile", a.shadow_ticks, a.valid, a.ticks);
  part("first and last sun", a.first_lit, a.last_lit, a.lit_from_ms, a.lit_to_ms);
}

inline std::uint64_t hash_of(const std::vector<Answers>& views) {
  Hash h;
  for (const Answers& a : views)
    for_each_part(a, [&](const char*, std::uint64_t part) { h.add(part); });
  return h.value();
}

inline std::string hashes_of_parts(const std::vector<Answers>& views) {
  std::ostringstream out;
  for (std::size_t k = 0; k < views.size(); ++k) {
    for_each_part(views[k], [&](const char* name, std::uint64_t part) {
      out << "view " << k << ", " << name << ": " << std::hex << part << std::dec << "\n";
    });
  }
  return out.str();
}

}  // namespace gnomon::test
