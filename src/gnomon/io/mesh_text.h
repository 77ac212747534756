// Mesh files that are text, line by line.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gnomon/core/vec.h>

namespace gnomon {

// The words of one line after another. Lines end with LF, CR LF or CR; lines without words are
// passed over.
class MeshLines {
 public:
  // `comment`: the rest of a line from this character on is none of its words; 0: no comments.
  explicit MeshLines(std::string_view text, char comment = 0) : rest_(text), comment_(comment) {}

  // Goes to the next line that has words; false at the end of the text.
  bool next();

  std::vector<std::string_view> words;  // of this line
  std::string_view all;                 // this line, whole
  std::size_t number = 0;               // of this line, from 1

  // What follows this line.
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  char comment_;
};

// The number that the whole word is; NaN and infinity count as numbers. Digits are rounded to the
// nearest double.
std::optional<double> real_number(std::string_view word);
std::optional<std::uint64_t> whole_number(std::string_view word);

// x, y, z of a file -> z up.
inline Vec3 z_up(const Vec3& p, char up) { return up == 'y' ? Vec3(p.x, -p.z, p.y) : p; }

inline bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// "1 vertex", "2 vertices".
std::string counted(std::uint64_t count, const char* one, const char* many);

}  // namespace gnomon
