// Random valid OFF, 3MF, COLLADA, STL, X3D and FBX files, in all pairs of what their writers do differently, against
// their own description.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/sim/world/described_mesh.h"

namespace sim::test {
namespace {

// line end, normals and texture coordinates, colours (none, vertices 0 ... 255, vertices 0 ... 1, faces 0 ... 255,
// faces 0 ... 1), alpha, counts beside the header's word, comments, sides, number format
constexpr std::array kOffCounts = {2, 4, 5, 2, 2, 2, 3, 3};

struct OffFile {
  std::string text;
  Expected expected;

  OffFile(const std::array<int, kOffCounts.size()>& c, Random& random) {
    const bool normal = c[1] % 2 == 1, uv = c[1] >= 2, of_vertices = c[2] == 1 || c[2] == 2, of_faces = c[2] > 2;
    const std::string end = c[0] == 0 ? "\n" : "\r\n";
    const auto numbers = [&](const auto& v, int count) {
      std::string words;
      for (int i = 0; i < count; ++i)
        words += c[7] == 0   ? fmt::format("{:.9g} ", v[i])
                 : c[7] == 1 ? fmt::format("{:.9e}  ", v[i])
                             : fmt::format("{:.17g}\t", v[i]);
      return words;
    };
    const auto color = [&](const glm::dvec3& of) {
      if (c[2] % 2 == 0) return numbers(of, 3) + (c[3] == 1 ? "0.5 " : "");
      return fmt::format("{:.0f} {:.0f} {:.0f} ", 255 * of.r, 255 * of.g, 255 * of.b) + (c[3] == 1 ? "128 " : "");
    };
    expected.has_normals = normal, expected.has_colors = c[2] > 0;
    std::string vertices, faces;
    int at = 0;
    for (int f = 0; f < 5; ++f) {
      const Face face = random.Polygon(3 + c[6], of_faces);
      faces += std::to_string(face.corners.size()) + " ";
      for (const Corner& corner : face.corners) {
        vertices += numbers(corner.position, 3) + (normal ? numbers(corner.normal, 3) : "") +
                    (of_vertices ? color(corner.color) : "") + (uv ? numbers(corner.uv, 2) : "") + end;
        faces += " " + std::to_string(at++);
      }
      faces += "  " + (of_faces ? color(face.corners[0].color) : "") + (c[5] == 1 ? "# a face" : "") + end;
      expected.faces.push_back(face);
    }
    text = std::string(uv ? "ST" : "") + (of_vertices ? "C" : "") + (normal ? "N" : "") + "OFF" +
           (c[4] == 1 ? " " : end) + (c[5] == 1 && c[4] == 0 ? "# by hand" + end + end : "") +
           fmt::format("{} 5 0", at) + end + vertices + faces;
  }
};

std::string LittleEndian(std::size_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 255);
  return text;
}

// A zip archive of files by name.
std::string ZipOf(const std::map<std::string, std::string>& files, bool deflated) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(6), libdeflate_free_compressor);
  std::string archive, directory;
  for (const auto& [name, content] : files) {
    std::string data = content;
    if (deflated) {
      data.resize(libdeflate_deflate_compress_bound(compressor.get(), content.size()));
      data.resize(
          libdeflate_deflate_compress(compressor.get(), content.data(), content.size(), data.data(), data.size()));
    }
    const std::string header =
        LittleEndian(20, 2) + LittleEndian(0, 2) + LittleEndian(deflated ? 8 : 0, 2) + LittleEndian(0, 4) +
        LittleEndian(libdeflate_crc32(0, content.data(), content.size()), 4) + LittleEndian(data.size(), 4) +
        LittleEndian(content.size(), 4) + LittleEndian(name.size(), 2) + LittleEndian(0, 2);
    directory += "PK\1\2" + LittleEndian(20, 2) + header + LittleEndian(0, 10) + LittleEndian(archive.size(), 4) + name;
    archive += "PK\3\4" + header + name + data;
  }
  return archive + directory + "PK\5\6" + LittleEndian(0, 4) + LittleEndian(files.size(), 2) +
         LittleEndian(files.size(), 2) + LittleEndian(directory.size(), 4) + LittleEndian(archive.size(), 4) +
         LittleEndian(0, 2);
}

constexpr std::array<std::pair<const char*, double>, 6> kUnits = {{{"millimeter", 0.001},
                                                                   {"micron", 1e-6},
                                                                   {"centimeter", 0.01},
                                                                   {"inch", 0.0254},
                                                                   {"foot", 0.3048},
                                                                   {"meter", 1.0}}};

