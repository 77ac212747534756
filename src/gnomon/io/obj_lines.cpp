#include <fmt/format.h>
#include <gnomon/io/obj_lines.h>
#include <gnomon/io/read_text.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace gnomon {
namespace {

// Statements of the format's specification (Wavefront, "Object Files", 1995), but for v, f, fo, l
// and p: those that make curves and surfaces, their older forms last, ...
constexpr std::array<std::string_view, 7> kFreeForm = {"curv", "curv2", "surf", "bzp",
                                                       "bsp",  "cdc",   "cdp"};
// ... and those that make none of their own. "call" and "csh" are in neither: they bring in another
// file.
constexpr std::array<std::string_view, 31> kWithoutSurfaces = {
    "vt",     "vn",     "vp",         "o",         "g",        "s",        "mg",    "usemtl",
    "mtllib", "usemap", "maplib",     "lod",       "bevel",    "parm",     "trim",  "hole",
    "scrv",   "sp",     "shadow_obj", "trace_obj", "c_interp", "d_interp", "ctech", "deg",
    "stech",  "cstype", "bmat",       "step",      "end",      "con",      "res"};

template <std::size_t n>
bool is_one_of(const std::array<std::string_view, n>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Cuts the next word off `rest`; empty at the end of the line.
std::string_view next_word(std::string_view& rest) {
  const std::size_t start = std::min(rest.find_first_not_of(" \t"), rest.size());
  rest.remove_prefix(start);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  rest.remove_prefix(word.size());
  return word;
}

std::optional<double> finite_number(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

// The vertex index of "7", "7/1", "7//3", "-1/2/3".
std::optional<long long> vertex_index(std::string_view word) {
  const std::string_view number = word.substr(0, word.find('/'));
  long long value = 0;
  const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (code != std::errc() || end != number.data() + number.size()) return {};
  if (std::count(word.begin(), word.end(), '/') > 2) return {};
  return value;
}

// An index that counts from the start of the file may lead to a vertex further down; it is looked
// up at the end.
struct Reference {
  long long index;  // as in the file, from 1
  std::size_t line;
};

struct Checker {
  const std::string& path;
  ObjLines out;
  Reference largest{0, 0};
  std::string error;

  bool fail(std::size_t line, const std::string& what) {
    error = fmt::format("{}: line {}: {}", path, line, what);
    return false;
  }

  bool vertex(std::string_view rest, std::size_t line) {
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string_view word = next_word(rest);
      if (word.empty()) return fail(line, fmt::format("the vertex has no {} coordinate.", axis));
      const auto number = finite_number(word);
      if (!number) {
        return fail(line, fmt::format("the {} coordinate {} is not a finite number.", axis,
                                      in_quotes(word)));
      }
      out.coordinates.push_back(*number);
    }
    ++out.vertices;
    return true;
  }

  bool face(std::string_view rest, std::size_t line) {
    std::size_t corners = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const auto index = vertex_index(word);
      if (!index) {
        return fail(line, fmt::format("{} is not a vertex index of a face.", in_quotes(word)));
      }
      const auto count = static_cast<long long>(out.vertices);
      if (*index == 0 || *index < -count || *index > std::numeric_limits<int>::max()) {
        return fail(line, fmt::format("vertex index {} is out of range; {} vertices stand above "
                                      "this face, and indices start at 1.",
                                      *index, count));
      }
      if (*index > largest.index) largest = {*index, line};
      ++corners;
    }
    if (corners == 0) return fail(line, "the face has no corners.");
    out.face_line.push_back(static_cast<std::uint32_t>(line));
    return true;
  }

  bool line(std::string_view content, std::size_t number) {
    std::string_view rest = content;
    const std::string_view keyword = next_word(rest);
    if (keyword == "v") return vertex(rest, number);
    if (keyword == "f" || keyword == "fo") return face(rest, number);
    if (keyword == "l" || keyword == "p") {
      if (out.points_and_lines++ == 0) out.first_point_or_line = number;
    } else if (is_one_of(kFreeForm, keyword)) {
      if (out.free_form++ == 0) out.first_free_form = number;
    } else if (!keyword.empty() && !is_one_of(kWithoutSurfaces, keyword) && out.unknown++ == 0) {
      out.first_unknown = number;
      out.unknown_keyword = keyword;
    }
    return true;
  }
};

// The line without its comment. Names may hold a "#", so only lines of numbers are cut in the
// middle.
std::string_view without_comment(std::string_view line) {
  std::string_view rest = line;
  const std::string_view keyword = next_word(rest);
  if (keyword.starts_with('#')) return {};
  if (keyword == "v" || keyword == "f" || keyword == "fo") return line.substr(0, line.find('#'));
  return line;
}

}  // namespace

Result<ObjLines> check_obj_lines(std::string_view text, const std::string& path) {
  Checker checker{path, {}, {0, 0}, {}};
  std::string joined;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t first = ++number;
    joined.clear();
    for (bool more = true; more;) {
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      std::string_view piece = text.substr(0, end);
      const bool crlf = text.substr(end).starts_with("\r\n");
      text.remove_prefix(std::min(text.size(), end + (crlf ? 2 : 1)));
      while (piece.ends_with(' ') || piece.ends_with('\t')) piece.remove_suffix(1);
      more = piece.ends_with('\\') && !text.empty();
      if (more) {
        piece.remove_suffix(1);
        ++number;
      }
      joined += piece;
      if (more) joined += ' ';
    }
    const std::string_view content = without_comment(joined);
    if (content.find('\0') != std::string_view::npos) {
      return Error{fmt::format("{}: line {}: is not text; this is not an OBJ file.", path, first)};
    }
    if (!checker.line(content, first)) return Error{checker.error};
    std::string_view rest = content;
    const std::string_view keyword = next_word(rest);
    if (keyword == "fo") {  // the obsolete name of f
      (checker.out.text += 'f').append(rest);
    } else {
      checker.out.text.append(content);
      if (keyword == "g" && rest.empty()) checker.out.text += ' ';
    }
    checker.out.text += '\n';
  }
  if (checker.largest.index > static_cast<long long>(checker.out.vertices)) {
    return Error{
        fmt::format("{}: line {}: vertex index {} is out of range; the file has {} vertices.", path,
                    checker.largest.line, checker.largest.index, checker.out.vertices)};
  }
  return std::move(checker.out);
}

}  // namespace gnomon
