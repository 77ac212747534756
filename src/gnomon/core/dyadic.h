// Exact numbers m * 2^(64 e) with a long integer m: closed under addition and multiplication, no
// rounding ever. Used only where a floating filter could not decide (see exact.h), so it is simple
// rather than fast.
#pragma once

#include <cstdint>

namespace gnomon {

class Dyadic {
 public:
  Dyadic() = default;
  explicit Dyadic(double x);  // exact. Precondition: finite.

  int sign() const { return sign_; }

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return add(a, b, b.sign_); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return add(a, b, -b.sign_); }
  friend Dyadic operator-(const Dyadic& a) {
    Dyadic r(a);
    r.sign_ = -r.sign_;
    return r;
  }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);

  Dyadic(const Dyadic& other) { *this = other; }
  Dyadic& operator=(const Dyadic& other);

 private:
  // Largest product in any predicate: 8 coordinates and a pixel point, each within 2^-152 .. 2^41
  // (kSmallestCoordinate, kLargestCoordinate in exact.h), so at most 4 words each and 6 for the
  // pixel point: 38 words, and a few for carries.
  static constexpr int kCapacity = 48;

  static Dyadic add(const Dyadic& a, const Dyadic& b, int b_sign);
  void trim();

  int sign_ = 0;      // -1, 0, +1
  int exponent_ = 0;  // in words of 64 bits
  int size_ = 0;      // words in use; the lowest and the highest are not 0
  std::uint64_t words_[kCapacity];
};

}  // namespace gnomon