// unit (none: millimetres), packing, prefix of the elements, properties (none, base materials of objects, of triangles,
// colours of triangles, of corners, picture), turned item, object of components, comments, alpha, sides
constexpr std::array kThreeMfCounts = {7, 2, 2, 6, 2, 2, 2, 2, 3};

struct ThreeMfFile {
  std::string text;
  Expected expected;

  ThreeMfFile(const std::array<int, kThreeMfCounts.size()>& c, Random& random) {
    const bool of_objects = c[3] == 1, base = c[3] == 1 || c[3] == 2, of_triangles = c[3] == 3, of_corners = c[3] == 4,
               picture = c[3] == 5;
    const std::string unit_name = kUnits[static_cast<std::size_t>(c[0] % 6)].first;
    const double unit = kUnits[static_cast<std::size_t>(c[0] % 6)].second;
    const std::string p = c[2] == 1 ? "c:" : "", alpha = c[7] == 1 ? "80" : "";
    const auto code = [&](const glm::dvec3& color) {
      return fmt::format("#{:02X}{:02x}{:02X}{}", std::lround(255 * color.r), std::lround(255 * color.g),
                         std::lround(255 * color.b), alpha);
    };
    expected.has_colors = of_triangles || of_corners, expected.has_uvs = picture;
    std::string resources;
    if (base) {
      resources += fmt::format("<{}basematerials id=\"8\">", p);
      expected.base_colors.clear();
      for (const glm::dvec3& coded : {glm::dvec3(51, 102, 204) / 255.0, glm::dvec3(255, 128, 0) / 255.0}) {
        resources += fmt::format("<{}base name='of &lt;{}' displaycolor=\"{}\"/>", p, coded.b, code(coded));
        expected.base_colors.emplace_back(SrgbToLinear(coded.r), SrgbToLinear(coded.g), SrgbToLinear(coded.b));
      }
      resources += fmt::format("</{}basematerials>", p);
    }
    // Where the item's transform, and that of a component, bring a vertex to.
    const auto written = [&](const glm::dvec3& position) {
      glm::dvec3 at = position / unit;
      if (c[4] == 1) at = glm::dvec3(at.y - 20, 10 - at.x, at.z - 30);
      return c[5] == 1 ? at - glm::dvec3(1, 2, 3) : at;
    };
    std::array<std::string, 2> vertices, triangles;
    std::array<int, 2> count = {0, 0};
    std::string properties;
    int property = 0;
    for (int f = 0; f < 5; ++f) {
      Face face = random.Polygon(3 + c[8], of_triangles);
      if (base) face.material = static_cast<std::size_t>(f % 2);
      const std::size_t object = of_objects ? face.material : 0;
      const int sides = static_cast<int>(face.corners.size()), first = property;
      for (const Corner& corner : face.corners) {
        const glm::dvec3 at = written(corner.position);
        vertices[object] += fmt::format("<{}vertex x=\"{:.17g}\" y=\"{:.17g}\" z='{:.17g}' />\n", p, at.x, at.y, at.z);
        if (picture) properties += fmt::format("<m:tex2coord u=\"{:.9g}\" v=\"{:.9g}\"/>", corner.uv.x, corner.uv.y);
        if (of_corners || (of_triangles && property == first))
          properties += fmt::format("<m:color color=\"{}\"/>", code(corner.color));
        if (picture || of_corners || (of_triangles && property == first)) ++property;
      }
      for (int i = 2; i < sides; ++i) {
        triangles[object] += fmt::format("<{}triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"", p, count[object],
                                         count[object] + i - 1, count[object] + i);
        if (c[3] == 2) triangles[object] += fmt::format(" pid=\"8\" p1=\"{}\"", face.material);
        if (of_triangles) triangles[object] += fmt::format(" pid=\"9\" p1=\"{}\"", first);
        if (of_corners || picture)
          triangles[object] += fmt::format(" p1=\"{}\" p2=\"{}\" p3=\"{}\"", first, first + i - 1, first + i);
        triangles[object] += "/>";
      }
      count[object] += sides;
      expected.faces.push_back(face);
    }
    if (picture)
      resources +=
          "<m:texture2d id=\"7\" path=\"/3D/Textures/a.png\" contenttype=\"image/png\"/>"
          "<m:texture2dgroup id=\"9\" texid=\"7\">" +
          properties + "</m:texture2dgroup>";
    if (of_triangles || of_corners) resources += "<m:colorgroup id=\"9\">" + properties + "</m:colorgroup>";
    std::string items;
    const std::string turn = c[4] == 1 ? " transform=\"0 1 0 -1 0 0 0 0 1 10 20 30\"" : "";
    for (std::size_t object = 0; object < (of_objects ? 2u : 1u); ++object) {
      const std::string of = of_objects              ? fmt::format(" pid=\"8\" pindex=\"{}\"", object)
                             : of_corners || picture ? " pid=\"9\" pindex=\"0\""
                                                     : "";
      resources += fmt::format(
          "<{0}object id=\"{1}\" type=\"model\"{2}><{0}mesh><{0}vertices>{3}</{0}vertices>"
          "<{0}triangles>{4}</{0}triangles></{0}mesh></{0}object>",
          p, object + 1, of, vertices[object], triangles[object]);
      if (c[5] == 1)
        resources += fmt::format(
            "<{0}object id=\"{1}\"><{0}components><{0}component objectid=\"{2}\" "
            "transform=\"1 0 0 0 1 0 0 0 1 1 2 3\"/></{0}components></{0}object>",
            p, object + 11, object + 1);
      items += fmt::format("<{}item objectid=\"{}\"{}/>", p, object + (c[5] == 1 ? 11 : 1), turn);
    }
    const std::string model = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<{0}model {1} xml:lang=\"en-US\" xmlns{2}="
        "\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" xmlns:m="
        "\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">{3}<{0}resources>{4}"
        "</{0}resources><{0}build>{5}</{0}build></{0}model>",
        p, c[0] == 6 ? "" : fmt::format("unit=\"{}\"", unit_name), c[2] == 1 ? ":c" : "",
        c[6] == 1 ? "<!-- <item objectid=\"1\"/> -->" : "", resources, items);
    std::map<std::string, std::string> files = {
        {"3D/3dmodel.model", model},
        {"[Content_Types].xml",
         "<?xml version=\"1.0\"?><Types "
         "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default "
         "Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default "
         "Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
        {"_rels/.rels",
         "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
         "<Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
         "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"}};
    if (picture) files["3D/Textures/a.png"] = EncodeColor(".png", 10, 20, 30);
    text = ZipOf(files, c[1] == 1);
  }
};

