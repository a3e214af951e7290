#include "sim/world/gltf_file.h"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "sim/world/image_file.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture_file.h"
#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/base/text.h"

namespace sim {
namespace {

using nlohmann::json;

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

// Types of components, and the value of 1 in normalised integers.
struct ComponentType {
  int code;
  std::size_t bytes;
  double (*number_at)(const void*);
  double one;
};
constexpr ComponentType kTypes[] = {{5120, 1, NumberAt<std::int8_t>, 127},
                                    {5121, 1, NumberAt<std::uint8_t>, 255},
                                    {5122, 2, NumberAt<std::int16_t>, 32767},
                                    {5123, 2, NumberAt<std::uint16_t>, 65535},
                                    {5125, 4, NumberAt<std::uint32_t>, 4294967295.0},
                                    {5126, 4, NumberAt<float>, 0}};

const ComponentType& TypeOf(int code) {
  const auto* type = std::ranges::find(kTypes, code, &ComponentType::code);
  if (type == std::end(kTypes)) Fail("an accessor's componentType " + std::to_string(code) + " is none of glTF's");
  return *type;
}

std::size_t ColumnsOf(const std::string& type) {
  for (const auto& [name, columns] : {std::pair{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}) {
    if (type == name) return static_cast<std::size_t>(columns);
  }
  Fail("an accessor's type '" + type + "' is not used here");
}

// The beginning of a long text: a data URI is a whole file.
std::string Short(const std::string& text) { return text.size() > 60 ? text.substr(0, 60) + "..." : text; }

std::size_t WholeOf(const json& value, const char* key) {
  const double number = value.is_number_float() ? value.get<double>() : -1;  // some write 3.0
  if (number >= 0 && number < 0x1p53 && number == std::floor(number)) return static_cast<std::size_t>(number);
  const auto whole = limits::WholeNumber<std::size_t>(value);
  if (!whole) Fail(std::string("'") + key + "' is " + Short(value.dump()) + ", not a whole number from 0 on");
  return *whole;
}
std::size_t Whole(const json& object, const char* key, std::size_t otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  return WholeOf(*found, key);
}
std::size_t Whole(const json& object, const char* key) {
  if (!object.contains(key)) Fail(std::string("'") + key + "' is missing");
  return Whole(object, key, 0);
}

// The type of an accessor of indices.
int IndexType(const json& object) {
  const int type = static_cast<int>(Whole(object, "componentType"));
  if (type != 5121 && type != 5123 && type != 5125)
    Fail("has indices of componentType " + std::to_string(type) + ": glTF has 5121, 5123 and 5125 for them");
  return type;
}

// `size` bytes from `offset` of `all`, checked without overflow.
std::span<const std::uint8_t> Part(std::span<const std::uint8_t> all, std::size_t offset, std::size_t size,
                                   const char* what) {
  if (offset > all.size() || size > all.size() - offset) Fail(std::string(what) + " goes beyond its buffer's end");
  return all.subspan(offset, size);
}

std::string FromBase64(std::string_view text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    if (c == '\n' || c == '\r' || c == ' ' || c == '\t') continue;
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
    if (!upper && !lower && !digit && c != '+' && c != '/') Fail("a data URI is not base64");
    const int value = upper ? c - 'A' : lower ? c - 'a' + 26 : digit ? c - '0' + 52 : c == '+' ? 62 : 63;
    group = group << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>((group >> bits) & 255u);
  }
  return bytes;
}

// extension: EXT_ or KHR_meshopt_compression; its name begins the problems.
std::vector<std::uint8_t> Decompress(const json& how, std::span<const std::uint8_t> from,
                                     const std::string& extension) {
  const std::size_t count = Whole(how, "count"), stride = Whole(how, "byteStride");
  const std::string mode = how.value("mode", ""), filter = how.value("filter", "NONE");
  const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
  const auto unsupported = [&](const std::string& what) {
    Fail(extension + ": " + what + " is not supported: export with EXT_meshopt_compression (gltfpack -cc) or without");
  };
  if (attributes ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
    Fail(extension + ": a byteStride of " + std::to_string(stride));
  if (count > (std::size_t{1} << 27)) Fail(extension + ": a count of " + std::to_string(count));
  std::vector<std::uint8_t> to(count * stride);
  const int error =
      attributes ? meshopt_decodeVertexBuffer(to.data(), count, stride, from.data(), from.size())
      : triangles
          ? (count % 3 != 0 ? -1 : meshopt_decodeIndexBuffer(to.data(), count, stride, from.data(), from.size()))
      : mode == "INDICES" ? meshopt_decodeIndexSequence(to.data(), count, stride, from.data(), from.size())
                          : -1;
  const int kind = attributes ? 0xa0 : triangles ? 0xe0 : 0xd0, newest = attributes ? 0 : 1;
  const int version = from.empty() ? -1 : from[0] - kind;  // of the stream
  if (error != 0 && version > newest && version < 16)
    unsupported("version " + std::to_string(version) + " of its " + mode);
  if (error != 0) Fail(extension + ": a buffer view is damaged");
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(to.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(to.data(), count, stride);
  } else if (filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(to.data(), count, stride);
  } else if (filter != "NONE") {
    unsupported("the filter '" + filter + "' of " + std::to_string(stride) + " bytes");
  }
  return to;
}

}  // namespace

std::string TextOf(const json::exception& error) {
  const std::string what = error.what();
  return what.substr(std::min(what.find("] ") + 2, what.size()));
}

void WarnOnce(MeshImport& import, const std::string& what) {
  if (std::ranges::find(import.warnings, what) == import.warnings.end()) import.warnings.push_back(what);
}

GltfFile::GltfFile(MeshFiles& files, MeshImport& import) : files_(files), import_(import) {
  std::string bytes = files.Read(files.mesh()).value_or(""), text;
  if (bytes.starts_with("glTF")) {
    const std::span<const std::uint8_t> all = base::AsBytes(bytes);
    const auto word = [&](std::size_t at) {
      return static_cast<std::uint32_t>(NumberAt<std::uint32_t>(Part(all, at, 4, "a chunk").data()));
    };
    if (word(4) == 1) throw OlderGltf();
    if (word(4) != 2) Fail("is binary glTF of version " + std::to_string(word(4)) + ": 1 and 2 are read");
    constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
    std::optional<std::span<const std::uint8_t>> binary;
    for (std::size_t at = 12; at + 8 <= std::min<std::size_t>(word(8), all.size());) {  // length, type, content
      const std::span<const std::uint8_t> chunk = Part(all, at + 8, word(at), "a chunk");
      if (word(at + 4) == kJson && text.empty()) text = base::AsText(chunk);
      if (word(at + 4) == kBinary && !binary) binary = chunk;
      at += 8 + chunk.size();
    }
    if (binary) {
      bytes.erase(0, static_cast<std::size_t>(binary->data() - all.data()));
      bytes.resize(binary->size());
      binary_ = std::move(bytes);
    }
  } else {
    text = base::WithoutMark(bytes);
  }
  if (const std::string problem = limits::JsonProblem(text); !problem.empty()) Fail("is " + problem);
  document_ = json::parse(text);
  if (!document_.is_object()) Fail("is not a JSON object");
  const json &asset = Child(document_, "asset"), &stated = Child(asset, "version"), &least = Child(asset, "minVersion");
  const std::string version = stated.is_string()   ? stated.get<std::string>()
                              : stated.is_number() ? stated.dump()
                                                   : "",
                    major = version.substr(0, version.find('.'));
  if (major == "0" || major == "1") throw OlderGltf();
  if (version.empty()) Fail("is not glTF: it has no asset.version");
  if (major != "2") Fail("is glTF of version '" + Short(version) + "': 1.0 and 2.0 are read");
  if (least.is_string() && least != "2.0") Fail("needs a reader of glTF " + least.get<std::string>() + ": 2.0 is read");
}

std::size_t GltfFile::Index(const json& object, const char* key) { return Whole(object, key); }

std::vector<std::size_t> GltfFile::Indices(const json& object, const char* key) {
  std::vector<std::size_t> indices;
  for (const json& index : Child(object, key)) indices.push_back(WholeOf(index, key));
  return indices;
}

const json& GltfFile::Child(const json& object, const char* key) {
  static const json none = json::object();
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

const json* GltfFile::Extension(const json& object, const char* name) {
  const json& extensions = Child(object, "extensions");
  const auto found = extensions.find(name);
  return found == extensions.end() || !found->is_object() ? nullptr : &*found;
}

const json& GltfFile::At(const char* list, std::size_t index) const {
  const json& items = Child(document_, list);
  if (!items.is_array() || index >= items.size() || !items[index].is_object())
    Fail(std::string("names ") + list + "[" + std::to_string(index) + "], which does not exist");
  return items[index];
}

std::optional<std::string> GltfFile::DataOf(const std::string& uri) {
  if (Lower(uri.substr(0, 5)) != "data:") return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) Fail("a data URI without data: '" + Short(uri) + "'");
  const std::string data = DecodePercent(uri.substr(comma + 1));
  return Lower(uri.substr(0, comma)).ends_with(";base64") ? FromBase64(data) : data;
}

// The content of a file beside the document, found as textures are.
std::string GltfFile::ReadFile(const std::string& uri) {
  const std::string name = "the buffer '" + Short(uri) + "'";
  if (uri.find("://") != std::string::npos && Lower(uri.substr(0, 4)) != "file")
    Fail(name + ": nothing is fetched from the net; put it beside the file");
  TextureFile found = FindTexture(uri, files_.mesh(), "", files_.folders());
  if (LowerExtension(found.file) != LowerExtension(DecodePercent(uri))) found.problem = "no such file";  // a picture
  const std::optional<std::string> bytes = files_.Read(found.file);
  if (!found.problem.empty()) Fail(name + ": " + found.problem);
  if (!bytes) Fail(name + " cannot be opened");
  if (const std::string problem = StandInProblem(base::AsBytes(*bytes)); !problem.empty()) Fail(name + " " + problem);
  if (found.is_elsewhere) WarnOnce(import_, name + " is taken from " + found.file.string());
  return *bytes;
}

const std::string& GltfFile::Buffer(std::size_t index) {
  const auto [at, is_new] = buffers_.try_emplace(index);
  if (!is_new) return at->second;
  const json& buffer = At("buffers", index);
  const std::string uri = buffer.value("uri", ""), name = "buffers[" + std::to_string(index) + "]";
  if (uri.empty()) {
    if (!binary_ || index != 0) Fail(name + " has no data");
    at->second = std::move(*binary_);  // of the one buffer that may be without a name
  } else {
    std::optional<std::string> data = DataOf(uri);
    at->second = data ? std::move(*data) : ReadFile(uri);
  }
  if (const std::size_t wanted = Whole(buffer, "byteLength"); at->second.size() < wanted)
    Fail(name + (uri.empty() ? "" : " ('" + Short(uri) + "')") + " is shorter than its byteLength: " +
         std::to_string(at->second.size()) + " of " + std::to_string(wanted) + " bytes");
  return at->second;
}

std::span<const std::uint8_t> GltfFile::View(std::size_t index) {
  const json& view = At("bufferViews", index);
  const auto known = decompressed_.find(index);
  if (known != decompressed_.end()) return known->second;
  const json* how = nullptr;
  const char* extension = "";
  for (const char* name : {"KHR_meshopt_compression", "EXT_meshopt_compression"}) {
    if (const json* found = Extension(view, name)) how = found, extension = name;
  }
  const json& where = how != nullptr ? *how : view;
  const std::span<const std::uint8_t> bytes =
      Part(base::AsBytes(Buffer(Whole(where, "buffer"))), Whole(where, "byteOffset", 0), Whole(where, "byteLength"),
           "a buffer view");
  return how == nullptr ? bytes : decompressed_[index] = Decompress(*how, bytes, extension);
}

float GltfFile::Normalised(double value, int type, bool normalised) {
  const auto* known = std::ranges::find(kTypes, type, &ComponentType::code);
  const double one = known == std::end(kTypes) ? 4294967295.0 : known->one;
  return static_cast<float>(!normalised || one == 0 ? value : std::max(value / one, -1.0));
}

// store(row, column, value) for all components, in order; those of a sparse accessor's own rows come again.
template <class Store>
void GltfFile::ReadComponents(std::size_t index, const Store& store) {
  const json& accessor = At("accessors", index);
  const int type = static_cast<int>(Whole(accessor, "componentType"));
  const std::size_t count = Whole(accessor, "count"), columns = ColumnsOf(accessor.at("type").get<std::string>());
  const auto rows = [&](const json& where, std::size_t n, int code, std::size_t width, const auto& take) {
    if (n == 0) return;
    const std::size_t view = Whole(where, "bufferView");
    const auto [ignored, size, number_at, one] = TypeOf(code);
    const std::size_t row = size * width;
    const std::size_t stated = Whole(At("bufferViews", view), "byteStride", 0), first = Whole(where, "byteOffset", 0),
                      stride = stated == 0 ? row : stated;
    const std::span<const std::uint8_t> bytes = View(view);
    if (stride > 1 << 16 || n > (std::size_t{1} << 40)) Fail("is too large");
    if (stride < row)
      Fail("the byteStride of bufferViews[" + std::to_string(view) + "], " + std::to_string(stride) +
           ", is less than the " + std::to_string(row) + " bytes of an element");
    const std::span<const std::uint8_t> used = Part(bytes, first, (n - 1) * stride + row, "an accessor");
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < width; ++c) take(i, c, number_at(used.data() + i * stride + c * size));
    }
  };
  if (accessor.contains("bufferView")) rows(accessor, count, type, columns, store);
  const json& sparse = Child(accessor, "sparse");
  if (sparse.empty()) return;
  if (Whole(sparse, "count") > count) Fail("its sparse part has more rows than it");
  std::vector<std::size_t> changed(Whole(sparse, "count"));
  const json& indices = sparse.at("indices");
  rows(indices, changed.size(), IndexType(indices), 1, [&](std::size_t i, std::size_t, double at) {
    changed[i] = static_cast<std::size_t>(at);
    if (changed[i] >= count) Fail("a sparse accessor names a row that does not exist");
  });
  rows(sparse.at("values"), changed.size(), type, columns,
       [&](std::size_t i, std::size_t c, double value) { store(changed[i], c, value); });
}

