// Lights and views that try a model from all sides, chosen to meet the hard cases: ties, low suns,
// lights in a triangle's plane and at a vertex, an eye inside the shadow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gnomon/trace/exact_count.h>
#include <gnomon/view/view.h>

namespace gnomon {

struct NamedLight {
  std::string name;  // a few words
  Light light;
};

struct NamedView {
  std::string name;
  View view;
};

// `count` suns. The first eight: 3, 45, 10, 70 and 25 degrees high from different sides, vertical,
// at 45 degrees exactly along the x axis, in the plane of one of the model's triangles; then more,
// spread evenly by azimuth and altitude.
std::vector<NamedLight> choose_suns(const Scene& scene, int count);

// `count` point lights. The first four: above the model, low between its parts, within its box,
// exactly at one of its vertices; then more at other vertices.
std::vector<NamedLight> choose_points(const Oracle& oracle, int count);

// The whole model from above, size x size samples.
NamedView whole_plan(const Scene& scene, int size);

// A camera outside, looking down on the model from the south-west.
NamedView aerial_camera(const Scene& scene, int size);

// A camera near the ground whose eye is in the shadow of `light`: casters_before_eye() > 0. Empty
// where nothing near the model's middle is in shadow.
std::optional<NamedView> shaded_camera(const Oracle& oracle, const Light& light, int size);

// C(e) of DEFINITIONS: the number of casters crossed by the segment from the eye to the light, by
// the oracle's own predicates.
std::int32_t casters_before_eye(const Oracle& oracle, const View& view, const Light& light,
                                ExactStats* stats = nullptr);

}  // namespace gnomon