// version, up axis, unit, primitives (triangles, polylist, polygons), normals, texture coordinates, an index for all or
// one each, shading, transform (matrix, parts), sides
constexpr std::array kColladaCounts = {2, 3, 2, 3, 2, 2, 2, 3, 2, 3};

struct ColladaFile {
  std::string text;
  Expected expected;

  ColladaFile(const std::array<int, kColladaCounts.size()>& c, Random& random) {
    const bool is_15 = c[0] == 1, normal = c[4] == 1, uv = c[5] == 1, apart = c[6] == 1;
    const double unit = c[2] == 0 ? 1 : 0.01;
    const std::string axis = std::array{"Y_UP", "Z_UP", "X_UP"}[static_cast<std::size_t>(c[1])],
                      shading = std::array{"lambert", "phong", "blinn"}[static_cast<std::size_t>(c[7])];
    expected.has_normals = normal, expected.has_uvs = uv;
    if (!uv) expected.base_colors = {glm::dvec3(0.25, 0.5, 0.75), glm::dvec3(1, 0.5, 0)};
    // Into the file's axes; the node turns by 90 degrees about z and moves by (1, 2, 3).
    const auto of_axes = [&](const glm::dvec3& v) {
      return c[1] == 0 ? v : c[1] == 1 ? glm::dvec3(v.x, -v.z, v.y) : glm::dvec3(v.y, -v.x, v.z);
    };
    const auto turned_back = [](const glm::dvec3& v) { return glm::dvec3(v.y, -v.x, v.z); };
    std::string positions, normals, uvs;
    std::array<std::string, 2> primitives, sizes;
    std::array<int, 2> count = {0, 0};
    int at = 0;
    for (int f = 0; f < 5; ++f) {
      Face face = random.Polygon(3 + c[9], false);
      const auto m = static_cast<std::size_t>(f % 2);
      if (!uv) face.material = m;
      const int sides = static_cast<int>(face.corners.size());
      for (const Corner& corner : face.corners) {
        const glm::dvec3 p = turned_back(of_axes(corner.position) / unit - glm::dvec3(1, 2, 3)),
                         n = turned_back(of_axes(corner.normal));
        positions += fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
        const std::string words = fmt::format("{:.9g} {:.9g} {:.9g} ", n.x, n.y, n.z);
        normals = apart ? words + normals : normals + words;  // from the last to the first
        uvs += fmt::format("{:.9g} {:.9g} ", corner.uv.x, corner.uv.y);
      }
      const int all = 5 * sides;
      const auto index = [&](int corner) {
        const int i = at + corner;
        return !apart ? fmt::format("{} ", i)
                      : fmt::format("{} ", i) + (normal ? fmt::format("{} ", all - 1 - i) : "") +
                            (uv ? fmt::format("{} ", i) : "");
      };
      std::string corners;
      for (int i = 0; i < sides; ++i) corners += index(i);
      if (c[3] == 0) {
        for (int i = 2; i < sides; ++i) primitives[m] += index(0) + index(i - 1) + index(i);
        count[m] += sides - 2;
      } else {
        primitives[m] += c[3] == 1 ? corners : "<p>" + corners + "</p>";
        sizes[m] += fmt::format("{} ", sides);
        ++count[m];
      }
      at += sides;
      expected.faces.push_back(face);
    }
    const auto source = [&](const char* id, const std::string& numbers, const std::vector<const char*>& names) {
      std::string params;
      for (const char* name : names) params += fmt::format("<param name=\"{}\" type=\"float\"/>", name);
      return fmt::format(
          "<source id=\"{0}\"><float_array id=\"{0}-a\" count=\"{1}\">{2}</float_array><technique_common><accessor "
          "source=\"#{0}-a\" count=\"{3}\" stride=\"{4}\">{5}</accessor></technique_common></source>",
          id, static_cast<std::size_t>(at) * names.size(), numbers, at, names.size(), params);
    };
    std::string geometry = source("p", positions, {"X", "Y", "Z"});
    std::string inputs = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
    if (normal) {
      geometry += source("n", normals, {"X", "Y", "Z"});
      inputs += fmt::format("<input semantic=\"NORMAL\" source=\"#n\" offset=\"{}\"/>", apart ? 1 : 0);
    }
    if (uv) {
      geometry += source("t", uvs, {"S", "T"});
      inputs +=
          fmt::format("<input semantic=\"TEXCOORD\" source=\"#t\" offset=\"{}\" set=\"0\"/>", apart ? 1 + c[4] : 0);
    }
    geometry += "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>";
    std::string effects, materials, bound;
    const std::string kind = std::array{"triangles", "polylist", "polygons"}[static_cast<std::size_t>(c[3])];
    for (std::size_t m = 0; m < 2; ++m) {
      geometry += fmt::format("<{} material=\"s{}\" count=\"{}\">", kind, m, count[m]) + inputs +
                  (c[3] == 1 ? "<vcount>" + sizes[m] + "</vcount>" : "") +
                  (c[3] == 2 ? primitives[m] : "<p>" + primitives[m] + "</p>") + "</" + kind + ">";
      const glm::dvec3 kd = uv ? glm::dvec3(1) : expected.base_colors[m];
      effects += fmt::format("<effect id=\"e{}\"><profile_COMMON>", m);
      if (uv && !is_15)
        effects +=
            "<newparam sid=\"f\"><surface type=\"2D\"><init_from>i</init_from></surface></newparam><newparam "
            "sid=\"g\"><sampler2D><source>f</source></sampler2D></newparam>";
      if (uv && is_15) effects += "<newparam sid=\"g\"><sampler2D><instance_image url=\"#i\"/></sampler2D></newparam>";
      effects += "<technique sid=\"common\"><" + shading + "><diffuse>" +
                 (uv ? "<texture texture=\"g\" texcoord=\"U\"/>"
                     : fmt::format("<color>{} {} {} 1</color>", kd.r, kd.g, kd.b)) +
                 "</diffuse></" + shading + "></technique></profile_COMMON></effect>";
      materials += fmt::format("<material id=\"m{0}\"><instance_effect url=\"#e{0}\"/></material>", m);
      bound += fmt::format("<instance_material symbol=\"s{0}\" target=\"#m{0}\">", m) +
               (uv ? "<bind_vertex_input semantic=\"U\" input_semantic=\"TEXCOORD\" input_set=\"0\"/>" : "") +
               "</instance_material>";
    }
    const std::string picture = is_15 ? "<ref>a%20picture.png</ref>" : "a%20picture.png";
    text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<COLLADA xmlns=\"http://www.collada.org/{}/COLLADASchema\" "
        "version=\"{}\"><asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified><unit "
        "name=\"u\" meter=\"{}\"/><up_axis>{}</up_axis></asset>",
        is_15 ? "2008/03" : "2005/11", is_15 ? "1.5.0" : "1.4.1", unit, axis);
    if (uv) text += "<library_images><image id=\"i\"><init_from>" + picture + "</init_from></image></library_images>";
    text += "<library_effects>" + effects + "</library_effects><library_materials>" + materials +
            "</library_materials><library_geometries><geometry id=\"g\"><mesh>" + geometry +
            "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"w\"><node id=\"o\">" +
            (c[8] == 0 ? "<matrix>0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1</matrix>"
                       : "<translate>1 2 3</translate><rotate>0 0 1 90</rotate><scale>1 1 1</scale>") +
            "<instance_geometry url=\"#g\"><bind_material><technique_common>" + bound +
            "</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>"
            "<scene><instance_visual_scene url=\"#w\"/></scene></COLLADA>\n";
  }
};

