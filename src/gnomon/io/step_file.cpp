#include <fmt/format.h>
#include <gnomon/io/read_text.h>
#include <gnomon/io/step_file.h>
#include <gnomon/io/step_string.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace gnomon {
namespace {

constexpr int kDeepest = 100;  // lists in lists; IFC nests 3: hostile files would fill the stack

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }

// A place in the text. Every function that reads returns false with `error` set where it cannot;
// `at` is then where the error is.
struct Cursor {
  std::string_view text;
  std::size_t at = 0;
  std::string error = {};
  std::vector<std::uint64_t>* references = nullptr;  // collects them, if wanted

  bool fail(std::string what) {
    error = std::move(what);
    return false;
  }
  // What stands here, for messages.
  std::string here() const {
    if (at >= text.size()) return "the end of the file";
    return in_quotes(text.substr(at, text.substr(at).find_first_of("\r\n")), 30);
  }
  char next() const { return at < text.size() ? text[at] : '\0'; }

  // White space and comments.
  bool skip() {
    for (;;) {
      while (at < text.size() && (text[at] == ' ' || (text[at] >= '\t' && text[at] <= '\r'))) ++at;
      if (!text.substr(at).starts_with("/*")) return true;
      const std::size_t end = text.find("*/", at + 2);
      if (end == std::string_view::npos)
        return fail("the comment does not end; the file may be cut off.");
      at = end + 2;
    }
  }
  bool expect(std::string_view token, std::string_view after) {
    if (!skip()) return false;
    if (!text.substr(at).starts_with(token)) {
      return fail(fmt::format("{} stands where {} should follow {}.", here(), token, after));
    }
    at += token.size();
    return true;
  }
  // True if `token` is next; then it is read.
  bool take(std::string_view token) {
    if (!text.substr(at).starts_with(token)) return false;
    at += token.size();
    return true;
  }

  std::string_view keyword() {
    const std::size_t begin = at;
    if (next() == '!') ++at;  // of a user's own entity
    while (is_letter(next()) || (at > begin && (is_digit(next()) || next() == '-'))) ++at;
    return text.substr(begin, at - begin);
  }
  bool id(std::uint64_t& value) {  // after the #
    const auto [end, code] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (code != std::errc()) return fail(fmt::format("{} is not the number of an entity.", here()));
    at = static_cast<std::size_t>(end - text.data());
    return true;
  }
  bool number(StepValue* out) {
    std::size_t begin = at;
    if (text[begin] == '+') ++begin;
    double value = 0;
    const auto [end, code] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
    const bool digits = begin < text.size() && (is_digit(text[begin]) || text[begin] == '-');
    if (code != std::errc() || !digits || !std::isfinite(value)) {
      return fail(fmt::format("{} is not a finite number.", here()));
    }
    at = static_cast<std::size_t>(end - text.data());
    if (next() == '#' || is_letter(next())) {  // 1.#QNAN
      at = begin;
      return fail(fmt::format("{} is not a number.", here()));
    }
    if (out) {
      out->kind = StepValue::Kind::kNumber;
      out->number = value;
    }
    return true;
  }
  bool string(StepValue* out) {
    const std::size_t begin = at + 1;
    std::size_t end = begin;
    for (;; end += 2) {
      end = text.find('\'', end);
      if (end == std::string_view::npos)
        return fail("the string does not end; the file may be cut off.");
      if (!text.substr(end + 1).starts_with('\'')) break;
    }
    if (out) {
      out->kind = StepValue::Kind::kString;
      out->text = decode_step_string(text.substr(begin, end - begin));
    }
    at = end + 1;
    return true;
  }
  // .NAME. or "0FF".
  bool delimited(char by, StepValue::Kind kind, StepValue* out) {
    const std::size_t begin = at + 1;
    std::size_t end = begin;
    while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
    if (end == text.size() || text[end] != by) {
      return fail(fmt::format("{} is not a value.", here()));
    }
    if (out) {
      out->kind = kind;
      out->text = text.substr(begin, end - begin);
    }
    at = end + 1;
    return true;
  }
  bool list(std::vector<StepValue>* out, int depth) {  // at the (
    if (depth > kDeepest) {
      return fail(fmt::format("lists are nested deeper than {}.", kDeepest));
    }
    ++at;
    if (!skip()) return false;
    if (take(")")) return true;
    for (;;) {
      StepValue* item = out ? &out->emplace_back() : nullptr;
      if (!value(item, depth) || !skip()) return false;
      if (take(")")) return true;
      if (!take(",")) {
        return fail(fmt::format("{} stands where a comma or a parenthesis should follow.", here()));
      }
    }
  }
  bool typed(StepValue* out, int depth) {
    const std::string_view name = keyword();
    if (!skip()) return false;
    if (next() != '(') {
      return fail(fmt::format("{} stands where a parenthesis should follow {}.", here(),
                              in_quotes(name, 40)));
    }
    if (out) {
      out->kind = StepValue::Kind::kTyped;
      out->text = name;
    }
    return list(out ? &out->items : nullptr, depth + 1);
  }
  bool value(StepValue* out, int depth) {
    if (!skip()) return false;
    const char c = next();
    if (c == '$' || c == '*') {
      if (out) out->kind = c == '$' ? StepValue::Kind::kNull : StepValue::Kind::kDerived;
      ++at;
      return true;
    }
    if (c == '#') {
      ++at;
      std::uint64_t target = 0;
      if (!id(target)) return false;
      if (references) references->push_back(target);
      if (out) {
        out->kind = StepValue::Kind::kReference;
        out->reference = target;
      }
      return true;
    }
    if (c == '\'') return string(out);
    if (c == '.') return delimited('.', StepValue::Kind::kEnumeration, out);
    if (c == '"') return delimited('"', StepValue::Kind::kBinary, out);
    if (c == '(') {
      if (out) out->kind = StepValue::Kind::kList;
      return list(out ? &out->items : nullptr, depth + 1);
    }
    if (is_digit(c) || c == '-' || c == '+') return number(out);
    if (is_letter(c) || c == '!') return typed(out, depth);
    return fail(fmt::format("{} is not a value.", here()));
  }

