#include <gnomon/io/collada_links.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include <gnomon/io/read_text.h>

namespace gnomon {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

// Takes what is up to `end`, and `end` itself, off the front of `rest`.
std::string_view take_until(std::string_view& rest, std::string_view end) {
  const std::size_t at = rest.find(end);
  const std::string_view taken = rest.substr(0, at);
  rest.remove_prefix(at == rest.npos ? rest.size() : at + end.size());
  return taken;
}

// The inside of the next tag; comments and the like are passed over. Nothing at the end.
std::optional<std::string_view> next_tag(std::string_view& rest) {
  while (!rest.empty()) {
    take_until(rest, "<");
    if (rest.starts_with("!--")) {
      take_until(rest, "-->");
    } else if (rest.starts_with("![CDATA[")) {
      take_until(rest, "]]>");
    } else if (!rest.empty()) {
      // A ">" within the quotes of an attribute does not end the tag.
      char quote = 0;
      std::size_t end = 0;
      for (; end < rest.size(); ++end) {
        const char c = rest[end];
        if (quote != 0) {
          if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
          quote = c;
        } else if (c == '>') {
          break;
        }
      }
      const std::string_view tag = rest.substr(0, end);
      rest.remove_prefix(end);
      return tag;
    }
  }
  return std::nullopt;
}

// The value of an attribute; empty where the tag has none of this name.
std::string_view attribute(std::string_view tag, std::string_view name) {
  tag.remove_prefix(std::min(tag.find_first_of(kSpace), tag.size()));
  while (!tag.empty()) {
    std::string_view key = take_until(tag, "=");
    key.remove_prefix(std::min(key.find_first_not_of(kSpace), key.size()));
    key = key.substr(0, key.find_first_of(kSpace));
    tag.remove_prefix(std::min(tag.find_first_not_of(kSpace), tag.size()));
    if (tag.empty() || (tag[0] != '"' && tag[0] != '\'')) return {};
    const std::string_view quote = tag.substr(0, 1);
    tag.remove_prefix(1);
    const std::string_view value = take_until(tag, quote);
    if (key == name) return value;
  }
  return {};
}

}  // namespace

BrokenLinks broken_links_of_collada(std::string_view xml) {
  std::unordered_set<std::string_view> shapes, nodes;  // ids
  std::vector<std::pair<std::string_view, std::string_view>> links;
  while (const auto tag = next_tag(xml)) {
    const std::string_view element = tag->substr(0, tag->find_first_of(" \t\r\n/"));
    if (element == "geometry" || element == "controller") shapes.insert(attribute(*tag, "id"));
    if (element == "node") nodes.insert(attribute(*tag, "id"));
    if (element == "instance_geometry" || element == "instance_controller" ||
        element == "instance_node") {
      links.emplace_back(element, attribute(*tag, "url"));
    }
  }
  BrokenLinks broken;
  for (const auto& [element, url] : links) {
    const auto& targets = element == "instance_node" ? nodes : shapes;
    if (url.size() > 1 && url[0] == '#' && targets.contains(url.substr(1))) continue;
    if (broken.count++ > 0) continue;
    broken.first = fmt::format("<{} url={}>", element, in_quotes(url, 200));
  }
  return broken;
}

}  // namespace gnomon
