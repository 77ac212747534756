// Texts that carry more digits than a reader of single precision keeps.
#pragma once

#include <cstddef>
#include <string_view>

namespace gnomon {

// Metres. Losses up to this, far below what models are accurate to and masks resolve, are not worth
// a warning: programs write fifteen digits of everything.
inline constexpr double kNoticeableLoss = 1e-4;

// Numbers that change by more than half a unit of their last written digit when they become single
// precision: what is written says more than what is kept. Nine significant digits, as %.9g writes
// a float, never do.
struct DigitLoss {
  std::size_t numbers = 0;
  double largest = 0;  // change, in the text's unit
};

// Counts the numbers in `text`, which is numbers and anything else.
DigitLoss lost_digits(std::string_view text);

// Of a Collada text: what its positions and nodes' places lose (float_arrays of the sources that an
// input of POSITION names, <matrix>, <translate>).
DigitLoss lost_digits_of_collada(std::string_view xml);

// Of an IFC text: what its IFCCARTESIANPOINTs lose.
DigitLoss lost_digits_of_ifc(std::string_view step);

}  // namespace gnomon
