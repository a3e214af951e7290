#include "sim/world/mesh_serialization.h"

#include <assimp/material.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace sim {
namespace {

constexpr std::uint64_t kMostVertices = 1 << 27;  // and corners of faces
constexpr std::uint64_t kMostNodes = 1 << 20;     // and meshes, materials
constexpr int kDeepestNode = 1000;
constexpr std::uint64_t kMostTextureBytes = std::uint64_t{1} << 32;

class Writer {
 public:
  template <class T>
  void Value(const T& value) {
    Array(&value, 1);
  }
  template <class T>
  void Array(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const std::uint8_t*>(values);
    if (count > 0) bytes_.insert(bytes_.end(), from, from + count * sizeof(T));
  }
  void Text(const aiString& text) {
    Value(text.length);
    Array(text.data, text.length);
  }
  // Whether it is there, and then so many.
  template <class T>
  void Optional(const T* values, std::size_t count) {
    Value(static_cast<std::uint8_t>(values != nullptr));
    if (values != nullptr) Array(values, count);
  }
  std::vector<std::uint8_t> Take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T Value() {
    T value{};
    Copy(&value, 1);
    return value;
  }
  // A number of things that take `least` bytes each.
  unsigned Count(std::size_t least = 1) {
    const auto count = Value<unsigned>();
    if (count > bytes_.size() / least) throw Broken();
    return count;
  }
  template <class T>
  T* Array(std::size_t count) {
    if (count > bytes_.size() / sizeof(T)) throw Broken();
    if (count == 0) return nullptr;
    std::unique_ptr<T[]> values(new T[count]);
    Copy(values.get(), count);
    return values.release();
  }
  template <class T>
  T* Optional(std::size_t count) {
    return Value<std::uint8_t>() != 0 ? Array<T>(count) : nullptr;
  }
  aiString Text() {
    aiString text;
    text.length = Value<ai_uint32>();
    if (text.length >= sizeof text.data) throw Broken();
    Copy(text.data, text.length);
    text.data[text.length] = '\0';
    return text;
  }
  static std::runtime_error Broken() { return std::runtime_error("the importer's answer is broken off"); }

 private:
  template <class T>
  void Copy(T* to, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > bytes_.size() / sizeof(T)) throw Broken();
    if (count > 0) std::memcpy(static_cast<void*>(to), bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
  }

  std::span<const std::uint8_t> bytes_;
};

void Write(Writer& out, const aiNode& node) {
  out.Value(node.mTransformation);
  out.Value(node.mNumMeshes);
  out.Array(node.mMeshes, node.mNumMeshes);
  out.Value(node.mNumChildren);
  for (unsigned i = 0; i < node.mNumChildren; ++i) Write(out, *node.mChildren[i]);
}

std::unique_ptr<aiNode> ReadNode(Reader& in, unsigned meshes, int depth = 0) {
  if (depth > kDeepestNode) throw Reader::Broken();
  auto node = std::make_unique<aiNode>();
  node->mTransformation = in.Value<aiMatrix4x4>();
  const unsigned named = in.Count(sizeof(unsigned));
  node->mMeshes = in.Array<unsigned>(named);
  node->mNumMeshes = named;
  for (unsigned i = 0; i < named; ++i) {
    if (node->mMeshes[i] >= meshes) throw Reader::Broken();
  }
  const unsigned children = in.Count();
  if (children > 0) node->mChildren = new aiNode*[children]();
  for (unsigned i = 0; i < children; ++i) {
    node->mChildren[i] = ReadNode(in, meshes, depth + 1).release();
    node->mNumChildren = i + 1;
  }
  return node;
}

void Write(Writer& out, const aiMesh& mesh) {
  const std::size_t n = mesh.mNumVertices;
  out.Text(mesh.mName);
  out.Value(mesh.mPrimitiveTypes);
  out.Value(mesh.mMaterialIndex);
  out.Value(mesh.mNumVertices);
  out.Array(mesh.mVertices, n);
  out.Optional(mesh.mNormals, n);
  out.Optional(mesh.mColors[0], n);
  for (const aiVector3D* uvs : mesh.mTextureCoords) out.Optional(uvs, n);
  out.Value(mesh.mNumFaces);
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    out.Value(face.mNumIndices);
    out.Array(face.mIndices, face.mNumIndices);
  }
}

std::unique_ptr<aiMesh> ReadMesh(Reader& in, unsigned materials) {
  auto mesh = std::make_unique<aiMesh>();
  mesh->mName = in.Text();
  mesh->mPrimitiveTypes = in.Value<unsigned>();
  mesh->mMaterialIndex = in.Value<unsigned>();
  if (mesh->mMaterialIndex >= materials) throw Reader::Broken();
  const unsigned n = in.Count(sizeof(aiVector3D));
  mesh->mVertices = in.Array<aiVector3D>(n);
  mesh->mNumVertices = n;
  mesh->mNormals = in.Optional<aiVector3D>(n);
  mesh->mColors[0] = in.Optional<aiColor4D>(n);
  for (aiVector3D*& uvs : mesh->mTextureCoords) uvs = in.Optional<aiVector3D>(n);
  const unsigned faces = in.Count(sizeof(unsigned));
  if (faces > 0) mesh->mFaces = new aiFace[faces];
  mesh->mNumFaces = faces;
  for (unsigned i = 0; i < faces; ++i) {
    const unsigned corners = in.Count(sizeof(unsigned));
    mesh->mFaces[i].mIndices = in.Array<unsigned>(corners);
    mesh->mFaces[i].mNumIndices = corners;
  }
  return mesh;
}

