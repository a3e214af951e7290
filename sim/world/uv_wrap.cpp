#include "sim/world/uv_wrap.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace sim {
namespace {

// A vertex at t between two others.
std::uint32_t AppendBetween(Mesh& mesh, std::uint32_t a, std::uint32_t b, double t) {
  const auto blend = [&](auto& values) {
    if (values.empty()) return;
    using Vector = std::remove_cvref_t<decltype(values[0])>;
    values.push_back(static_cast<float>(1 - t) * Vector(values[a]) + static_cast<float>(t) * Vector(values[b]));
  };
  blend(mesh.positions);
  blend(mesh.normals);
  blend(mesh.uvs);
  blend(mesh.colors);
  if (!mesh.normals.empty()) mesh.normals.back() = glm::normalize(mesh.normals.back());
  return static_cast<std::uint32_t>(mesh.positions.size()) - 1;
}

// Cuts all triangles along the line on which the coordinate is `at`.
void Cut(Mesh& mesh, int axis, float at) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_of;  // by edge, the lower vertex first
  const auto side = [&](std::uint32_t vertex) {
    const float apart = mesh.uvs[vertex][axis] - at;
    return apart > 1e-6f ? 1 : apart < -1e-6f ? -1 : 0;
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [entry, is_new] = middle_of.try_emplace({a, b}, 0);
    if (is_new) {
      const double from = mesh.uvs[a][axis], to = mesh.uvs[b][axis];
      entry->second = AppendBetween(mesh, a, b, (at - from) / (to - from));
      mesh.uvs.back()[axis] = at;
    }
    return entry->second;
  };
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const int sides[3] = {side(t[0]), side(t[1]), side(t[2])};
    if (std::max({sides[0], sides[1], sides[2]}) <= 0 || std::min({sides[0], sides[1], sides[2]}) >= 0) continue;
    // The corner that is the only one on its side of the line, or on the line.
    int alone = 0;
    for (int k = 0; k < 3; ++k) {
      const int next = sides[(k + 1) % 3], last = sides[(k + 2) % 3];
      if (sides[k] == 0 || next == last) alone = k;
    }
    const std::uint32_t a = t[alone], b = t[(alone + 1) % 3], c = t[(alone + 2) % 3];
    if (sides[alone] == 0) {
      const std::uint32_t bc = middle(b, c);
      mesh.triangles[i] = {a, b, bc};
      mesh.triangles.push_back({a, bc, c});
    } else {
      const std::uint32_t ab = middle(a, b), ca = middle(a, c);
      mesh.triangles[i] = {a, ab, ca};
      mesh.triangles.push_back({ab, b, c});
      mesh.triangles.push_back({ab, c, ca});
    }
  }
}

}  // namespace

bool WrapUvs(Mesh& mesh, int axis, UvWrap wrap, int texels) {
  if (wrap == UvWrap::repeat || mesh.uvs.empty()) return true;
  // Half a texel inside the edges, where the interpolation begins to reach over them.
  const float edge = 0.5f / static_cast<float>(texels);
  const auto less = [axis](const glm::vec2& a, const glm::vec2& b) { return a[axis] < b[axis]; };
  const auto [low, high] = std::ranges::minmax_element(mesh.uvs, less);
  const float first = (*low)[axis], last = (*high)[axis];
  const bool mirror = wrap == UvWrap::mirror;
  constexpr float kMostCopies = 100;
  if (mirror && !(last - first < kMostCopies)) return false;
  const int from = mirror ? static_cast<int>(std::floor(first)) : 0,
            to = mirror ? static_cast<int>(std::floor(last)) : 0;
  for (int copy = from; copy <= to; ++copy) {
    for (const float at : {static_cast<float>(copy) + edge, static_cast<float>(copy + 1) - edge}) {
      if (at > first && at < last) Cut(mesh, axis, at);
    }
  }
  for (glm::vec2& uv : mesh.uvs) {
    float& c = uv[axis];
    const float whole = std::floor(c), part = c - whole;
    if (mirror) c = static_cast<std::int64_t>(whole) % 2 == 0 ? part : 1 - part;
    c = std::clamp(c, edge, 1 - edge);
  }
  return true;
}

}  // namespace sim
