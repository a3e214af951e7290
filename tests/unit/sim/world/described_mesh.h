// Meshes of a few faces with all that a file may say of them, and what of it a scene has else.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "sim/world/scene.h"
#include "sim/world/texture.h"
#include "tests/unit/sim/world/files.h"
#include "tests/unit/sim/world/pairwise.h"

namespace sim::test {

struct Corner {
  glm::dvec3 position, normal;
  glm::dvec2 uv;     // v up
  glm::dvec3 color;  // sRGB-coded
};
struct Face {
  std::vector<Corner> corners;
  std::size_t material = 0;
};

class Random {
 public:
  double Real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int Whole(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  std::mt19937& engine() { return engine_; }

  // A convex polygon; its numbers are floats, and multiples of 1/255 where they are colours.
  Face Polygon(int sides, bool one_color) {
    const glm::dvec3 centre(Real(-3, 3), Real(-3, 3), Real(-3, 3)), a(Real(-1, 1), Real(-1, 1), Real(0.3, 1)),
        u = glm::normalize(glm::cross(a, glm::dvec3(0, 1, 0))), v = glm::normalize(glm::cross(a, u));
    Face face;
    const double first = Real(0, 1);
    for (int i = 0; i < sides; ++i) {
      const double angle = 6.283185307179586 * (i + first + Real(0, 0.3)) / sides;
      Corner corner;
      corner.position = glm::dvec3(glm::vec3(centre + std::cos(angle) * u + std::sin(angle) * v));
      corner.normal = glm::normalize(glm::normalize(a) + 0.2 * glm::dvec3(Real(-1, 1), Real(-1, 1), Real(-1, 1)));
      corner.uv = glm::dvec2(glm::vec2(Real(-2, 2), Real(-2, 2)));
      corner.color = glm::dvec3(Whole(256), Whole(256), Whole(256)) / 255.0;
      if (one_color && i > 0) corner.color = face.corners[0].color;
      face.corners.push_back(corner);
    }
    return face;
  }

 private:
  std::mt19937 engine_{30};
};

struct Expected {
  std::vector<Face> faces;
  bool has_uvs = false, has_normals = false, has_colors = false;
  glm::dvec2 uv_scale{1}, uv_offset{0};
  std::vector<glm::dvec3> base_colors = {glm::dvec3(1)};  // of the materials

  // What the meshes from `begin` to `end` have else.
  std::string Difference(const Scene& scene, std::size_t begin, std::size_t end) const {
    std::vector<double> areas(faces.size(), 0);
    for (std::size_t m = begin; m < end; ++m) {
      const Mesh& mesh = scene.meshes[m];
      if (has_normals == mesh.normals.empty()) return "normals";
      if (has_colors == mesh.colors.empty()) return "colours";
      for (const glm::uvec3& t : mesh.triangles) {
        std::size_t of = faces.size();
        for (int i = 0; i < 3; ++i) {
          const glm::dvec3 position(mesh.positions[t[i]]);
          const auto [face, corner] = At(position);
          if (corner == nullptr) return "a corner that is not there";
          if (i > 0 && face != of) return "corners of two faces";
          of = face;
          const glm::dvec2 uv = uv_scale * corner->uv + uv_offset;
          const glm::dvec3 color(SrgbToLinear(corner->color.r), SrgbToLinear(corner->color.g),
                                 SrgbToLinear(corner->color.b));
          if (has_uvs &&
              (mesh.uvs.empty() || glm::length(glm::dvec2(mesh.uvs[t[i]]) - glm::dvec2(uv.x, 1 - uv.y)) > 1e-5))
            return "texture coordinates";
          if (has_normals && glm::length(glm::dvec3(mesh.normals[t[i]]) - corner->normal) > 1e-5) return "a normal";
          if (has_colors && glm::length(glm::dvec3(mesh.colors[t[i]]) - color) > 1e-5) return "a colour";
        }
        const glm::dvec3 base(scene.materials[static_cast<std::size_t>(mesh.material)].base_color);
        if (glm::length(base - base_colors[faces[of].material]) > 1e-6) return "the material";
        areas[of] +=
            Area({glm::dvec3(mesh.positions[t[0]]), glm::dvec3(mesh.positions[t[1]]), glm::dvec3(mesh.positions[t[2]])},
                 faces[of]);
      }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      double area = 0;
      const std::vector<Corner>& c = faces[f].corners;
      for (std::size_t i = 2; i < c.size(); ++i)
        area += Area({c[0].position, c[i - 1].position, c[i].position}, faces[f]);
      if (std::abs(areas[f] - area) > 1e-5 * area) return "an area";  // a triangle too many, too few, or turned
    }
    return "";
  }

