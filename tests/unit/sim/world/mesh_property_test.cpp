// Random valid OBJ and PLY files, in all pairs of what their writers do differently, against their own description.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "sim/world/scene.h"
#include "sim/world/texture.h"
#include "tests/unit/sim/world/files.h"
#include "tests/unit/sim/world/pairwise.h"

namespace sim::test {
namespace {

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

// line end, number format, relative indices, texture coordinates and normals, colours, continued lines, name of the
// material, sides, library, options of the picture, comments
constexpr std::array kObjCounts = {2, 4, 2, 4, 2, 2, 2, 3, 3, 4, 2};

struct ObjFile {
  std::string text, library;
  Expected expected;

  ObjFile(const std::array<int, kObjCounts.size()>& c, Random& random) {
    const bool uv = c[3] % 2 == 1, normal = c[3] >= 2, color = c[4] == 1, picture = uv && c[9] > 0;
    const auto number = [&](double x) {
      std::string word = c[1] == 0   ? fmt::format("{:.9g}", x)
                         : c[1] == 1 ? fmt::format("{:+.9e}", x)
                         : c[1] == 2 ? fmt::format("{:.10f}", x)
                                     : fmt::format("{:.17g}", x);
      if (c[1] == 2 && word.starts_with("0.")) word.erase(0, 1);
      return word;
    };
    const std::string end = c[0] == 0 ? "\n" : "\r\n", gap = c[5] == 1 ? " \\" + end + "\t" : " ";
    const std::array<std::string, 2> names = c[6] == 0 ? std::array<std::string, 2>{"first", "second.001"}
                                                       : std::array<std::string, 2>{"the first", "Material #2"};
    expected.base_colors = {glm::dvec3(0.25, 0.5, 0.75), glm::dvec3(1, 0.5, 0)};
    expected.has_uvs = picture, expected.has_normals = normal;
    expected.has_colors = color && !picture;
    if (picture && c[9] >= 2) expected.uv_scale = {2, 0.5};
    if (picture && c[9] == 3) expected.uv_offset = {0.25, -0.5};
    const std::string options = c[9] == 2 ? "-s 2 .5 1 " : c[9] == 3 ? "-o 0.25 -0.5 -s 2 0.5 " : "-clamp off ";
    for (std::size_t m = 0; m < 2; ++m) {
      const glm::dvec3& kd = expected.base_colors[m];
      library += "newmtl " + names[m] + end + "Ns 10.0" + end + "Kd " + fmt::format("{} {} {}", kd.r, kd.g, kd.b) + end;
      if (picture) library += "\tmap_Kd " + options + "a picture.png  " + end;
    }
    const std::string name = c[8] == 2 ? "materials/m.mtl" : "m.mtl";
    text =
        (c[10] == 1 ? "# written by hand" + end + end : "") + "mtllib " + (c[8] == 1 ? "\"" + name + "\"" : name) + end;
    int at = 0;
    for (int f = 0; f < 5; ++f) {
      Face face = random.Polygon(3 + c[7], false);
      face.material = static_cast<std::size_t>(f % 2);
      std::string indices;
      for (const Corner& corner : face.corners) {
        ++at;
        const auto vector = [&](const glm::dvec3& v) {
          return " " + number(v.x) + gap + number(v.y) + " " + number(v.z);
        };
        text += "v" + vector(corner.position) + (color ? vector(corner.color) : "") + end;
        if (uv) text += "vt " + number(corner.uv.x) + " " + number(corner.uv.y) + (c[10] == 1 ? " 0 # w" : "") + end;
        if (normal) text += "vn" + vector(corner.normal) + end;
      }
      for (int i = 0; i < static_cast<int>(face.corners.size()); ++i) {
        const int count = static_cast<int>(face.corners.size());
        const std::string index = std::to_string(c[2] == 1 ? i - count : at - count + i + 1);
        indices += (i == 1 ? gap : " ") + index + (uv ? "/" + index : normal ? "/" : "") + (normal ? "/" + index : "");
      }
      text += "usemtl " + names[face.material] + end + (f == 2 ? "g another group" + end + "s off" + end : "");
      text += "f" + indices + end;
      expected.faces.push_back(face);
    }
  }
};

// encoding, type of the coordinates, texture coordinates (none, of vertices by three names, of corners), normals,
// colours (none, uchar, ushort, float, of faces), type of counts, type of indices, name of the indices, order, other
// properties, line end of the header, sides, strips
constexpr std::array kPlyCounts = {3, 2, 5, 2, 5, 3, 4, 2, 2, 2, 2, 3, 2};

class PlyFile {
 public:
  std::string text;
  Expected expected;