// form (text; text, "SOLID" and signs; binary; binary with "solid" in its header), normals (right, turned over, zero,
// not a number), colours (none, VisCAM's, Magics', Magics' object) of binary forms, solids of text forms, line end,
// name
constexpr std::array kStlCounts = {4, 4, 4, 2, 2, 2};

struct StlFile {
  std::string text;
  Expected expected;

  StlFile(const std::array<int, kStlCounts.size()>& c, Random& random) {
    const bool binary = c[0] >= 2, magics = c[2] >= 2;
    const std::string end = c[4] == 0 ? "\n" : "\r\n", name = c[5] == 1 ? " facet normal by hand" : "";
    const auto word = [&](std::string of) {
      if (c[0] == 1) std::ranges::transform(of, of.begin(), [](unsigned char l) { return std::toupper(l); });
      return of;
    };
    const auto numbers = [&](const glm::dvec3& v) {
      std::string words;
      for (int i = 0; i < 3; ++i) {
        const auto number = static_cast<float>(v[i]);
        words += binary      ? std::string(reinterpret_cast<const char*>(&number), sizeof number)
                 : c[0] == 1 ? fmt::format("  {:+.9E}", number)
                             : fmt::format(" {:.9g}", number);
      }
      return words;
    };
    expected.has_colors = binary && c[2] > 0;
    std::string facets;
    for (int f = 0; f < 5; ++f) {
      Face face = random.Polygon(3, true);
      const glm::dvec3 of_object(255, 0, 51), coded = of_object / 255.0;
      std::size_t attribute = 0;
      if (binary && c[2] > 0) {
        const bool has_own = c[2] < 3 || f % 2 == 0;
        std::array<std::size_t, 3> code{};  // red, green, blue
        for (int i = 0; i < 3; ++i) code[static_cast<std::size_t>(i)] = static_cast<std::size_t>(random.Whole(32));
        for (Corner& corner : face.corners)
          corner.color = has_own ? glm::dvec3(code[0], code[1], code[2]) / 31.0 : coded;
        attribute = magics ? (has_own ? 0 : 0x8000) | code[0] | code[1] << 5 | code[2] << 10
                           : 0x8000 | code[2] | code[1] << 5 | code[0] << 10;
      }
      const std::vector<Corner>& corners = face.corners;
      const glm::dvec3 n = glm::normalize(
          glm::cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position));
      const std::string normal =
          c[1] == 3 && !binary ? " nan nan nan"
                               : numbers(c[1] == 3 ? glm::dvec3(std::nan("")) : (c[1] == 0 ? 1.0 : c[1] - 2.0) * n);
      if (binary) {
        facets += normal;
        for (const Corner& corner : corners) facets += numbers(corner.position);
        facets += LittleEndian(attribute, 2);
      } else {
        facets += word("  facet normal") + normal + end + word("    outer loop") + end;
        for (const Corner& corner : corners) facets += word("      vertex") + numbers(corner.position) + end;
        facets += word("    endloop") + end + word("  endfacet") + end;
        if (f == 2 && c[3] == 1) facets += word("endsolid") + name + end + word("solid") + " second" + end;
      }
      expected.faces.push_back(face);
    }
    if (binary) {
      text = c[0] == 3 ? "solid" + name : "made by hand";
      if (magics) text = (c[0] == 3 ? " solid, " : "") + std::string("COLOR=\xff\0\x33\xff", 10);
      text.resize(80, c[5] == 1 ? ' ' : '\0');
      text += LittleEndian(5, 4) + facets;
    } else {
      text = word("solid") + name + end + facets + word("endsolid") + name + end;
    }
  }
};