 private:
  // Along the face's normal.
  static double Area(const std::array<glm::dvec3, 3>& t, const Face& face) {
    const std::vector<Corner>& c = face.corners;
    const glm::dvec3 n = glm::normalize(glm::cross(c[1].position - c[0].position, c[2].position - c[0].position));
    return 0.5 * glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), n);
  }
  std::pair<std::size_t, const Corner*> At(const glm::dvec3& position) const {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (const Corner& corner : faces[f].corners)
        if (glm::length(corner.position - position) < 1e-5) return {f, &corner};
    }
    return {faces.size(), nullptr};
  }
};

// Loads `files` random ones, kAtOnce in a world, each of which make(...) writes into a folder of its own.
template <std::size_t n, class Make>
void ExpectDescribed(int files, const std::array<int, n>& counts, const Make& make) {
  constexpr int kAtOnce = 50;
  const Folder folder;
  Random random;
  PairwiseChoices pairwise(counts);
  for (int done = 0; done < files; done += kAtOnce) {
    WorldDescription world;
    std::vector<Expected> expected;
    std::vector<std::array<int, n>> made;
    for (int k = 0; k < kAtOnce; ++k) {
      made.push_back(pairwise.Draw(random.engine()));
      const std::string name = std::to_string(done + k);
      folder.Write(name + "/a picture.png", EncodeColor(".png", 10, 20, 30));
      folder.Write(name + "/materials/a picture.png", EncodeColor(".png", 10, 20, 30));
      std::filesystem::path file;
      expected.push_back(make(made.back(), random, folder, name, file));
      world.meshes.push_back({file, {}, {1, 0, 0, 0}, 1.0, {}, {}});
    }
    const Scene scene = LoadScene(world);
    for (std::size_t k = 0; k < kAtOnce; ++k) {
      const auto [first, last] = std::equal_range(scene.mesh_entries.begin(), scene.mesh_entries.end(), k);
      const auto begin = static_cast<std::size_t>(first - scene.mesh_entries.begin()),
                 end = static_cast<std::size_t>(last - scene.mesh_entries.begin());
      ASSERT_EQ(expected[k].Difference(scene, begin, end), "") << testing::PrintToString(made[k]);
      // Control: the same with one number of the description changed.
      const auto differs = [&](const auto& change) {
        Expected other = expected[k];
        change(other.faces[3], other.faces[3].corners[1]);
        return !other.Difference(scene, begin, end).empty();
      };
      ASSERT_TRUE(differs([](Face&, Corner& corner) { corner.position.x += 1e-3; }));
      ASSERT_EQ(differs([](Face&, Corner& corner) { corner.uv.y += 1e-3; }), expected[k].has_uvs);
      ASSERT_EQ(differs([](Face&, Corner& corner) { corner.normal.z += 1e-3; }), expected[k].has_normals);
      ASSERT_EQ(differs([](Face&, Corner& corner) { corner.color.b += 4e-3; }), expected[k].has_colors);
      ASSERT_EQ(differs([](Face& face, Corner&) { face.material = 0; }), expected[k].base_colors.size() > 1);
    }
  }
  EXPECT_EQ(pairwise.drawn(), pairwise.all());
}

// Files with this name, whose text and description `File` makes.
template <class File, std::size_t n>
void ExpectDescribed(int files, const std::array<int, n>& counts, const std::string& file_name) {
  ExpectDescribed(files, counts,
                  [&](const auto& choices, Random& random, const Folder& folder, const std::string& name,
                      std::filesystem::path& file) {
                    const File made(choices, random);
                    file = folder.Write(name + "/" + file_name, made.text);
                    return made.expected;
                  });
}

}  // namespace sim::test