  PlyFile(const std::array<int, kPlyCounts.size()>& c, Random& random) : encoding_(c[0]) {
    const bool strips = c[12] == 1, wedge = c[2] == 4 && !strips, of_faces = c[4] == 4 && !strips;
    const bool uv = c[2] > 0 && c[2] < 4, others = c[9] == 1;
    for (int f = 0; f < 5; ++f) expected.faces.push_back(random.Polygon(strips ? 3 : 3 + c[11], of_faces));
    if (c[4] == 2) expected.faces[0].corners[0].color.r = 1;  // so that 65535 occurs
    expected.has_uvs = wedge || uv, expected.has_normals = c[3] == 1;
    const bool picture = expected.has_uvs;  // it takes the place of colours
    expected.has_colors = (of_faces || (c[4] > 0 && c[4] < 4)) && !picture;
    const std::string real = c[1] == 0 ? "float" : "float64";
    const std::string color_type = c[4] == 2 ? "ushort" : c[4] == 3 ? "float" : "uchar";
    const double white = c[4] == 2 ? 65535 : c[4] == 3 ? 1 : 255;
    const std::string count_type = std::array{"uchar", "int", "uint16"}[static_cast<std::size_t>(c[5])];
    const std::string index_type = std::array{"int", "uint32", "ushort", "short"}[static_cast<std::size_t>(c[6])];
    const std::array<std::string, 2> uv_names = c[2] == 1   ? std::array<std::string, 2>{"s", "t"}
                                                : c[2] == 2 ? std::array<std::string, 2>{"u", "v"}
                                                            : std::array<std::string, 2>{"texture_u", "texture_v"};
    const auto property = [](const std::string& type, const std::vector<std::string>& names) {
      std::string lines;
      for (const std::string& name : names) lines += "property " + type + " " + name + "\n";
      return lines;
    };
    const std::size_t corners = expected.faces[0].corners.size();
    std::string vertices = fmt::format("element vertex {}\n", 5 * corners) + property(real, {"x", "y", "z"});
    if (others) vertices += property("uchar", {"quality"}) + "property list uchar short flags\n";
    if (c[3] == 1) vertices += property("float", {"nx", "ny", "nz"});
    if (c[4] > 0 && c[4] < 4) vertices += property(color_type, {"red", "green", "blue"});
    if (uv) vertices += property(real, {uv_names[0], uv_names[1]});
    std::string faces = strips ? "element tristrips 1\n" : "element face 5\n";
    if (others && !strips) faces += property("int", {"number"});
    faces += "property list " + (strips ? "int" : count_type) + " " + (strips ? "int" : index_type) +
             (c[7] == 0 ? " vertex_indices\n" : " vertex_index\n");
    if (wedge) faces += "property list " + count_type + " float texcoord\n";
    if (of_faces) faces += property("uchar", {"red", "green", "blue"});

    std::string vertex_rows, face_rows;
    const auto real_of = [&](std::string& to, double x) { Put(to, real, x); };
    if (strips) Put(face_rows, "int", 5 * 4);
    int at = 0;
    for (const Face& face : expected.faces) {
      if (others && !strips) Put(face_rows, "int", at);
      if (!strips) Put(face_rows, count_type, static_cast<double>(corners));
      for (const Corner& corner : face.corners) {
        Put(face_rows, strips ? "int" : index_type, at++);
        for (int i = 0; i < 3; ++i) real_of(vertex_rows, corner.position[i]);
        if (others) {
          Put(vertex_rows, "uchar", 7);
          Put(vertex_rows, "uchar", at % 3);
          for (int i = 0; i < at % 3; ++i) Put(vertex_rows, "short", -i);
        }
        for (int i = 0; c[3] == 1 && i < 3; ++i) Put(vertex_rows, "float", corner.normal[i]);
        for (int i = 0; c[4] > 0 && c[4] < 4 && i < 3; ++i) Put(vertex_rows, color_type, white * corner.color[i]);
        for (int i = 0; uv && i < 2; ++i) real_of(vertex_rows, corner.uv[i]);
        EndRow(vertex_rows);
      }
      if (strips) Put(face_rows, "int", -1);
      if (wedge) Put(face_rows, count_type, 2.0 * static_cast<double>(corners));
      for (std::size_t i = 0; wedge && i < corners; ++i)
        for (int k = 0; k < 2; ++k) Put(face_rows, "float", face.corners[i].uv[k]);
      for (int i = 0; of_faces && i < 3; ++i) Put(face_rows, "uchar", 255 * face.corners[0].color[i]);
      if (!strips) EndRow(face_rows);
    }
    if (strips) EndRow(face_rows);
    std::string header = "ply\nformat " +
                         std::string(std::array{"ascii", "binary_little_endian",
                                                "binary_big_endian"}[static_cast<std::size_t>(encoding_)]) +
                         " 1.0\n" + (picture ? "comment TextureFile a picture.png\n" : "comment none\n");
    std::string extra_rows;
    if (others) {
      Put(extra_rows, "double", 1.5);
      EndRow(extra_rows);
    }
    const std::string extra = others ? "element material 1\nproperty double shine\n" : "";
    header += (c[8] == 0 ? vertices + extra + faces : faces + extra + vertices) + "end_header\n";
    if (c[10] == 1 && encoding_ == 0) {
      for (std::size_t i = 0; (i = header.find('\n', i)) != std::string::npos; i += 2) header.insert(i, "\r");
    }
    text = header + (c[8] == 0 ? vertex_rows + extra_rows + face_rows : face_rows + extra_rows + vertex_rows);
  }

