// Floating-point numbers that know how wrong they are.
//
// Approx carries a value and a bound on its distance from the exact value: a filter that is right
// by construction, without hand-derived constants. Bound carries only a bound on the magnitude and
// on the error: the same formula, evaluated once over the largest inputs, bounds the error of every
// evaluation in plain double.
#pragma once

#include <cmath>
#include <limits>

#ifdef __FAST_MATH__
#error "Gnomon's predicates need IEEE arithmetic: compile this file without -ffast-math or -Ofast"
#endif

namespace gnomon {

inline constexpr double kUnitRoundoff = 0x1p-53;  // of double, round to nearest
// Each operation on error terms rounds as well, by at most a few units; one factor per operation
// pays for all of them.
inline constexpr double kInflate = 1.0 + 0x1p-48;
// Below this a product of factors may have lost bits to underflow; such values count as undecided.
inline constexpr double kUnderflowGuard = 1e-280;

// As float, not below and not above x.
inline float rounded_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}
inline float rounded_down(double x) { return -rounded_up(-x); }

struct Approx {
  double value = 0;
  double error = 0;  // |value - exact| <= error

  Approx() = default;
  explicit Approx(double x) : value(x) {}
  Approx(double v, double e) : value(v), error(e) {}

  bool certain() const { return std::fabs(value) > error && std::fabs(value) > kUnderflowGuard; }
  int sign() const { return value > 0 ? 1 : -1; }  // meaningful only if certain()
};

inline Approx operator+(const Approx& a, const Approx& b) {
  const double v = a.value + b.value;
  return {v, (a.error + b.error + std::fabs(v) * kUnitRoundoff) * kInflate};
}
inline Approx operator-(const Approx& a, const Approx& b) {
  const double v = a.value - b.value;
  return {v, (a.error + b.error + std::fabs(v) * kUnitRoundoff) * kInflate};
}
inline Approx operator-(const Approx& a) { return {-a.value, a.error}; }
inline Approx operator*(const Approx& a, const Approx& b) {
  const double v = a.value * b.value;
  return {v, (std::fabs(a.value) * b.error + a.error * std::fabs(b.value) + a.error * b.error +
              std::fabs(v) * kUnitRoundoff) *
                 kInflate};
}
// Precondition: b.certain().
inline Approx operator/(const Approx& a, const Approx& b) {
  const double v = a.value / b.value;
  const double least = std::fabs(b.value) - b.error;
  return {v,
          ((a.error + std::fabs(v) * b.error) / least + std::fabs(v) * kUnitRoundoff) * kInflate};
}

struct Bound {
  double magnitude = 0;  // of the computed value
  double error = 0;      // of the computed value

  Bound() = default;
  explicit Bound(double x) : magnitude(std::fabs(x)) {}
  Bound(double m, double e) : magnitude(m), error(e) {}
};

inline Bound operator+(const Bound& a, const Bound& b) {
  const double m = (a.magnitude + b.magnitude) * kInflate;
  return {m, (a.error + b.error + m * kUnitRoundoff) * kInflate};
}
inline Bound operator-(const Bound& a, const Bound& b) { return a + b; }
inline Bound operator-(const Bound& a) { return a; }
inline Bound operator*(const Bound& a, const Bound& b) {
  const double m = a.magnitude * b.magnitude * kInflate;
  return {m,
          (a.magnitude * b.error + a.error * b.magnitude + a.error * b.error + m * kUnitRoundoff) *
              kInflate};
}

}  // namespace gnomon
