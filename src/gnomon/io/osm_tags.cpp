// Based on: OpenStreetMap wiki, "Key:height" and "Map features/Units" (lengths).
#include <gnomon/core/lower_case.h>
#include <gnomon/io/osm_tags.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

constexpr double kFoot = 0.3048, kInch = 0.0254;  // metres, exact by definition

void skip_spaces(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\xa0"), text.size()));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Takes a number off the front of `text`.
std::optional<double> take_number(std::string_view& text) {
  skip_spaces(text);
  std::string plain;  // as std::from_chars reads it: no plus sign, a point
  std::size_t k = 0, digits = 0;
  const auto take_digits = [&] {
    const std::size_t before = k;
    while (k < text.size() && is_digit(text[k])) plain += text[k++];
    return k - before;
  };
  if (k < text.size() && (text[k] == '+' || text[k] == '-')) {
    if (text[k] == '-') plain += '-';
    ++k;
  }
  digits = take_digits();
  if (k < text.size() && (text[k] == '.' || text[k] == ',')) {
    const bool comma = text[k] == ',';
    plain += '.';
    ++k;
    const std::size_t decimals = take_digits();
    if (comma && (decimals == 3 || decimals == 0)) return std::nullopt;  // of thousands, perhaps
    digits += decimals;
  }
  if (digits == 0) return std::nullopt;
  if (k + 1 < text.size() && (text[k] == 'e' || text[k] == 'E')) {
    const std::size_t sign = text[k + 1] == '+' || text[k + 1] == '-' ? 1 : 0;
    if (k + 1 + sign < text.size() && is_digit(text[k + 1 + sign])) {
      plain += 'e';
      if (text[k + 1] == '-') plain += '-';
      k += 1 + sign;
      take_digits();
    }
  }
  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc() || end != plain.data() + plain.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  text.remove_prefix(k);
  return value;
}

// Takes the longest of `words` that `text` starts with off its front.
bool take_word(std::string_view& text, std::initializer_list<std::string_view> words) {
  skip_spaces(text);
  std::size_t longest = 0;
  for (const std::string_view word : words) {
    if (word.size() <= longest || word.size() > text.size()) continue;
    const bool same = std::equal(word.begin(), word.end(), text.begin(),
                                 [](char a, char b) { return a == lower_case(b); });
    if (same) longest = word.size();
  }
  text.remove_prefix(longest);
  return longest > 0;
}

bool at_end(std::string_view text) {
  skip_spaces(text);
  return text.empty();
}

bool take_feet(std::string_view& text) {
  return take_word(text, {"ft", "foot", "feet", "'", "\u2032", "\u2019"});
}

bool take_inches(std::string_view& text) {
  return take_word(text, {"in", "inch", "inches", "\"", "''", "\u2033", "\u201d"});
}

// A text in double quotes off the front of `text`, backslashes resolved.
std::optional<std::string> take_quoted(std::string_view& text) {
  skip_spaces(text);
  if (text.empty() || text[0] != '"') return std::nullopt;
  std::string out;
  for (std::size_t k = 1; k < text.size(); ++k) {
    if (text[k] == '"') {
      text.remove_prefix(k + 1);
      return out;
    }
    if (text[k] == '\\' && k + 1 < text.size()) ++k;
    out += text[k];
  }
  return std::nullopt;
}

std::optional<Tags> parse_hstore(std::string_view text) {
  Tags tags;
  while (true) {
    auto key = take_quoted(text);
    if (!key || !take_word(text, {"=>"})) return std::nullopt;
    if (!take_word(text, {"null"})) {
      auto value = take_quoted(text);
      if (!value) return std::nullopt;
      tags.emplace_back(std::move(*key), std::move(*value));
    }
    if (at_end(text)) return tags;
    if (!take_word(text, {","})) return std::nullopt;
  }
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto value = take_number(text);
  return value && at_end(text) ? value : std::nullopt;
}

std::optional<double> parse_metres(std::string_view text) {
  const auto value = take_number(text);
  if (!value) return std::nullopt;
  if (at_end(text)) return value;
  if (take_inches(text)) return at_end(text) ? std::optional(*value * kInch) : std::nullopt;
  if (take_feet(text)) {
    if (at_end(text)) return *value * kFoot;
    const auto inches = take_number(text);
    if (!inches || *inches < 0 || *value < 0 || !take_inches(text) || !at_end(text)) {
      return std::nullopt;
    }
    return *value * kFoot + *inches * kInch;
  }
  if (!take_word(text, {"m", "metre", "metres", "meter", "meters"}) || !at_end(text)) {
    return std::nullopt;
  }
  return value;
}

std::optional<Tags> parse_tags(std::string_view text) {
  skip_spaces(text);
  if (text.empty()) return std::nullopt;
  if (text[0] != '{') return parse_hstore(text);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  Tags tags;
  for (const auto& [key, value] : json.items()) {
    if (value.is_null()) continue;
    tags.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return tags;
}

}  // namespace gnomon