GltfTable GltfFile::ReadTable(std::size_t index) {
  return ReadItem("accessors", index, [&] { return TableOf(index); });
}

GltfTable GltfFile::TableOf(std::size_t index) {
  const json& accessor = At("accessors", index);
  GltfTable table{Whole(accessor, "count"), ColumnsOf(accessor.at("type").get<std::string>()), {}};
  if (table.count > (std::size_t{1} << 27)) Fail("is too large");
  const int type = static_cast<int>(Whole(accessor, "componentType"));
  const bool normalised = accessor.value("normalized", false);
  table.values.resize(table.count * table.columns);
  ReadComponents(index, [&](std::size_t row, std::size_t column, double value) {
    table.values[row * table.columns + column] = Normalised(value, type, normalised);
  });
  return table;
}

std::vector<std::uint32_t> GltfFile::ReadIndices(std::size_t index) {
  return ReadItem("accessors", index, [&] {
    const json& accessor = At("accessors", index);
    const std::size_t count = Whole(accessor, "count");
    if (count > (std::size_t{1} << 27)) Fail("is too large");
    IndexType(accessor);
    if (accessor.at("type") != "SCALAR") Fail("its type is not SCALAR, as that of indices must be");
    std::vector<std::uint32_t> indices(count);
    ReadComponents(index, [&](std::size_t row, std::size_t, double value) {
      indices[row] = value < 4294967295.0 ? static_cast<std::uint32_t>(value) : 0xffffffffu;
    });
    return indices;
  });
}