// node (IndexedFaceSet, IndexedTriangleSet, TriangleSet), indices (the coordinates', each list's own, of faces),
// clockwise faces, normals, texture coordinates, colours (none, without and with alpha), transform (none, one, two),
// separators, list of coordinates elsewhere (USE), last -1 missing, sides
constexpr std::array kX3dCounts = {3, 3, 2, 2, 2, 3, 3, 2, 2, 2, 3};

struct X3dFile {
  std::string text;
  Expected expected;

  X3dFile(const std::array<int, kX3dCounts.size()>& c, Random& random) {
    const bool set = c[0] == 0, apart = set && c[1] == 1, of_faces = set && c[1] == 2, turned = set && c[2] == 1,
               normal = c[3] == 1, uv = c[4] == 1, color = c[5] > 0;
    const std::string between = c[7] == 0 ? " " : ", ";
    expected.has_normals = normal, expected.has_uvs = uv, expected.has_colors = color && !uv;
    if (!color && !uv) expected.base_colors = {glm::dvec3(0.25, 0.5, 0.75)};
    const int sides = set ? 3 + c[10] : 3, all = 5 * sides;
    std::string points, normals, uvs, colors, corners, other_corners;
    for (int f = 0; f < 5; ++f) {
      Face face = random.Polygon(sides, of_faces);
      std::vector<int> order;
      for (int i = 0; i < sides; ++i) {
        Corner& corner = face.corners[static_cast<std::size_t>(i)];
        if (of_faces) corner.normal = face.corners[0].normal;
        glm::dvec3 x = corner.position, n = corner.normal;
        for (int turn = 0; turn < c[6]; ++turn) {
          x = (x - glm::dvec3(1, 2, 3)) / 2.0;
          x = glm::dvec3(x.y, -x.x, x.z), n = glm::dvec3(n.y, -n.x, n.z);
        }
        const auto add = [&](std::string& list, const std::string& words) {
          list = apart && &list != &points ? words + between + list : list + words + between;
        };
        add(points, fmt::format("{:.9g} {:.9g} {:.9g}", x.x, x.y, x.z));
        add(uvs, fmt::format("{:.9g} {:.9g}", corner.uv.x, corner.uv.y));
        if (!of_faces || i == 0) {
          add(normals, fmt::format("{:.9g} {:.9g} {:.9g}", n.x, n.y, n.z));
          add(colors, fmt::format("{:.9g} {:.9g} {:.9g}{}", corner.color.r, corner.color.g, corner.color.b,
                                  c[5] == 2 ? " 0.5" : ""));
        }
        order.push_back(turned ? f * sides + sides - 1 - i : f * sides + i);
      }
      for (const int corner : order) {
        corners += std::to_string(corner) + between;
        other_corners += std::to_string(all - 1 - corner) + between;
      }
      if (set && (f < 4 || c[9] == 0)) corners += "-1" + between, other_corners += "-1" + between;
      expected.faces.push_back(face);
    }
    const std::string node = std::array{"IndexedFaceSet", "IndexedTriangleSet",
                                        "TriangleSet"}[static_cast<std::size_t>(c[0])],
                      points_node = "<Coordinate DEF='of all' point='" + points + "'/>";
    std::string shape = "<Shape><Appearance><Material diffuseColor='0.25 0.5 0.75'/>";
    shape +=
        (uv ? "<ImageTexture url='\"a picture.png\"'/>" : "") + std::string("</Appearance><") + node + " solid='false'";
    if (c[0] < 2) shape += (set ? " coordIndex='" : " index='") + corners + "'";
    if (apart) {
      for (const auto& [has, name] : {std::pair(normal, "normal"), {uv, "texCoord"}, {color, "color"}})
        if (has) shape += fmt::format(" {}Index='{}'", name, other_corners);
    }
    if (turned) shape += " ccw='false'";
    if (of_faces) shape += " normalPerVertex=\"false\" colorPerVertex=\"false\"";
    shape += ">" + (c[8] == 1 && set ? "<Coordinate USE='of all'/>" : points_node);
    if (normal) shape += "<Normal vector='" + normals + "'/>";
    if (uv) shape += "<TextureCoordinate point='" + uvs + "'/>";
    if (color) shape += (c[5] == 1 ? "<Color color='" : "<ColorRGBA color='") + colors + "'/>";
    shape += "</" + node + "></Shape>";
    for (int turn = 0; turn < c[6]; ++turn)
      shape = "<Transform translation='1 2 3' rotation='0 0 1 1.5707963267948966' scale='2 2 2'><Collision>" + shape +
              "</Collision></Transform>";
    if (c[8] == 1 && set)
      shape = "<Shape><IndexedLineSet coordIndex='0 1 -1'>" + points_node + "</IndexedLineSet></Shape>" + shape;
    text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<X3D profile='Interchange' version='3.3'><Scene>" + shape +
           "</Scene></X3D>";
  }
};