void Write(Writer& out, const aiMaterial& material) {
  out.Value(material.mNumProperties);
  for (unsigned i = 0; i < material.mNumProperties; ++i) {
    const aiMaterialProperty& property = *material.mProperties[i];
    out.Text(property.mKey);
    out.Value(property.mSemantic);
    out.Value(property.mIndex);
    out.Value(property.mType);
    out.Value(property.mDataLength);
    out.Array(property.mData, property.mDataLength);
  }
}

std::unique_ptr<aiMaterial> ReadMaterial(Reader& in) {
  auto material = std::make_unique<aiMaterial>();
  for (unsigned left = in.Count(); left > 0; --left) {
    const aiString key = in.Text();
    const auto semantic = in.Value<unsigned>(), index = in.Value<unsigned>();
    const auto type = in.Value<aiPropertyTypeInfo>();
    const unsigned length = in.Count();
    const std::unique_ptr<char[]> data(in.Array<char>(length));
    if (length > 0) material->AddBinaryProperty(data.get(), length, key.C_Str(), semantic, index, type);
  }
  return material;
}

std::size_t TexelsOf(const aiTexture& texture) {  // or bytes, where it is a file
  return texture.mHeight == 0 ? (texture.mWidth + sizeof(aiTexel) - 1) / sizeof(aiTexel)
                              : std::size_t{texture.mWidth} * texture.mHeight;
}

void Write(Writer& out, const aiTexture& texture) {
  out.Value(texture.mWidth);
  out.Value(texture.mHeight);
  out.Text(texture.mFilename);
  const std::size_t bytes = texture.mHeight == 0 ? texture.mWidth : TexelsOf(texture) * sizeof(aiTexel);
  out.Array(reinterpret_cast<const std::uint8_t*>(texture.pcData), bytes);
  for (std::size_t i = bytes; i < TexelsOf(texture) * sizeof(aiTexel); ++i) out.Value(std::uint8_t{0});
}

std::unique_ptr<aiTexture> ReadTexture(Reader& in) {
  auto texture = std::make_unique<aiTexture>();
  texture->mWidth = in.Value<unsigned>();
  texture->mHeight = in.Value<unsigned>();
  texture->mFilename = in.Text();
  texture->pcData = in.Array<aiTexel>(TexelsOf(*texture));
  return texture;
}

// The list's length is at the same time how many of it there are, should one of them throw.
template <class T, class Read>
void ReadList(Reader& in, T**& list, unsigned& count, const Read& read) {
  const unsigned wanted = in.Count();
  if (wanted > 0) list = new T*[wanted]();
  for (unsigned i = 0; i < wanted; ++i) {
    list[i] = read().release();
    count = i + 1;
  }
}

// Nodes below and with this one, and how deep they go.
struct Depth {
  std::uint64_t nodes = 0;
  int deepest = 0;
};
void Measure(const aiNode& node, int depth, Depth& depths) {
  depths.deepest = std::max(depths.deepest, depth);
  if (++depths.nodes > kMostNodes || depth > kDeepestNode) return;
  for (unsigned i = 0; i < node.mNumChildren; ++i) Measure(*node.mChildren[i], depth + 1, depths);
}

std::string TooMany(const char* what, std::uint64_t most) {
  return std::string("has more ") + what + " than are read: " + std::to_string(most);
}

}  // namespace

std::string MeshCountProblem(const aiScene& scene) {
  std::uint64_t vertices = 0, corners = 0, bytes = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    vertices += scene.mMeshes[i]->mNumVertices;
    for (unsigned f = 0; f < scene.mMeshes[i]->mNumFaces; ++f) corners += scene.mMeshes[i]->mFaces[f].mNumIndices;
  }
  for (unsigned i = 0; i < scene.mNumTextures; ++i) bytes += TexelsOf(*scene.mTextures[i]) * sizeof(aiTexel);
  Depth depths;
  if (scene.mRootNode != nullptr) Measure(*scene.mRootNode, 0, depths);
  if (vertices > kMostVertices) return TooMany("vertices", kMostVertices);
  if (corners > kMostVertices) return TooMany("corners of faces", kMostVertices);
  if (depths.nodes > kMostNodes) return TooMany("nodes", kMostNodes);
  if (scene.mNumMeshes > kMostNodes || scene.mNumMaterials > kMostNodes)
    return TooMany("meshes or materials", kMostNodes);
  if (depths.deepest > kDeepestNode) return "has nodes more than " + std::to_string(kDeepestNode) + " deep";
  if (bytes > kMostTextureBytes) return TooMany("bytes of textures", kMostTextureBytes);
  return "";
}

std::vector<std::uint8_t> ToBytes(const aiScene& scene) {
  Writer out;
  out.Value(scene.mNumMaterials);
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) Write(out, *scene.mMaterials[i]);
  out.Value(scene.mNumTextures);
  for (unsigned i = 0; i < scene.mNumTextures; ++i) Write(out, *scene.mTextures[i]);
  out.Value(scene.mNumMeshes);
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) Write(out, *scene.mMeshes[i]);
  out.Value(static_cast<std::uint8_t>(scene.mRootNode != nullptr));
  if (scene.mRootNode != nullptr) Write(out, *scene.mRootNode);
  return out.Take();
}

std::unique_ptr<aiScene> SceneFromBytes(std::span<const std::uint8_t> bytes) {
  Reader in(bytes);
  auto scene = std::make_unique<aiScene>();
  ReadList(in, scene->mMaterials, scene->mNumMaterials, [&] { return ReadMaterial(in); });
  ReadList(in, scene->mTextures, scene->mNumTextures, [&] { return ReadTexture(in); });
  ReadList(in, scene->mMeshes, scene->mNumMeshes, [&] { return ReadMesh(in, scene->mNumMaterials); });
  if (in.Value<std::uint8_t>() != 0) scene->mRootNode = ReadNode(in, scene->mNumMeshes).release();
  return scene;
}

}  // namespace sim
