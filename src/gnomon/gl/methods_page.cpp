#include <gnomon/gl/methods_page.h>

#include <algorithm>
#include <functional>
#include <vector>

#include <gnomon/gl/mask_bounds.h>
#include <gnomon/gl/method.h>

namespace gnomon::gl {
namespace {

constexpr const char* kHead = R"(# Shadow methods: what goes together

Made by `gnomon methods`; a test compares. Every cell is an answer of `gl::decide()` (src/gnomon/gl/method.cpp), the one function that the
renderer asks too: *yes*, or *no* with the number of the reason, word for word, at the end of the page. Names are those of `gnomon render`
and of src/gnomon/gl/method.h. What "the same mask" means, and how well it is kept: [verification-gl.md](verification-gl.md).

## How to choose

- **Take the defaults** (`--method stencil --count auto`): any caster, any light, any camera, and the fastest on most graphics cards. z-pass draws the
  least; z-fail is taken for just those casters that may stand between the near plane and the light. `--count mixed` decides so for each lit region of a
  caster: less to draw where one large mesh is the whole scene and the eye is in its shadow.
- **No stencil buffer** in somebody else's framebuffer: `--method alpha` keeps the mask in the alpha channel. No alpha channel either:
  `--method screen`, in a framebuffer of ours; the scene is drawn once more.
- Alpha and screen masks count in powers of two. Closed convex casters fit in 8 bits; all others need floats as a colour format, 32 bits (about 120
  shadows over each other in a pixel) or 16 bits (about 14). What does not fit is an error, never a wrong picture.
- **Many lights, or a slow card**: `--mask-scale 0.5` or `0.25` draws the mask smaller and magnifies it; edges are softer and less exact.
- **Old-fashioned casters**: `--extrusion cpu`, where a vertex shader is dear; `blend-large` where a point at infinity (w = 0) is not to be had: its finite
  volumes end at 16777216 times the distance from the light.
- **Reach**: volumes end in a plane beyond the scene where there is one (`--reach auto`): less to fill, and z-fail needs no points at infinity.
- **Parallel views** (plans, axonometries) need depth clamp: their far plane cannot be at infinity.
- `zp-plus` and `near-cap` are there to be compared with: z-pass whose start is counted at the near plane.
- The first paper's single light (`--shadows black`, `ambient`, `attenuated`) or lights that add up (`lights`): the mask is the same.
)";

struct Case {
  Method method;
  Situation situation;
  Capabilities capabilities;
};

struct Choice {
  std::string name;
  std::function<void(Case&)> set;
};
struct Axis {
  std::string title;
  std::vector<Choice> choices;
};

struct Row {
  std::vector<std::string> labels, cells;
  bool operator==(const Row&) const = default;
};
using Rows = std::vector<Row>;
using Cell = std::function<std::string(const Case&)>;

bool possible(const Case& c) {
  return !c.situation.light_along_view ||
         (c.situation.parallel_view && c.situation.directional_light);
}

// A cell of the tables of what degrades: refused with the capability too. Rows of nothing else are
// left out, and then make no difference between the choices that they belong to.
const std::string kRefusedAnyway = "-";

// Reasons in the order in which they come up.
class Notes {
 public:
  std::string operator()(const std::string& reason) {
    auto at = std::find(reasons_.begin(), reasons_.end(), reason);
    if (at == reasons_.end()) at = reasons_.insert(at, reason);
    return "no (" + std::to_string(at - reasons_.begin() + 1) + ")";
  }
  std::string text() const {
    std::string out;
    for (std::size_t k = 0; k < reasons_.size(); ++k)
      out += std::to_string(k + 1) + ". " + reasons_[k] + "\n";
    return out;
  }

 private:
  std::vector<std::string> reasons_;
};

// One row for each choice on every axis; choices that make no difference share their rows.
Rows rows_of(const std::vector<Axis>& axes, std::size_t first, const std::vector<Choice>& columns,
             const Case& from, const Cell& cell) {
  if (first == axes.size()) {
    if (!possible(from)) return {};
    Row row;
    bool any = false;
    for (const Choice& column : columns) {
      Case c = from;
      column.set(c);
      row.cells.push_back(cell(c));
      any |= row.cells.back() != kRefusedAnyway;
    }
    return any ? Rows{row} : Rows{};
  }
  std::vector<std::pair<std::string, Rows>> groups;
  for (const Choice& choice : axes[first].choices) {
    Case c = from;
    choice.set(c);
    Rows rows = rows_of(axes, first + 1, columns, c, cell);
    if (rows.empty()) continue;
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& group) { return group.second == rows; });
    if (same == groups.end()) {
      groups.emplace_back(choice.name, std::move(rows));
    } else {
      same->first += "; " + choice.name;
    }
  }
  Rows out;
  for (auto& [name, rows] : groups) {
    for (Row& row : rows) {
      row.labels.insert(row.labels.begin(),
                        groups.size() == 1 && axes[first].choices.size() > 1 ? "any" : name);
      out.push_back(std::move(row));
    }
  }
  return out;
}

