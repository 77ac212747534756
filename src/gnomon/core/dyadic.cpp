#include <gnomon/core/dyadic.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace gnomon {
namespace {

__extension__ typedef unsigned __int128 Wide;

[[noreturn]] void too_long() {
  throw std::length_error(
      "exact arithmetic: a coordinate lies outside kSmallestCoordinate .. kLargestCoordinate");
}

}  // namespace

Dyadic::Dyadic(double x) {
  if (x == 0) return;
  int e = 0;
  const double m = std::frexp(std::fabs(x), &e);  // |x| = m 2^e, 1/2 <= m < 1
  const auto mantissa = static_cast<std::uint64_t>(std::ldexp(m, 53));
  e -= 53;
  exponent_ = e >= 0 ? e / 64 : -((63 - e) / 64);
  const int shift = e - 64 * exponent_;  // 0 .. 63
  const Wide wide = static_cast<Wide>(mantissa) << shift;
  words_[0] = static_cast<std::uint64_t>(wide);
  words_[1] = static_cast<std::uint64_t>(wide >> 64);
  size_ = 2;
  sign_ = x < 0 ? -1 : 1;
  trim();
}

Dyadic& Dyadic::operator=(const Dyadic& other) {
  sign_ = other.sign_;
  exponent_ = other.exponent_;
  size_ = other.size_;
  if (this != &other)
    std::memcpy(words_, other.words_, sizeof(words_[0]) * static_cast<unsigned>(size_));
  return *this;
}

void Dyadic::trim() {
  while (size_ > 0 && words_[size_ - 1] == 0) --size_;
  int low = 0;
  while (low < size_ && words_[low] == 0) ++low;
  if (low > 0) {
    std::memmove(words_, words_ + low, sizeof(words_[0]) * static_cast<unsigned>(size_ - low));
    size_ -= low;
    exponent_ += low;
  }
  if (size_ == 0) {
    sign_ = 0;
    exponent_ = 0;
  }
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic r;
  if (a.sign_ == 0 || b.sign_ == 0) return r;
  r.size_ = a.size_ + b.size_;
  if (r.size_ > Dyadic::kCapacity) too_long();
  r.sign_ = a.sign_ * b.sign_;
  r.exponent_ = a.exponent_ + b.exponent_;
  std::fill(r.words_, r.words_ + r.size_, 0);
  for (int i = 0; i < a.size_; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < b.size_; ++j) {
      const Wide t = static_cast<Wide>(a.words_[i]) * b.words_[j] + r.words_[i + j] + carry;
      r.words_[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    r.words_[i + b.size_] = carry;
  }
  r.trim();
  return r;
}

Dyadic Dyadic::add(const Dyadic& a, const Dyadic& b, int b_sign) {
  if (b_sign == 0) return a;
  if (a.sign_ == 0) {
    Dyadic r(b);
    r.sign_ = b_sign;
    return r;
  }
  Dyadic r;
  r.exponent_ = std::min(a.exponent_, b.exponent_);
  const int top = std::max(a.exponent_ + a.size_, b.exponent_ + b.size_);
  r.size_ = top - r.exponent_ + 1;
  if (r.size_ > kCapacity) too_long();
  const int shift_a = a.exponent_ - r.exponent_, shift_b = b.exponent_ - r.exponent_;
  const auto word = [](const Dyadic& x, int i) -> std::uint64_t {
    return i >= 0 && i < x.size_ ? x.words_[i] : 0;
  };
  if (a.sign_ == b_sign) {
    std::uint64_t carry = 0;
    for (int i = 0; i < r.size_; ++i) {
      const Wide t = static_cast<Wide>(word(a, i - shift_a)) + word(b, i - shift_b) + carry;
      r.words_[i] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    r.sign_ = a.sign_;
  } else {
    std::uint64_t borrow = 0;
    for (int i = 0; i < r.size_; ++i) {
      const std::uint64_t x = word(a, i - shift_a), y = word(b, i - shift_b);
      const std::uint64_t d = x - y - borrow;
      borrow = (x < y || (x == y && borrow)) ? 1 : 0;
      r.words_[i] = d;
    }
    r.sign_ = a.sign_;
    if (borrow) {  // |b| > |a|: negate in two's complement
      r.sign_ = b_sign;
      std::uint64_t carry = 1;
      for (int i = 0; i < r.size_; ++i) {
        r.words_[i] = ~r.words_[i] + carry;
        carry = (carry && r.words_[i] == 0) ? 1 : 0;
      }
    }
  }
  r.trim();
  return r;
}

}  // namespace gnomon
