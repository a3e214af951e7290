// Random valid glTF files against their descriptions: each pair of the choices below occurs.
#include <draco/compression/encode.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <ranges>
#include <set>
#include <string>
#include <vector>

#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"
#include "tests/unit/sim/world/pairwise.h"

namespace sim::test {
namespace {

using nlohmann::json;

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;

struct Corner {
  glm::dvec3 position, color;
  glm::dvec2 uv;
};
using Triangle = std::array<Corner, 3>;

// Properties of a file, an index for each choice.
struct Choices {
  static constexpr std::array<int, 10> kCounts = {5, 3, 2, 2, 4, 3, 3, 3, 2, 3};
  std::array<int, 10> of{};
  int position() const { return of[0]; }  // float, byte, short, normalised byte, normalised short
  int uv() const { return of[1]; }        // float, normalised unsigned byte, normalised unsigned short
  bool is_strided() const { return of[2]; }
  bool is_sparse() const { return of[3]; }
  int indices() const { return of[4]; }   // none, unsigned byte, unsigned short, unsigned int
  int mode() const { return 4 + of[5]; }  // triangles, strip, fan
  int wrap() const { return of[6]; }      // repeat, clamp, mirrored repeat
  int uv_set() const { return of[7]; }
  bool is_mirrored() const { return of[8]; }
  int compression() const { return of[9]; }  // none, meshopt, Draco
};

template <class T>
void Put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class FileMaker {
 public:
  FileMaker(const Choices& choices, std::mt19937& random) : c_(choices), random_(random) {}

  std::string file;                 // .gltf
  std::vector<Triangle> triangles;  // in the world

  void Make() {
    const std::size_t n = 12;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs;
    const int position_type = std::array{kFloat, kByte, kShort, kByte, kShort}[static_cast<std::size_t>(c_.position())];
    const bool normalised = c_.position() > 2;
    for (std::size_t i = 0; i < n; ++i) {
      glm::vec3 x(0);
      for (int k = 0; k < 3; ++k) x[k] = position_type == kFloat ? Uniform(-1, 1) : std::round(Uniform(-100, 100));
      positions.push_back(x);
      const float most = c_.uv() == 0 ? 1 : c_.uv() == 1 ? 255 : 65535;
      uvs.emplace_back(std::round(Uniform(0.2f, 0.8f) * most * (c_.uv() == 0 ? 1024 : 1)) / (c_.uv() == 0 ? 1024 : 1),
                       std::round(Uniform(0.2f, 0.8f) * most * (c_.uv() == 0 ? 1024 : 1)) / (c_.uv() == 0 ? 1024 : 1));
    }
    std::vector<std::uint32_t> indices(n);
    for (std::size_t i = 0; i < n; ++i)
      indices[i] = static_cast<std::uint32_t>(c_.indices() == 0 ? i : (5 * i + 3) % n);

    const int uv_type = std::array{kFloat, kUnsignedByte, kUnsignedShort}[static_cast<std::size_t>(c_.uv())];
    std::vector<std::vector<float>> position_rows, uv_rows;
    for (std::size_t i = 0; i < n; ++i) {
      position_rows.push_back({positions[i].x, positions[i].y, positions[i].z});
      uv_rows.push_back({uvs[i].x, uvs[i].y});
    }
    const int accessor = Attribute(position_rows, position_type, normalised, c_.is_sparse());
    json attributes = {{"POSITION", accessor}};
    // Coordinate sets below the used one, with other values.
    for (int set = 0; set <= c_.uv_set(); ++set) {
      std::vector<std::vector<float>> rows = uv_rows;
      if (set != c_.uv_set()) rows.assign(n, {0, 0});
      attributes["TEXCOORD_" + std::to_string(set)] = Attribute(rows, uv_type, uv_type != kFloat, false);
    }
    json primitive = {{"attributes", attributes}, {"material", 0}, {"mode", c_.mode()}};
    if (c_.indices() > 0) primitive["indices"] = Indices(indices);
    if (c_.compression() == 2 && c_.mode() == 4 && c_.indices() > 0)
      Draco(position_rows, position_type, normalised, uv_rows, uv_type, indices, attributes, primitive);

    const glm::dvec3 t(Uniform(-3, 3), Uniform(-3, 3), Uniform(-3, 3)), s(c_.is_mirrored() ? -2 : 2, 0.5, 1.5);
    const glm::dquat q = glm::normalize(glm::dquat(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1)));
    glm::dmat4 world = glm::mat4_cast(q);
    for (int k = 0; k < 3; ++k) world[k] *= s[k];
    world[3] = glm::dvec4(t, 1);
    json node = {{"mesh", 0}};
    if (Uniform(0, 1) < 0.5f) {
      node["translation"] = {t.x, t.y, t.z}, node["scale"] = {s.x, s.y, s.z}, node["rotation"] = {q.x, q.y, q.z, q.w};
    } else {
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) node["matrix"].push_back(world[column][row]);
      }
    }
    const auto corner = [&](std::size_t i) {
      const std::uint32_t v = indices[i];
      const double unit = !normalised ? 1 : position_type == kByte ? 127 : 32767;
      const double uv_unit = uv_type == kFloat ? 1 : uv_type == kUnsignedByte ? 255 : 65535;
      return Corner{glm::dvec3(world * glm::dvec4(glm::dvec3(positions[v]) / unit, 1)), glm::dvec3(1),
                    glm::dvec2(uvs[v]) / uv_unit};
    };
    for (std::size_t i = 0; i + 2 < n; i += c_.mode() == 4 ? 3 : 1) {
      const bool odd = c_.mode() == 5 && i % 2 == 1;
      Triangle triangle = c_.mode() == 6 ? Triangle{corner(0), corner(i + 1), corner(i + 2)}
                                         : Triangle{corner(i), corner(i + (odd ? 2 : 1)), corner(i + (odd ? 1 : 2))};
      if (c_.is_mirrored()) std::swap(triangle[1], triangle[2]);  // the front stays in front
      triangles.push_back(triangle);
    }