std::string table(const std::vector<Axis>& axes, const std::vector<Choice>& columns,
                  const Rows& rows) {
  std::string head = "|", rule = "|";
  for (const Axis& axis : axes) head += " " + axis.title + " |", rule += "---|";
  for (const Choice& column : columns) head += " " + column.name + " |", rule += "---|";
  std::string text = head + "\n" + rule + "\n";
  for (const Row& row : rows) {
    text += "|";
    for (const std::string& label : row.labels) text += " " + label + " |";
    for (const std::string& c : row.cells) text += " " + c + " |";
    text += "\n";
  }
  return text;
}

template <class T>
std::vector<Choice> choices_of(T Method::*member, std::initializer_list<T> values) {
  std::vector<Choice> out;
  for (const T value : values) {
    out.push_back({std::string(name_of(value)), [=](Case& c) { c.method.*member = value; }});
  }
  return out;
}

std::vector<Choice> masks() {
  return choices_of(&Method::mask, {MaskIn::stencil, MaskIn::alpha, MaskIn::screen});
}
std::vector<Choice> counts() {
  return choices_of(&Method::count, {Count::z_pass, Count::z_fail, Count::near_cap, Count::zp_plus,
                                     Count::automatic, Count::mixed});
}
std::vector<Choice> volumes() {
  return choices_of(&Method::volumes, {VolumesOf::caster, VolumesOf::polygon});
}

const Axis kFramebuffer{"framebuffer",
                        {{"stencil and alpha", [](Case&) {}},
                         {"no stencil", [](Case& c) { c.situation.target_stencil = false; }},
                         {"no alpha", [](Case& c) { c.situation.target_alpha = false; }}}};
const Axis kView{
    "view",
    {{"perspective", [](Case&) {}},
     {"perspective, finite far plane", [](Case& c) { c.situation.infinite_view = false; }},
     {"parallel",
      [](Case& c) {
        c.situation.parallel_view = true;
        c.situation.infinite_view = false;
      }},
     {"parallel, exactly along the sun", [](Case& c) {
        c.situation.parallel_view = true;
        c.situation.infinite_view = false;
        c.situation.light_along_view = true;
      }}}};
const Axis kLight{"light",
                  {{"sun", [](Case& c) { c.situation.directional_light = true; }},
                   {"lamp", [](Case& c) { c.situation.directional_light = false; }}}};
const Axis kNear{
    "between near plane and light",
    {{"nothing", [](Case&) {}}, {"casters", [](Case& c) { c.situation.near_shaded = true; }}}};
const Axis kBound{
    "plane beyond the scene",
    {{"none", [](Case&) {}}, {"there is one", [](Case& c) { c.situation.can_bound = true; }}}};
const Axis kCasters{"casters",
                    {{"closed and convex", [](Case&) {}},
                     {"any", [](Case& c) { c.situation.all_convex = false; }}}};

Case everything() {
  Case c;
  c.capabilities.depth_clamp = c.capabilities.depth_bounds = true;
  c.capabilities.float_colour = c.capabilities.float_blend = true;
  c.capabilities.max_samples = 8;
  return c;
}

std::string main_tables(Notes& notes) {
  const Cell cell = [&](const Case& c) {
    const Result<Method> m = decide(c.method, c.situation, c.capabilities);
    return m ? std::string("yes") : notes(m.error().message);
  };
  std::string text =
      "\n## Mask, count, light, caster, target\n\nOther choices as they are by default. \"any\": "
      "makes no difference to the cells of the row.\n";
  for (const Choice& mask : masks()) {
    Case c = everything();
    mask.set(c);
    const std::vector<Axis> axes{kFramebuffer, kView, kLight, kNear, kBound, kCasters};
    text +=
        "\n### " + mask.name + "\n\n" + table(axes, counts(), rows_of(axes, 0, counts(), c, cell));
  }
  return text;
}