DracoMesh DecodeDraco(std::span<const std::uint8_t> bytes, const std::map<std::string, DracoAttribute>& attributes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw std::runtime_error("KHR_draco_mesh_compression: " + decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> from = std::move(decoded).value();
  DracoMesh mesh;
  for (draco::FaceIndex i(0); i < from->num_faces(); ++i) {
    for (const draco::PointIndex& point : from->face(i)) mesh.indices.push_back(point.value());
  }
  for (const auto& [name, wanted] : attributes) {
    const draco::PointAttribute* attribute = from->GetAttributeByUniqueId(wanted.id);
    if (attribute == nullptr || attribute->num_components() < 1 || attribute->num_components() > 4)
      throw std::runtime_error("KHR_draco_mesh_compression: the mesh has no attribute " + name);
    GltfTable& table = mesh.attributes[name];
    table.count = from->num_points();
    table.columns = static_cast<std::size_t>(attribute->num_components());
    table.values.reserve(table.count * table.columns);
    const bool is_float = attribute->data_type() == draco::DT_FLOAT32;
    for (draco::PointIndex i(0); i < from->num_points(); ++i) {
      std::array<float, 4> numbers{};
      std::array<std::int32_t, 4> whole{};
      const draco::AttributeValueIndex at = attribute->mapped_index(i);
      const bool good = is_float ? attribute->ConvertValue<float>(at, attribute->num_components(), numbers.data())
                                 : attribute->ConvertValue<std::int32_t>(at, attribute->num_components(), whole.data());
      if (!good) throw std::runtime_error("KHR_draco_mesh_compression: " + name + " has no values");
      for (std::size_t c = 0; c < table.columns; ++c) {
        table.values.push_back(is_float ? numbers[c]
                                        : GltfFile::Normalised(whole[c], wanted.component_type, wanted.normalised));
      }
    }
  }
  return mesh;
}

}  // namespace sim