    json document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {node}},
        {"meshes", {{{"primitives", {primitive}}}}},
        {"materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", c_.uv_set()}}}}}}}},
        {"textures", {{{"source", 0}, {"sampler", 0}}}},
        {"images", {{{"uri", "a%20picture.png"}}}},
        {"samplers",
         {{{"wrapS", std::array{10497, 33071, 33648}[static_cast<std::size_t>(c_.wrap())]}, {"wrapT", 33071}}}},
        {"buffers", {{{"uri", "data.bin"}, {"byteLength", data.size()}}}},
        {"bufferViews", views_},
        {"accessors", accessors_}};
    if (has_fallback_)
      document["buffers"].push_back(
          {{"byteLength", fallback_}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    if (!extensions_.empty()) document["extensionsUsed"] = document["extensionsRequired"] = extensions_;
    file = document.dump();
  }

  std::string data;

 private:
  float Uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

  static std::size_t SizeOf(int type) {
    return type == kFloat || type == kUnsignedInt ? 4 : type == kShort || type == kUnsignedShort ? 2 : 1;
  }
  static void PutComponent(std::string& bytes, int type, float value) {
    if (type == kFloat) Put(bytes, value);
    if (type == kByte) Put(bytes, static_cast<std::int8_t>(value));
    if (type == kUnsignedByte) Put(bytes, static_cast<std::uint8_t>(value));
    if (type == kShort) Put(bytes, static_cast<std::int16_t>(value));
    if (type == kUnsignedShort) Put(bytes, static_cast<std::uint16_t>(value));
    if (type == kUnsignedInt) Put(bytes, static_cast<std::uint32_t>(value));
  }
  // View of bytes that are appended to the buffer at a multiple of four.
  int View(const std::string& bytes, std::size_t stride) {
    data.resize((data.size() + 3) / 4 * 4);
    json view = {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    data += bytes;
    views_.push_back(view);
    return static_cast<int>(views_.size()) - 1;
  }
  // The same, compressed.
  int Compressed(const std::string& bytes, std::size_t count, std::size_t stride, const char* mode) {
    extensions_.insert("EXT_meshopt_compression");
    std::vector<unsigned char> packed(std::max(meshopt_encodeVertexBufferBound(count, (stride + 3) / 4 * 4),
                                               meshopt_encodeIndexBufferBound(count, 64)) +
                                      1024);
    std::size_t size = 0;
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    if (std::string(mode) == "ATTRIBUTES") {
      size = meshopt_encodeVertexBuffer(packed.data(), packed.size(), from, count, stride);
    } else {
      std::vector<unsigned> indices(count);
      for (std::size_t i = 0; i < count; ++i) std::memcpy(&indices[i], from + i * stride, stride);
      size = std::string(mode) == "TRIANGLES"
                 ? meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), count)
                 : meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), count);
    }
    const int view = View({reinterpret_cast<const char*>(packed.data()), size}, 0);
    json& made = views_[static_cast<std::size_t>(view)];
    const json how = {{"buffer", 0},        {"byteOffset", made["byteOffset"]},
                      {"byteLength", size}, {"byteStride", stride},
                      {"count", count},     {"mode", mode}};
    made = {{"buffer", 1},
            {"byteOffset", fallback_},
            {"byteLength", count * stride},
            {"extensions", {{"EXT_meshopt_compression", how}}}};
    if (std::string(mode) == "ATTRIBUTES") made["byteStride"] = stride;
    fallback_ += count * stride;
    has_fallback_ = true;
    return view;
  }

  int Attribute(const std::vector<std::vector<float>>& rows, int type, bool normalised, bool sparse) {
    const std::size_t columns = rows[0].size(), packed = (SizeOf(type) * columns + 3) / 4 * 4;
    const std::size_t stride = packed + (c_.is_strided() ? 8 : 0);
    if (type != kFloat && columns == 3) extensions_.insert("KHR_mesh_quantization");
    std::string bytes;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool is_replaced = sparse && i % 3 == 1;
      const std::size_t begin = bytes.size();
      for (const float value : rows[i]) PutComponent(bytes, type, is_replaced ? 7 : value);
      bytes.resize(begin + stride, '\0');
    }
    const bool compress = c_.compression() == 1;
    json accessor = {
        {"bufferView", compress ? Compressed(bytes, rows.size(), stride, "ATTRIBUTES") : View(bytes, stride)},
        {"componentType", type},
        {"count", rows.size()},
        {"type", columns == 3 ? "VEC3" : "VEC2"}};
    if (normalised) accessor["normalized"] = true;
    for (std::size_t c = 0; columns == 3 && c < 3; ++c) {  // positions must have their bounds
      const auto [low, high] = std::ranges::minmax(rows, {}, [&](const std::vector<float>& row) { return row[c]; });
      accessor["min"].push_back(low[c]), accessor["max"].push_back(high[c]);
    }
    if (sparse) {
      std::string indices, values;
      std::size_t count = 0;
      for (std::size_t i = 1; i < rows.size(); i += 3, ++count) {
        Put(indices, static_cast<std::uint16_t>(i));
        for (const float value : rows[i]) PutComponent(values, type, value);
      }
      accessor["sparse"] = {{"count", count},
                            {"indices", {{"bufferView", View(indices, 0)}, {"componentType", kUnsignedShort}}},
                            {"values", {{"bufferView", View(values, 0)}}}};
    }
    accessors_.push_back(accessor);
    return static_cast<int>(accessors_.size()) - 1;
  }

  int Indices(const std::vector<std::uint32_t>& indices) {
    const int type = std::array{0, kUnsignedByte, kUnsignedShort, kUnsignedInt}[static_cast<std::size_t>(c_.indices())];
    std::string bytes;
    for (const std::uint32_t i : indices) PutComponent(bytes, type, static_cast<float>(i));
    const bool compress = c_.compression() == 1 && type != kUnsignedByte;
    // The order of a strip is fixed; the encoder may rotate the corners of a list's triangles.
    const int view = compress
                         ? Compressed(bytes, indices.size(), SizeOf(type), c_.mode() == 4 ? "TRIANGLES" : "INDICES")
                         : View(bytes, 0);
    accessors_.push_back(
        {{"bufferView", view}, {"componentType", type}, {"count", indices.size()}, {"type", "SCALAR"}});
    return static_cast<int>(accessors_.size()) - 1;
  }

  void Draco(const std::vector<std::vector<float>>& positions, int position_type, bool normalised,
             const std::vector<std::vector<float>>& uvs, int uv_type, const std::vector<std::uint32_t>& indices,
             const json& attributes, json& primitive) {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(positions.size()));
    const auto add = [&](draco::GeometryAttribute::Type kind, const std::vector<std::vector<float>>& rows, int type,
                         bool norm) {
      const draco::DataType data_type = type == kFloat          ? draco::DT_FLOAT32
                                        : type == kByte         ? draco::DT_INT8
                                        : type == kShort        ? draco::DT_INT16
                                        : type == kUnsignedByte ? draco::DT_UINT8
                                                                : draco::DT_UINT16;
      draco::GeometryAttribute attribute;
      const auto columns = static_cast<std::int8_t>(rows[0].size());
      attribute.Init(kind, nullptr, columns, data_type, norm, static_cast<std::int64_t>(SizeOf(type)) * columns, 0);
      const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(rows.size()));
      for (std::uint32_t i = 0; i < rows.size(); ++i) {
        std::string bytes;
        for (const float value : rows[i]) PutComponent(bytes, type, value);
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), bytes.data());
      }
      return mesh.attribute(id)->unique_id();
    };
    const auto position_id = add(draco::GeometryAttribute::POSITION, positions, position_type, normalised);
    std::vector<std::uint32_t> other_ids;  // of the sets below the one that is used
    for (int set = 0; set < c_.uv_set(); ++set)
      other_ids.push_back(add(draco::GeometryAttribute::TEX_COORD, {uvs.size(), {0, 0}}, uv_type, uv_type != kFloat));
    const auto uv_id = add(draco::GeometryAttribute::TEX_COORD, uvs, uv_type, uv_type != kFloat);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      mesh.AddFace(
          {draco::PointIndex(indices[i]), draco::PointIndex(indices[i + 1]), draco::PointIndex(indices[i + 2])});
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    extensions_.insert("KHR_draco_mesh_compression");
    json ids = {{"POSITION", position_id}};
    ids["TEXCOORD_" + std::to_string(c_.uv_set())] = uv_id;
    for (std::size_t set = 0; set < other_ids.size(); ++set) ids["TEXCOORD_" + std::to_string(set)] = other_ids[set];
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", View({buffer.data(), buffer.size()}, 0)},
                                                             {"attributes", ids}};
    // Uncompressed attributes would not match Draco's points.
    for (const auto& [name, index] : attributes.items()) {
      if (!ids.contains(name)) primitive["attributes"].erase(name);
    }
  }

  const Choices& c_;
  std::mt19937& random_;
  json views_ = json::array(), accessors_ = json::array();
  std::set<std::string> extensions_;
  bool has_fallback_ = false;
  std::size_t fallback_ = 0;
};