 private:
  template <class T>
  void PutAs(std::string& to, double value) const {
    const auto number = static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
    if (encoding_ == 0) {
      to += fmt::format("{} ", +number);
      return;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &number, sizeof(T));
    if (encoding_ == 2) std::ranges::reverse(bytes);
    to.append(bytes.data(), bytes.size());
  }
  void Put(std::string& to, const std::string& type, double value) const {
    if (type == "uchar") return PutAs<std::uint8_t>(to, value);
    if (type == "short") return PutAs<std::int16_t>(to, value);
    if (type == "ushort" || type == "uint16") return PutAs<std::uint16_t>(to, value);
    if (type == "int") return PutAs<std::int32_t>(to, value);
    if (type == "uint32") return PutAs<std::uint32_t>(to, value);
    if (type == "float") return PutAs<float>(to, value);
    PutAs<double>(to, value);
  }
  void EndRow(std::string& to) const {
    if (encoding_ == 0) to += "\n";
  }

  int encoding_;
};

// Loads `kFiles` of them, kAtOnce in a world, each of which make(number) writes into a folder of its own.
template <std::size_t n, class Make>
void ExpectDescribed(const std::array<int, n>& counts, const Make& make) {
  constexpr int kFiles = 2000, kAtOnce = 50;
  const Folder folder;
  Random random;
  PairwiseChoices pairwise(counts);
  for (int done = 0; done < kFiles; done += kAtOnce) {
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

TEST(MeshProperty, RandomObjFilesAreWhatTheyDescribe) {
  ExpectDescribed(kObjCounts, [](const auto& choices, Random& random, const Folder& folder, const std::string& name,
                                 std::filesystem::path& file) {
    const ObjFile made(choices, random);
    folder.Write(name + (choices[8] == 2 ? "/materials/m.mtl" : "/m.mtl"), made.library);
    file = folder.Write(name + "/m.obj", made.text);
    return made.expected;
  });
}

TEST(MeshProperty, RandomPlyFilesAreWhatTheyDescribe) {
  ExpectDescribed(kPlyCounts, [](const auto& choices, Random& random, const Folder& folder, const std::string& name,
                                 std::filesystem::path& file) {
    const PlyFile made(choices, random);
    file = folder.Write(name + "/m.ply", made.text);
    return made.expected;
  });
}

}  // namespace
}  // namespace sim::test
