#include <fmt/format.h>
#include <gnomon/core/lower_case.h>
#include <gnomon/io/ifc_check.h>
#include <gnomon/io/read_text.h>

#include <array>
#include <string>
#include <unordered_set>
#include <utility>

namespace gnomon {
namespace {

std::unordered_set<std::string_view> known_names() {
  std::unordered_set<std::string_view> names;
  std::string_view rest = kIfc2x3Names;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    names.insert(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return names;
}

// Relations that lead Assimp from one entity into others: where in their arguments the one and the
// others stand.
struct Relation {
  std::string_view keyword;
  std::size_t from, to;
};
constexpr std::array<Relation, 5> kRelations = {{
    {"IFCRELAGGREGATES", 4, 5},
    {"IFCRELNESTS", 4, 5},
    {"IFCRELCONTAINEDINSPATIALSTRUCTURE", 5, 4},
    {"IFCRELVOIDSELEMENT", 4, 5},
    {"IFCRELFILLSELEMENT", 4, 5},
}};

void append_references(const StepValue& value, std::vector<std::uint64_t>& ids) {
  if (value.kind == StepValue::Kind::kReference) ids.push_back(value.reference);
  for (const StepValue& item : value.items) append_references(item, ids);
}

// Per instance: those that it leads to. Behind the instances stand nodes of relations, so that a
// relation of many with many has not as many edges as pairs.
using Edges = std::vector<std::vector<std::uint32_t>>;

// An instance on a circle; nothing where there is none. The first `instances` nodes are instances;
// no edge leads from one of the others to another.
std::optional<std::uint32_t> on_circle(const Edges& edges, std::size_t instances) {
  enum : char { kNew, kOpen, kDone };
  std::vector<char> state(edges.size(), kNew);
  std::vector<std::pair<std::uint32_t, std::size_t>> path;  // instance, its next edge
  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    if (state[start] != kNew) continue;
    path.assign(1, {start, 0});
    state[start] = kOpen;
    while (!path.empty()) {
      auto& [at, next] = path.back();
      if (next == edges[at].size()) {
        state[at] = kDone;
        path.pop_back();
        continue;
      }
      const std::uint32_t to = edges[at][next++];
      if (state[to] == kOpen && to < instances) return to;
      if (state[to] == kOpen) return at;
      if (state[to] == kNew) {
        state[to] = kOpen;
        path.emplace_back(to, 0);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::string_view ifc_schema(const StepFile& file) {
  for (const std::string& name : file.schemas) {
    if (lower_case(name).starts_with("ifc")) return name;
  }
  return {};
}

std::optional<Error> check_ifc(const StepFile& file) {
  const std::string_view schema = ifc_schema(file);
  if (schema.empty()) {
    return Error{fmt::format("{}: is a STEP file of the schema {}, not IFC.", file.path,
                             file.schemas.empty() ? "\"\"" : in_quotes(file.schemas[0]))};
  }
  const std::string name = lower_case(schema);
  const bool ifc2x3 = name.starts_with("ifc2x3");
  if (!ifc2x3 && !name.starts_with("ifc4")) {
    return Error{fmt::format("{}: its schema is {}; IFC2x3 is read, so export the model as IFC2x3.",
                             file.path, in_quotes(schema))};
  }

  const auto known = known_names();
  std::vector<char> readable;
  readable.reserve(file.instances.size());
  for (const StepInstance& i : file.instances) {
    const std::string keyword = lower_case(i.keyword);
    readable.push_back(keyword.starts_with("ifc") &&
                       known.contains(std::string_view(keyword).substr(3)));
  }
  Edges edges(file.instances.size());
  std::vector<std::uint64_t> ids;
  for (std::size_t k = 0; k < file.instances.size(); ++k) {
    if (!readable[k]) continue;  // left out by Assimp with all that it refers to
    const StepInstance& from = file.instances[k];
    ids.clear();
    references_of(from, ids);
    for (const std::uint64_t id : ids) {
      const auto target = file.index.find(id);
      if (target == file.index.end()) {
        return Error{fmt::format(
            "{}#{} ({}) refers to #{}, which the file does not have; export the model again.",
            where(file, from), from.id, from.keyword, id)};
      }
      const StepInstance& to = file.instances[target->second];
      if (!readable[target->second]) {
        return Error{fmt::format(
            "{}#{} is {}, which IFC2x3 does not have{}; IFC2x3 is read, so export the model as "
            "IFC2x3 (such as \"Coordination View 2.0\").",
            where(file, to), to.id, to.keyword.empty() ? "of several types" : in_quotes(to.keyword),
            ifc2x3 ? "" : fmt::format(" (the file's schema is {})", in_quotes(schema)))};
      }
      edges[k].push_back(target->second);
    }
    for (const Relation& relation : kRelations) {
      if (!same_keyword(from.keyword, relation.keyword)) continue;
      const auto arguments = arguments_of(from);
      if (arguments.size() <= std::max(relation.from, relation.to)) continue;
      std::vector<std::uint64_t> parents, children;
      append_references(arguments[relation.from], parents);
      append_references(arguments[relation.to], children);
      const auto node = static_cast<std::uint32_t>(edges.size());
      edges.emplace_back();
      for (const std::uint64_t id : parents) edges[file.index.at(id)].push_back(node);
      for (const std::uint64_t id : children) edges[node].push_back(file.index.at(id));
    }
  }
  if (const auto k = on_circle(edges, file.instances.size())) {
    const StepInstance& i = file.instances[*k];
    return Error{fmt::format("{}#{} ({}) contains itself; export the model again.", where(file, i),
                             i.id, i.keyword)};
  }
  return std::nullopt;
}

}  // namespace gnomon