// Equality of two triangles up to a rotation of their corners.
bool IsSame(const Triangle& a, const Triangle& b) {
  for (std::size_t turn = 0; turn < 3; ++turn) {
    bool same = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &p = a[i], &q = b[(i + turn) % 3];
      same = same && glm::length(p.position - q.position) < 1e-4 * (1 + glm::length(p.position)) &&
             glm::length(p.uv - q.uv) < 1e-5;
    }
    if (same) return true;
  }
  return false;
}

TEST(GltfProperty, RandomFilesAreWhatTheyDescribe) {
  const Folder folder;
  folder.Write("a picture.png", EncodeColor(".png", 10, 20, 30));  // 4 x 4: uv are half a texel or more from an edge
  const char* keep = std::getenv("VOBENCH_KEEP_GLTF");             // for tools/dev/validate-gltf
  std::mt19937 random(20);
  PairwiseChoices pairwise(Choices::kCounts);
  constexpr int kFiles = 2000, kAtOnce = 50;
  for (int done = 0; done < kFiles; done += kAtOnce) {
    WorldDescription world;
    std::vector<std::vector<Triangle>> expected;
    std::vector<Choices> made;
    for (int k = 0; k < kAtOnce; ++k) {
      const Choices choices{pairwise.Draw(random)};
      FileMaker maker(choices, random);
      maker.Make();
      const std::string name = std::to_string(done + k);
      folder.Write(name + "/a picture.png", EncodeColor(".png", 10, 20, 30));
      folder.Write(name + "/data.bin", maker.data);
      world.meshes.push_back({folder.Write(name + "/m.gltf", maker.file), {}, {1, 0, 0, 0}, 1.0, {}, {}});
      if (keep != nullptr && choices.compression() == 0) {  // for Blender's reader
        std::string description;
        for (const Corner& c : maker.triangles | std::views::join)
          description += fmt::format("{} {} {} {} {}\n", c.position.x, c.position.y, c.position.z, c.uv.x, c.uv.y);
        folder.Write(name + "/triangles.txt", description);
      }
      expected.push_back(maker.triangles);
      made.push_back(choices);
    }
    const Scene scene = LoadScene(world);
    ASSERT_THAT(scene.meshes, testing::SizeIs(kAtOnce));
    for (std::size_t k = 0; k < kAtOnce; ++k) {
      const Mesh& mesh = scene.meshes[k];
      ASSERT_EQ(mesh.triangles.size(), expected[k].size()) << testing::PrintToString(made[k].of);
      ASSERT_EQ(mesh.uvs.size(), mesh.positions.size()) << testing::PrintToString(made[k].of);
      for (const glm::uvec3& t : mesh.triangles) {
        Triangle loaded;
        for (int i = 0; i < 3; ++i)
          loaded[static_cast<std::size_t>(i)] = {glm::dvec3(mesh.positions[t[i]]), glm::dvec3(1),
                                                 glm::dvec2(mesh.uvs[t[i]])};
        ASSERT_TRUE(std::ranges::any_of(expected[k], [&](const Triangle& e) { return IsSame(e, loaded); }))
            << testing::PrintToString(made[k].of) << ": " << loaded[0].uv.x << " " << loaded[0].position.x;
      }
    }
  }
  if (keep != nullptr) std::filesystem::copy(folder.path(), keep, std::filesystem::copy_options::recursive);
  EXPECT_EQ(pairwise.drawn(), pairwise.all());
}

}  // namespace
}  // namespace sim::test