std::string other_tables(Notes& notes) {
  // Over every situation: yes, no with its reasons, or both.
  // What stands near the light and parallel views along it are the main tables' matter.
  Axis view = kView;
  view.choices.pop_back();
  const auto outcome = [&](const Axis& row, const Case& from) {
    std::vector<Axis> situations{view, kLight, kBound, kCasters};
    std::erase_if(situations, [&](const Axis& axis) { return axis.title == row.title; });
    bool good = false;
    std::vector<std::string> refused;
    const Cell ask = [&](const Case& c) {
      const Result<Method> m = decide(c.method, c.situation, c.capabilities);
      good |= bool(m);
      if (!m && std::find(refused.begin(), refused.end(), m.error().message) == refused.end())
        refused.push_back(m.error().message);
      return std::string();
    };
    rows_of(situations, 0, {{"", [](Case&) {}}}, from, ask);
    std::string text = good ? "yes" : "";
    for (const std::string& reason : refused) text += (text.empty() ? "" : ", or ") + notes(reason);
    return text;
  };
  const auto pair = [&](const std::string& title, const Axis& axis,
                        const std::vector<Choice>& columns, MaskIn mask) {
    Case c = everything();
    c.method.mask = mask;
    const Cell cell = [&](const Case& each) { return outcome(axis, each); };
    return "\n" + title + "\n\n" + table({axis}, columns, rows_of({axis}, 0, columns, c, cell));
  };
  std::string text =
      "\n## Choices besides\n\nOver every view, light and caster: \"yes, or no\" depends on these, "
      "as the reason says.\n";
  text += pair("Stencil passes against stencil operations:",
               {"--stencil-passes",
                choices_of(&Method::passes, {StencilPasses::two_sided, StencilPasses::culled})},
               choices_of(&Method::ops, {StencilOps::wrap, StencilOps::saturate}), MaskIn::stencil);
  text += pair("Arithmetic against mask:",
               {"--arithmetic",
                choices_of(&Method::arithmetic, {Arithmetic::doubling, Arithmetic::maximum})},
               masks(), MaskIn::alpha);
  const std::vector<Choice> shadows = choices_of(
      &Method::shadows,
      {Shadows::automatic, Shadows::lights, Shadows::black, Shadows::ambient, Shadows::attenuated});
  text += pair("Arithmetic of alpha and screen masks against what a shadow is:",
               {"--arithmetic",
                choices_of(&Method::arithmetic, {Arithmetic::doubling, Arithmetic::maximum})},
               shadows, MaskIn::alpha);
  text += pair(
      "Number of lights against what a shadow is:",
      {"lights", {{"one", [](Case&) {}}, {"several", [](Case& c) { c.situation.lights = 2; }}}},
      shadows, MaskIn::stencil);
  text +=
      pair("Volumes against count, stencil:", {"--volumes", volumes()}, counts(), MaskIn::stencil);
  text += pair("Volumes against count, alpha and screen:", {"--volumes", volumes()}, counts(),
               MaskIn::alpha);
  const std::vector<Choice> primitives =
      choices_of(&Method::primitives, {Primitives::quads, Primitives::strips, Primitives::fans});
  text += pair("Light against primitives:", kLight, primitives, MaskIn::stencil);
  const std::vector<Choice> reaches =
      choices_of(&Method::reach, {Reach::automatic, Reach::infinite, Reach::bounded});
  text += pair("Reach against primitives, sun and lamp:", {"--reach", reaches}, primitives,
               MaskIn::stencil);
  text += pair("Plane beyond the scene against reach:", kBound, reaches, MaskIn::stencil);
  text +=
      pair("Volumes against primitives:", {"--volumes", volumes()}, primitives, MaskIn::stencil);
  text += pair(
      "View against far plane:", kView,
      choices_of(&Method::far_plane, {FarPlane::automatic, FarPlane::infinite, FarPlane::clamp}),
      MaskIn::stencil);
  text += pair("Reach against extrusion:", {"--reach", reaches},
               choices_of(&Method::extrusion, {Extrusion::cpu, Extrusion::shader, Extrusion::blend,
                                               Extrusion::blend_large}),
               MaskIn::stencil);
  text += pair(
      "Number of lights against what a shadow is, alpha:",
      {"lights", {{"one", [](Case&) {}}, {"several", [](Case& c) { c.situation.lights = 2; }}}},
      shadows, MaskIn::alpha);
  text += pair("View against extrusion:", view,
               choices_of(&Method::extrusion, {Extrusion::cpu, Extrusion::shader, Extrusion::blend,
                                               Extrusion::blend_large}),
               MaskIn::stencil);
  const std::vector<Choice> samples{{"1 sample", [](Case&) {}},
                                    {"4 samples", [](Case& c) { c.method.samples = 4; }},
                                    {"64 samples", [](Case& c) { c.method.samples = 64; }}};
  const Axis scales{"--mask-scale",
                    {{"1", [](Case&) {}}, {"0.5", [](Case& c) { c.method.mask_scale = 0.5; }}}};
  text += pair("Size of the mask against samples a pixel (8 at most here), stencil:", scales,
               samples, MaskIn::stencil);
  text += pair("The same, alpha and screen:", scales, samples, MaskIn::alpha);
  return text;
}

