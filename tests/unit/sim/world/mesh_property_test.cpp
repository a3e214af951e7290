// Random valid OBJ and PLY files, in all pairs of what their writers do differently, against their own description.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tests/unit/sim/world/described_mesh.h"

namespace sim::test {
namespace {

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

TEST(MeshProperty, RandomObjFilesAreWhatTheyDescribe) {
  ExpectDescribed(600, kObjCounts,
                  [](const auto& choices, Random& random, const Folder& folder, const std::string& name,
                     std::filesystem::path& file) {
                    const ObjFile made(choices, random);
                    folder.Write(name + (choices[8] == 2 ? "/materials/m.mtl" : "/m.mtl"), made.library);
                    file = folder.Write(name + "/m.obj", made.text);
                    return made.expected;
                  });
}

TEST(MeshProperty, RandomPlyFilesAreWhatTheyDescribe) { ExpectDescribed<PlyFile>(600, kPlyCounts, "m.ply"); }

}  // namespace
}  // namespace sim::test