// unit in centimetres (1, 100, 2.54), up axis (y, z), normals, texture coordinates (none, one set, the second of two),
// colours, mapping of each (of corners: direct, by index; of vertices: direct, by index), materials of faces, model
// (none, turned, turned with a pivot, moved geometry), sides
constexpr std::array kFbxCounts = {3, 2, 2, 3, 2, 4, 2, 4, 3};

struct FbxFile {
  std::string text;
  Expected expected;

  FbxFile(const std::array<int, kFbxCounts.size()>& c, Random& random) {
    const bool z_up = c[1] == 1, normal = c[2] == 1, uv = c[3] > 0, color = c[4] == 1 && !uv;
    const double unit = std::array{1.0, 100.0, 2.54}[static_cast<std::size_t>(c[0])] / 100;
    const bool materials = c[6] == 1 && !uv;
    expected.has_normals = normal, expected.has_uvs = uv, expected.has_colors = color;
    expected.base_colors = {glm::dvec3(uv ? 1.0 : 0.25)};
    if (materials) expected.base_colors.emplace_back(1, 0.5, 0);
    std::string points, corners, of_materials;
    std::array<std::vector<std::string>, 3> lists;  // normals, texture coordinates, colours
    int at = 0;
    for (int f = 0; f < 5; ++f) {
      Face face = random.Polygon(3 + c[8], false);
      if (materials) face.material = static_cast<std::size_t>(f % 2);
      of_materials += (f == 0 ? "" : ",") + std::to_string(f % 2);
      for (std::size_t i = 0; i < face.corners.size(); ++i) {
        const Corner& corner = face.corners[i];
        const auto into = [&](const glm::dvec3& v) { return z_up ? glm::dvec3(v.x, -v.z, v.y) : v; };
        glm::dvec3 x = into(corner.position) / unit, n = into(corner.normal);
        if (c[7] == 1 || c[7] == 2) {
          x -= glm::dvec3(1, 2, 3);
          const glm::dvec3 pivot(c[7] == 2 ? glm::dvec3(4, 5, 6) : glm::dvec3(0));
          x -= pivot, x = glm::dvec3(x.y, -x.x, x.z) + pivot, n = glm::dvec3(n.y, -n.x, n.z);
        } else if (c[7] == 3) {
          x -= glm::dvec3(7, 8, 9);
        }
        const auto words = [](const glm::dvec3& v) { return fmt::format("{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z); };
        points += (at == 0 ? "" : ",") + words(x);
        corners += (at == 0 ? "" : ",") + std::to_string(i + 1 < face.corners.size() ? at : -at - 1);
        ++at;
        lists[0].push_back(words(n));
        lists[1].push_back(fmt::format("{:.9g},{:.9g}", corner.uv.x, corner.uv.y));
        lists[2].push_back(words(corner.color) + ",1");
      }
      expected.faces.push_back(face);
    }
    // By index: from the last to the first.
    const auto layer = [&](const std::string& element, int number, const std::string& set, const std::string& values,
                           const std::string& index, const std::vector<std::string>& list) {
      const bool by_index = c[5] == 1 || c[5] == 3;
      std::string all, indices;
      for (std::size_t i = 0; i < list.size(); ++i) {
        all += (i == 0 ? "" : ",") + list[by_index ? list.size() - 1 - i : i];
        indices += (i == 0 ? "" : ",") + std::to_string(list.size() - 1 - i);
      }
      return fmt::format(
          "{}: {} {{\nVersion: 101\nName: \"{}\"\nMappingInformationType: \"{}\"\nReferenceInformationType: "
          "\"{}\"\n{}: "
          "*{} {{\na: {}\n}}\n{}}}\n",
          element, number, set, c[5] < 2 ? "ByPolygonVertex" : "ByVertice", by_index ? "IndexToDirect" : "Direct",
          values, std::ranges::count(all, ',') + 1, all,
          by_index ? fmt::format("{}: *{} {{\na: {}\n}}\n", index, list.size(), indices) : "");
    };
    const auto reference = [](const std::string& type, int number) {
      return "LayerElement: {\nType: \"" + type + "\"\nTypedIndex: " + std::to_string(number) + "\n}\n";
    };
    std::string layers, used, second;
    if (normal)
      layers += layer("LayerElementNormal", 0, "", "Normals", "NormalsIndex", lists[0]),
          used += reference("LayerElementNormal", 0);
    if (uv) {
      if (c[3] == 2) {
        layers +=
            layer("LayerElementUV", 0, "first", "UV", "UVIndex", std::vector<std::string>(lists[1].size(), "0.5,0.5"));
        second = "Layer: 1 {\nVersion: 100\n" + reference("LayerElementUV", 1) + "}\n";
      }
      layers += layer("LayerElementUV", c[3] - 1, "paint", "UV", "UVIndex", lists[1]);
      used += reference("LayerElementUV", 0);
    }
    if (color)
      layers += layer("LayerElementColor", 0, "", "Colors", "ColorIndex", lists[2]),
          used += reference("LayerElementColor", 0);
    layers += "LayerElementMaterial: 0 {\nVersion: 101\nName: \"\"\nMappingInformationType: \"" +
              std::string(materials ? "ByPolygon" : "AllSame") +
              "\"\nReferenceInformationType: \"IndexToDirect\"\nMaterials: *" +
              (materials ? "5 {\na: " + of_materials : "1 {\na: 0") + "\n}\n}\n";
    used += reference("LayerElementMaterial", 0);
    const auto property = [](const std::string& name, const std::string& type, const std::string& value) {
      return "P: \"" + name + "\", \"" + type + "\", \"\", \"A\"," + value + "\n";
    };
    std::string model;
    if (c[7] == 1 || c[7] == 2)
      model =
          property("Lcl Translation", "Lcl Translation", "1,2,3") + property("Lcl Rotation", "Lcl Rotation", "0,0,90");
    if (c[7] == 2) model += property("RotationPivot", "Vector3D", "4,5,6");
    if (c[7] == 3) model = property("GeometricTranslation", "Vector3D", "7,8,9");
    const auto properties = [](const std::string& all) { return "Properties70: {\n" + all + "}\n"; };
    text =
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\n"
        "GlobalSettings: {\nVersion: 1000\n" +
        properties(property("UpAxis", "int", z_up ? "2" : "1") + property("UpAxisSign", "int", "1") +
                   property("FrontAxis", "int", z_up ? "1" : "2") +
                   property("FrontAxisSign", "int", z_up ? "-1" : "1") + property("CoordAxis", "int", "0") +
                   property("CoordAxisSign", "int", "1") +
                   property("UnitScaleFactor", "double", fmt::format("{}", 100 * unit))) +
        "}\nObjects: {\nGeometry: 10, \"Geometry::g\", \"Mesh\" {\nVertices: *" + std::to_string(3 * at) +
        " {\na: " + points + "\n}\nPolygonVertexIndex: *" + std::to_string(at) + " {\na: " + corners +
        "\n}\nGeometryVersion: 124\n" + layers + "Layer: 0 {\nVersion: 100\n" + used + "}\n" + second +
        "}\nModel: 20, \"Model::m\", \"Mesh\" {\nVersion: 232\n" + properties(model) + "}\n";
    std::string links = "C: \"OO\",20,0\nC: \"OO\",10,20\n";
    for (std::size_t m = 0; m < expected.base_colors.size(); ++m) {
      const glm::dvec3& kd = expected.base_colors[m];
      text +=
          fmt::format("Material: 3{}, \"Material::m{}\", \"\" {{\nVersion: 102\nShadingModel: \"lambert\"\n", m, m) +
          properties(property("DiffuseColor", "Color", fmt::format("{},{},{}", kd.r, kd.g, kd.b))) + "}\n";
      links += fmt::format("C: \"OO\",3{},20\n", m);
    }
    if (uv) {
      text +=
          "Texture: 40, \"Texture::t\", \"\" {\nType: \"TextureVideoClip\"\nVersion: 202\nTextureName: "
          "\"Texture::t\"\n" +
          properties(property("UVSet", "KString", "\"paint\"")) +
          "FileName: \"C:\\elsewhere\\a picture.png\"\nRelativeFilename: \"a picture.png\"\n}\n";
      links += "C: \"OP\",40,30, \"DiffuseColor\"\n";
    }
    text += "}\nConnections: {\n" + links + "}\n";
  }
};

TEST(FormatProperty, RandomOffFilesAreWhatTheyDescribe) { ExpectDescribed<OffFile>(600, kOffCounts, "m.off"); }

TEST(FormatProperty, RandomThreeMfFilesAreWhatTheyDescribe) {
  ExpectDescribed<ThreeMfFile>(600, kThreeMfCounts, "m.3mf");
}

TEST(FormatProperty, RandomColladaFilesAreWhatTheyDescribe) {
  ExpectDescribed<ColladaFile>(200, kColladaCounts, "m.dae");
}

TEST(FormatProperty, RandomStlFilesAreWhatTheyDescribe) { ExpectDescribed<StlFile>(600, kStlCounts, "m.stl"); }

TEST(FormatProperty, RandomX3dFilesAreWhatTheyDescribe) { ExpectDescribed<X3dFile>(200, kX3dCounts, "m.x3d"); }

TEST(FormatProperty, RandomFbxFilesAreWhatTheyDescribe) { ExpectDescribed<FbxFile>(200, kFbxCounts, "m.fbx"); }

}  // namespace
}  // namespace sim::test