// Words of `now` that `before` has not.
std::string new_words(const std::string& before, const std::string& now) {
  const auto words = [](const std::string& text) {
    std::vector<std::string> out;
    std::size_t from = 0;
    while (from <= text.size()) {
      const std::size_t end = std::min(text.find(", ", from), text.size());
      out.push_back(text.substr(from, end - from));
      from = end + 2;
    }
    return out;
  };
  const std::vector<std::string> old = words(before);
  std::string text;
  for (const std::string& word : words(now)) {
    if (std::find(old.begin(), old.end(), word) == old.end())
      text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

std::string poorer_tables(Notes& notes) {
  std::string text = R"(
## What degrades on OpenGL ES 3 and WebGL 2

OpenGL 3.3 has all of these but depth bounds. OpenGL ES 3.0 has depth clamp with EXT_depth_clamp, floats as colours with
EXT_color_buffer_float (half floats: EXT_color_buffer_half_float), blending of 32-bit floats with EXT_float_blend; WebGL 2 has the extensions of the
same names, which must be asked for. Only rows that change are shown, and in them only cells that change (-: refused anyway); `gnomon render --without NAME` shows the same with a real context.
)";
  Axis view = kView;
  view.choices.pop_back();
  std::vector<Axis> axes{
      view,
      {"--far",
       choices_of(&Method::far_plane, {FarPlane::automatic, FarPlane::infinite, FarPlane::clamp})},
      kCasters,
      {"--count", counts()},
      {"--volumes", volumes()}};
  for (const std::string name :
       {"depth-clamp", "float-blend", "float-colour", "depth-bounds", "multisampling"}) {
    const Cell cell = [&](const Case& c) -> std::string {
      const Result<Method> before = decide(c.method, c.situation, c.capabilities);
      const Result<Method> now =
          decide(c.method, c.situation, without(c.capabilities, name).value());
      if (!before) return kRefusedAnyway;
      if (!now) return notes(now.error().message);
      return new_words(describe(before.value()), describe(now.value()));
    };
    if (name == "multisampling")
      axes.push_back({"--samples", {{"4", [](Case& c) { c.method.samples = 4; }}}});
    Rows rows = rows_of(axes, 0, masks(), everything(), cell);
    std::erase_if(rows, [](const Row& row) {
      return std::all_of(row.cells.begin(), row.cells.end(),
                         [](const std::string& c) { return c.empty() || c == kRefusedAnyway; });
    });
    text += "\n### Without " + name + "\n\n";
    text += rows.empty() ? "Every cell stays as it is.\n" : table(axes, masks(), rows);
  }
  return text;
}

// Without trailing zeros.
std::string number(double v) {
  std::string text = std::to_string(v);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string bounds_table() {
  std::string text = R"(
## How exact

What `gnomon verify-gl` and the tests hold every method to (src/gnomon/gl/mask_bounds.cpp). A sample may differ from the exact mask where its answer is
exact within so many pixels of it, or where sides of shadow volumes lie within so many steps of a 24-bit depth buffer of it, plus what their slopes
make of so much of a pixel; a side that passes as close by a sample may cover it or not, and one that is seen edge-on has every depth
([renderer-limits.md](renderer-limits.md#sides-seen-edge-on)). Samples whose surface lies in one plane with the light (to 2^-20) are left out: no light falls on them.
The stencil's mask: under the same camera, reach and primitives. The share leaves out samples that lie on an edge to a 256th of a pixel, to which rasterizers
round corners: where an edge runs along a row of pixel centres, a whole row does. At half and quarter size half of the samples with an edge within so many
pixels may differ if that is more: an answer from another place is right half of the time where both are as frequent.

| methods | may differ, % of a picture | pixels | steps | and slopes over pixels | without such a reason | other than the stencil's mask | because |
|---|--:|--:|--:|--:|---|---|---|
)";
  for (const MaskBound& b : mask_bounds()) {
    text += "| " + std::string(b.of) + " | " + number(100 * b.share) + " | " + number(b.edge) +
            " | " + number(b.steps) + " | " + number(b.pixels) + " | " +
            (b.unexplained ? "within the share" : "none") + " | " +
            (b.same_as_stencil ? "not one pixel" : "within the share") + " | " +
            std::string(b.why) + " |\n";
  }
  return text;
}

}  // namespace

std::string methods_page() {
  Notes notes;
  std::string text = kHead;
  text += main_tables(notes);
  text += other_tables(notes);
  text += poorer_tables(notes);
  text += bounds_table();
  return text + "\n## Reasons\n\n" + notes.text();
}

}  // namespace gnomon::gl