  // KEYWORD(...) or, for a complex instance, (A(...)B(...)).
  bool instance(StepInstance& out) {
    if (!skip()) return false;
    const bool complex = next() == '(';
    if (!complex) {
      out.keyword = keyword();
      if (out.keyword.empty()) return fail(fmt::format("{} is not an entity.", here()));
      if (!skip()) return false;
      if (next() != '(') {
        return fail(fmt::format("{} stands where the arguments of {} should follow.", here(),
                                in_quotes(out.keyword, 40)));
      }
    }
    const std::size_t begin = at;
    if (!(complex ? parts(nullptr) : list(nullptr, 1))) return false;
    out.arguments = text.substr(begin, at - begin);
    return expect(";", "the entity");
  }
  bool parts(std::vector<StepValue>* out) {
    ++at;
    for (;;) {
      if (!skip()) return false;
      if (take(")")) return true;
      if (!is_letter(next()) && next() != '!') {
        return fail(fmt::format("{} is not a part of an entity.", here()));
      }
      if (!typed(out ? &out->emplace_back() : nullptr, 1)) return false;
    }
  }
};

bool header(Cursor& c, StepFile& file) {
  for (;;) {
    if (!c.skip()) return false;
    if (c.take("ENDSEC")) return c.expect(";", "ENDSEC");
    StepInstance entity;
    if (!c.instance(entity)) return false;
    if (!same_keyword(entity.keyword, "FILE_SCHEMA")) continue;
    for (const StepValue& names : arguments_of(entity)) {
      for (const StepValue& name : names.items) file.schemas.push_back(name.text);
    }
  }
}

bool data(Cursor& c, StepFile& file) {
  for (;;) {
    if (!c.skip()) return false;
    if (c.take("ENDSEC")) return c.expect(";", "ENDSEC");
    const std::size_t begin = c.at;
    if (!c.take("#")) return c.fail(fmt::format("{} is not an entity.", c.here()));
    StepInstance entity;
    if (!c.id(entity.id)) return false;
    if (!c.expect("=", "the number of an entity") || !c.instance(entity)) return false;
    const auto index = static_cast<std::uint32_t>(file.instances.size());
    if (!file.index.emplace(entity.id, index).second) {
      c.at = begin;
      return c.fail(fmt::format("the number #{} is given twice.", entity.id));
    }
    file.instances.push_back(entity);
  }
}

bool whole_file(Cursor& c, StepFile& file) {
  if (!c.skip()) return false;
  if (!c.take("ISO-10303-21")) {
    return c.fail("this is not a STEP file (such as IFC): it does not start with ISO-10303-21.");
  }
  if (!c.expect(";", "ISO-10303-21") || !c.expect("HEADER", "the first line") ||
      !c.expect(";", "HEADER") || !header(c, file)) {
    return false;
  }
  bool any = false;
  for (;;) {
    if (!c.skip()) return false;
    if (c.take("END-ISO-10303-21")) break;
    if (!c.take("DATA")) {
      return c.fail(fmt::format("{} stands where DATA or END-ISO-10303-21 should.", c.here()));
    }
    any = true;
    if (!c.skip()) return false;
    if (c.next() == '(' && !c.list(nullptr, 1)) return false;  // the section's name, edition 3
    if (!c.expect(";", "DATA") || !data(c, file)) return false;
  }
  if (!any) return c.fail("the file has no DATA section.");
  return c.expect(";", "END-ISO-10303-21");  // what follows would be signatures
}

}  // namespace

bool same_keyword(std::string_view a, std::string_view b) {
  const auto upper = [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [&](char x, char y) { return upper(x) == upper(y); });
}

Result<StepFile> read_step(std::string_view text, const std::string& path) {
  StepFile file;
  file.path = path;
  file.text = text;
  Cursor cursor{text};
  if (whole_file(cursor, file)) return file;
  const std::size_t line = line_of(text, cursor.at);
  if (cursor.at < text.size()) {
    return Error{fmt::format("{}: line {}: {}", path, line, cursor.error)};
  }
  return Error{fmt::format(
      "{}: line {}: the file ends in the middle of a section; it was cut off, so copy or export "
      "it again.",
      path, line)};
}

const StepInstance* find(const StepFile& file, std::uint64_t id) {
  const auto found = file.index.find(id);
  return found == file.index.end() ? nullptr : &file.instances[found->second];
}

std::vector<StepValue> arguments_of(const StepInstance& instance) {
  std::vector<StepValue> values;
  Cursor cursor{instance.arguments};
  if (instance.keyword.empty()) {
    cursor.parts(&values);
  } else {
    cursor.list(&values, 1);
  }
  return values;
}

void references_of(const StepInstance& instance, std::vector<std::uint64_t>& ids) {
  Cursor cursor{instance.arguments};
  cursor.references = &ids;
  if (instance.keyword.empty()) {
    cursor.parts(nullptr);
  } else {
    cursor.list(nullptr, 1);
  }
}

std::string where(const StepFile& file, const StepInstance& instance) {
  const auto offset = static_cast<std::size_t>(instance.arguments.data() - file.text.data());
  return fmt::format("{}: line {}: ", file.path, line_of(file.text, offset));
}

}  // namespace gnomon
