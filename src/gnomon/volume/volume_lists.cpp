#include <gnomon/volume/volume_lists.h>

#include <algorithm>
#include <cstdlib>

namespace gnomon {
namespace {

std::uint32_t near_vertex(std::uint32_t v) { return 2 * v; }
std::uint32_t far_vertex(std::uint32_t v) { return 2 * v + 1; }

bool is_grazed(const GrazedEdges& grazed, std::uint32_t a, std::uint32_t b) {
  return !grazed.empty() &&
         std::binary_search(grazed.begin(), grazed.end(),
                            std::array<std::uint32_t, 2>{std::min(a, b), std::max(a, b)});
}

// The side over the edge (a, b), counterclockwise where it is entered if it is not turned. Both
// halves meet in the diagonal from a to b at infinity; a strip along a loop splits its quads in the
// same way.
void push_side(VolumeLists& lists, std::uint32_t a, std::uint32_t b, bool turned, bool one_point,
               std::span<const std::uint8_t> beyond, const GrazedEdges& grazed) {
  const bool grazing = is_grazed(grazed, a, b);
  std::vector<std::uint32_t>& list =
      lists.lists[turned ? (grazing ? kGrazingSidesTurned : kSidesTurned)
                         : (grazing ? kGrazingSides : kSides)];
  if (one_point) {
    list.insert(list.end(), {far_vertex(a), near_vertex(a), near_vertex(b)});
  } else {
    const bool no_a = !beyond.empty() && beyond[a] != 0;
    const bool no_b = !beyond.empty() && beyond[b] != 0;
    std::vector<std::uint32_t>& behind = lists.lists[turned ? kDarkCapTurned : kDarkCap];
    std::vector<std::uint32_t>& lower = no_a ? behind : list;
    std::vector<std::uint32_t>& upper = no_a && no_b ? behind : list;
    lower.insert(lower.end(), {far_vertex(a), near_vertex(a), far_vertex(b)});
    upper.insert(upper.end(), {far_vertex(b), near_vertex(a), near_vertex(b)});
  }
}

void push_caps(VolumeLists& lists, const Triangle& t, std::int8_t light_side, bool one_point) {
  auto& near_cap = lists.lists[light_side < 0 ? kLightCap : kLightCapTurned];
  near_cap.insert(near_cap.end(), {near_vertex(t[0]), near_vertex(t[1]), near_vertex(t[2])});
  if (one_point) return;
  // The dark cap is left where the light cap is entered.
  auto& far_cap = lists.lists[light_side < 0 ? kDarkCapTurned : kDarkCap];
  far_cap.insert(far_cap.end(), {far_vertex(t[0]), far_vertex(t[1]), far_vertex(t[2])});
}

Volume begin_volume(const VolumeLists& lists, std::uint32_t caster) {
  Volume v;
  v.caster = caster;
  for (int k = 0; k < kListKinds; ++k)
    v.lists[k].first = static_cast<std::uint32_t>(lists.lists[k].size());
  return v;
}

void end_volume(VolumeLists& lists, Volume v) {
  for (int k = 0; k < kListKinds; ++k)
    v.lists[k].count = static_cast<std::uint32_t>(lists.lists[k].size()) - v.lists[k].first;
  lists.volumes.push_back(v);
}

// Each run of edges of one kind in one piece: a whole loop where all are.
void push_loops(VolumeLists& lists, const Loops& loops, SideForm form, const GrazedEdges& grazed) {
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const std::span<const std::uint32_t> loop = loops.loop(k);
    std::vector<std::uint32_t>* list = nullptr;
    const auto push = [&](std::uint32_t v) {
      if (form == SideForm::strips) list->push_back(far_vertex(v));
      list->push_back(near_vertex(v));
    };
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      std::vector<std::uint32_t>* to =
          &lists.lists[is_grazed(grazed, a, b) ? kGrazingSides : kSides];
      if (to != list) {
        if (list != nullptr) list->push_back(kRestart);
        list = to;
        if (form == SideForm::fans) list->push_back(far_vertex(a));
        push(a);
      }
      push(b);
    }
    if (list != nullptr) list->push_back(kRestart);
  }
}

}  // namespace

void find_silhouette_of_few(Silhouette& out, const TriMesh& mesh,
                            std::span<const std::uint32_t> triangles,
                            std::span<const std::int8_t> sides, Casting casting) {
  Silhouette edges;  // each once for every triangle at it
  edges.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles) {
    if (!casts(casting, sides[t])) continue;
    const Triangle& v = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k], b = v[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? sides[t] : -sides[t]});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const SilhouetteEdge& x, const SilhouetteEdge& y) {
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  for (std::size_t k = 0; k < edges.size();) {
    SilhouetteEdge sum{edges[k].a, edges[k].b, 0};
    for (; k < edges.size() && edges[k].a == sum.a && edges[k].b == sum.b; ++k)
      sum.multiplicity += edges[k].multiplicity;
    if (sum.multiplicity != 0) out.push_back(sum);
  }
}

void append_volume(VolumeLists& lists, const TriMesh& mesh,
                   std::span<const SilhouetteEdge> silhouette,
                   std::span<const std::uint32_t> triangles, std::span<const std::int8_t> sides,
                   bool one_point, Casting casting, SideForm form, std::uint32_t caster,
                   std::span<const std::uint8_t> beyond, LoopScratch& scratch,
                   const GrazedEdges& grazed) {
  const Volume volume = begin_volume(lists, caster);
  if (form == SideForm::triangles) {
    // The weight of the side over (a, b, b at infinity, a at infinity) is minus the multiplicity,
    // and a polygon of weight -1 counts +1 where it is seen counterclockwise (shadow_volume.h).
    for (const SilhouetteEdge& e : silhouette) {
      for (int i = 0; i < std::abs(e.multiplicity); ++i)
        push_side(lists, e.a, e.b, e.multiplicity < 0, one_point, beyond, grazed);
    }
  } else {
    push_loops(lists, find_loops(silhouette, &scratch), form, grazed);
  }
  for (const std::uint32_t t : triangles) {
    if (casts(casting, sides[t])) push_caps(lists, mesh.triangles[t], sides[t], one_point);
  }
  end_volume(lists, volume);
}

void append_prism(VolumeLists& lists, const TriMesh& mesh, std::uint32_t triangle,
                  std::int8_t light_side, bool one_point, std::uint32_t caster,
                  std::span<const std::uint8_t> beyond, const GrazedEdges& grazed) {
  Volume volume = begin_volume(lists, caster);
  const Triangle& t = mesh.triangles[triangle];
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t a = t[i], b = t[(i + 1) % 3];
    push_side(lists, std::min(a, b), std::max(a, b), (a < b) != (light_side > 0), one_point, beyond,
              grazed);
  }
  push_caps(lists, t, light_side, one_point);
  end_volume(lists, volume);
}

}  // namespace gnomon
