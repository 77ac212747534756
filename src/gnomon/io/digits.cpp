#include <fmt/format.h>
#include <gnomon/io/digits.h>
#include <gnomon/io/mesh_text.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace gnomon {
namespace {

// Half of the unit that the last digit of `word` stands for: "12.50" -> 0.005, "1.5e3" -> 50.
double half_unit(std::string_view word) {
  const std::size_t e = word.find_first_of("eE");
  int exponent = 0;
  if (e != std::string_view::npos) {
    const double given = real_number(word.substr(e + 1)).value_or(0);
    exponent = static_cast<int>(std::clamp(given, -400.0, 400.0));
    word = word.substr(0, e);
  }
  const std::size_t point = word.find('.');
  if (point != std::string_view::npos) exponent -= static_cast<int>(word.size() - point - 1);
  return 0.5 * std::pow(10.0, exponent);
}

void add(DigitLoss& to, const DigitLoss& more) {
  to.numbers += more.numbers;
  to.largest = std::max(to.largest, more.largest);
}

// The value of attribute `name` in `tag`.
std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = 0; (at = tag.find(name, at)) != std::string_view::npos; ++at) {
    std::size_t k = at + name.size();
    if (at == 0 || std::string_view(" \t\r\n").find(tag[at - 1]) == std::string_view::npos)
      continue;
    while (k < tag.size() && (tag[k] == ' ' || tag[k] == '=')) ++k;
    if (k >= tag.size() || (tag[k] != '"' && tag[k] != '\'')) continue;
    const std::size_t end = tag.find(tag[k], k + 1);
    if (end != std::string_view::npos) return tag.substr(k + 1, end - k - 1);
  }
  return {};
}

// Calls `use(tag, content)` for every <name ...>content</name>.
template <class Use>
void for_each_tag(std::string_view xml, std::string_view name, Use use) {
  const std::string open = fmt::format("<{}", name), close = fmt::format("</{}", name);
  for (std::size_t at = 0; (at = xml.find(open, at)) != std::string_view::npos;) {
    at += open.size();
    const std::size_t end = xml.find('>', at);
    if (end == std::string_view::npos) return;
    if (std::string_view(" \t\r\n/>").find(xml[at]) == std::string_view::npos) continue;
    if (xml[end - 1] == '/') {
      use(xml.substr(at, end - at), std::string_view());
      continue;
    }
    const std::size_t last = std::min(xml.find(close, end), xml.size());
    use(xml.substr(at, end - at), xml.substr(end + 1, last - end - 1));
  }
}

}  // namespace

DigitLoss lost_digits(std::string_view text) {
  constexpr std::string_view kNumber = "+-.0123456789eE";
  DigitLoss loss;
  while (true) {
    const std::size_t begin = text.find_first_of("+-.0123456789");
    if (begin == std::string_view::npos) return loss;
    text.remove_prefix(begin);
    const std::size_t length = std::min(text.find_first_not_of(kNumber), text.size());
    const std::string_view word = text.substr(0, length);
    text.remove_prefix(length);
    const auto exact = real_number(word);
    if (!exact || !std::isfinite(*exact)) continue;
    const double change = std::fabs(*exact - double(static_cast<float>(*exact)));
    // `exact` is itself rounded to double, which must not push a change of just half a unit over
    // it.
    if (!(change > half_unit(word) + std::ldexp(std::fabs(*exact), -52))) continue;
    ++loss.numbers;
    loss.largest = std::max(loss.largest, change);
  }
}

DigitLoss lost_digits_of_collada(std::string_view xml) {
  DigitLoss loss;
  std::string positions = " ";  // ids of sources
  for_each_tag(xml, "input", [&](std::string_view tag, std::string_view) {
    const std::string_view source = attribute(tag, "source");
    if (attribute(tag, "semantic") == "POSITION" && source.starts_with('#')) {
      positions += fmt::format("{} ", source.substr(1));
    }
  });
  for_each_tag(xml, "source", [&](std::string_view tag, std::string_view content) {
    const std::string id = fmt::format(" {} ", attribute(tag, "id"));
    if (positions.find(id) == std::string::npos) return;
    for_each_tag(content, "float_array", [&](std::string_view, std::string_view numbers) {
      add(loss, lost_digits(numbers));
    });
  });
  for (const char* place : {"matrix", "translate"}) {
    for_each_tag(xml, place, [&](std::string_view, std::string_view numbers) {
      add(loss, lost_digits(numbers));
    });
  }
  return loss;
}

DigitLoss lost_digits_of_ifc(std::string_view step) {
  constexpr std::string_view kPoint = "IFCCARTESIANPOINT";
  DigitLoss loss;
  for (std::size_t at = 0; (at = step.find(kPoint, at)) != std::string_view::npos;) {
    at += kPoint.size();
    const std::size_t end = std::min(step.find(';', at), step.size());
    add(loss, lost_digits(step.substr(at, end - at)));
    at = end;
  }
  return loss;
}

}  // namespace gnomon
