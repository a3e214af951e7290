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

std::runtime_error Broken() { return std::runtime_error("the importer's answer is broken off"); }

// Writer and Reader have the same members: one function per type describes both directions.
class Writer {
 public:
  static constexpr bool kReads = false;

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
  void Count(unsigned count, std::size_t /*least*/ = 1) { Value(count); }
  void Text(const aiString& text) {
    Value(text.length);
    Array(text.data, text.length);
  }
  void Text(const std::string& text) {
    Value(text.size());
    Array(text.data(), text.size());
  }
  std::vector<std::uint8_t> Take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  static constexpr bool kReads = true;

  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  void Value(T& value) {
    Copy(&value, 1);
  }
  template <class T>
  void Array(T*& values, std::size_t count) {
    if (count > bytes_.size() / sizeof(T)) throw Broken();
    if (count == 0) return;
    values = new T[count];
    Copy(values, count);
  }
  // A number of things that take `least` bytes each.
  void Count(unsigned& count, std::size_t least = 1) {
    unsigned wanted = 0;
    Value(wanted);
    if (wanted > bytes_.size() / least) throw Broken();
    count = wanted;
  }
  void Text(aiString& text) {
    ai_uint32 length = 0;
    Value(length);
    if (length >= sizeof text.data) throw Broken();
    Copy(text.data, length);
    text.data[length] = '\0';
    text.length = length;
  }
  void Text(std::string& text) {
    std::size_t length = 0;
    Value(length);
    if (length > bytes_.size()) throw Broken();
    text.resize(length);
    Copy(text.data(), length);
  }

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

// An array that may be missing.
template <class Io, class T>
void PassOptional(Io& io, T*& values, std::size_t count) {
  std::uint8_t there = values != nullptr;
  io.Value(there);
  if (there != 0) io.Array(values, count);
}

// Pointers to what `pass` passes. `count` counts those that are there, should it throw.
template <class Io, class T, class Pass>
void PassList(Io& io, T**& list, unsigned& count, const Pass& pass) {
  unsigned wanted = count;
  io.Count(wanted);
  if (Io::kReads && wanted > 0) list = new T*[wanted]();
  for (unsigned i = 0; i < wanted; ++i) {
    if (Io::kReads) list[i] = new T, count = i + 1;
    pass(*list[i]);
  }
}

template <class Io>
void PassNode(Io& io, aiNode& node, unsigned meshes, int depth) {
  if (depth > kDeepestNode) throw Broken();
  io.Value(node.mTransformation);
  unsigned named = node.mNumMeshes;
  io.Count(named, sizeof(unsigned));
  io.Array(node.mMeshes, named);
  node.mNumMeshes = named;
  for (unsigned i = 0; i < named; ++i) {
    if (node.mMeshes[i] >= meshes) throw Broken();
  }
  PassList(io, node.mChildren, node.mNumChildren, [&](aiNode& child) { PassNode(io, child, meshes, depth + 1); });
}

template <class Io>
void PassMesh(Io& io, aiMesh& mesh, unsigned materials) {
  io.Text(mesh.mName);
  io.Value(mesh.mPrimitiveTypes);
  io.Value(mesh.mMaterialIndex);
  if (mesh.mMaterialIndex >= materials) throw Broken();
  io.Count(mesh.mNumVertices, sizeof(aiVector3D));
  const std::size_t n = mesh.mNumVertices;
  io.Array(mesh.mVertices, n);
  PassOptional(io, mesh.mNormals, n);
  PassOptional(io, mesh.mColors[0], n);
  for (aiVector3D*& uvs : mesh.mTextureCoords) PassOptional(io, uvs, n);
  io.Count(mesh.mNumFaces, sizeof(unsigned));
  if (Io::kReads && mesh.mNumFaces > 0) mesh.mFaces = new aiFace[mesh.mNumFaces];
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    io.Count(mesh.mFaces[i].mNumIndices, sizeof(unsigned));
    io.Array(mesh.mFaces[i].mIndices, mesh.mFaces[i].mNumIndices);
  }
}

template <class Io>
void PassProperty(Io& io, aiMaterialProperty& property) {
  io.Text(property.mKey);
  io.Value(property.mSemantic);
  io.Value(property.mIndex);
  io.Value(property.mType);
  io.Count(property.mDataLength);
  io.Array(property.mData, property.mDataLength);
}

template <class Io>
void PassMaterial(Io& io, aiMaterial& material) {
  unsigned count = material.mNumProperties;
  io.Count(count);
  for (unsigned i = 0; i < count; ++i) {
    if constexpr (Io::kReads) {
      aiMaterialProperty p;  // owns its data
      PassProperty(io, p);
      if (p.mDataLength > 0)
        material.AddBinaryProperty(p.mData, p.mDataLength, p.mKey.C_Str(), p.mSemantic, p.mIndex, p.mType);
    } else {
      PassProperty(io, *material.mProperties[i]);
    }
  }
}

std::size_t TexelsOf(const aiTexture& texture) {  // or bytes, where it is a file
  return texture.mHeight == 0 ? (texture.mWidth + sizeof(aiTexel) - 1) / sizeof(aiTexel)
                              : std::size_t{texture.mWidth} * texture.mHeight;
}

template <class Io>
void PassTexture(Io& io, aiTexture& texture) {
  io.Value(texture.mWidth);
  io.Value(texture.mHeight);
  io.Text(texture.mFilename);
  const std::size_t texels = TexelsOf(texture),
                    whole = texture.mHeight == 0 ? texture.mWidth / sizeof(aiTexel) : texels;
  if (Io::kReads || whole == texels) return io.Array(texture.pcData, texels);
  io.Array(texture.pcData, whole);
  aiTexel last{};  // the rest of a file's bytes
  std::memcpy(&last, texture.pcData + whole, texture.mWidth % sizeof(aiTexel));
  io.Value(last);
}

template <class Io>
void PassScene(Io& io, aiScene& scene) {
  PassList(io, scene.mMaterials, scene.mNumMaterials, [&](aiMaterial& material) { PassMaterial(io, material); });
  PassList(io, scene.mTextures, scene.mNumTextures, [&](aiTexture& texture) { PassTexture(io, texture); });
  PassList(io, scene.mMeshes, scene.mNumMeshes, [&](aiMesh& mesh) { PassMesh(io, mesh, scene.mNumMaterials); });
  std::uint8_t has_root = scene.mRootNode != nullptr;
  io.Value(has_root);
  if (Io::kReads && has_root != 0) scene.mRootNode = new aiNode;
  if (has_root != 0) PassNode(io, *scene.mRootNode, scene.mNumMeshes, 0);
}

template <class Io, class Texts>
void PassTexts(Io& io, Texts& texts) {
  auto count = static_cast<unsigned>(texts.size());
  io.Count(count);
  if constexpr (Io::kReads) {
    for (std::string text; count > 0; --count) io.Text(text), texts.insert(texts.end(), text);
  } else {
    for (const auto& each : texts) {
      const std::string text = each;
      io.Text(text);
    }
  }
}

template <class Io>
void PassImport(Io& io, MeshImport& import) {
  io.Text(import.problem);
  PassTexts(io, import.files);
  PassTexts(io, import.missing);
  PassTexts(io, import.warnings);
  io.Value(import.origin);
  if (!import.problem.empty()) return;
  if (Io::kReads) import.scene = std::make_unique<aiScene>();
  PassScene(io, *import.scene);
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

std::vector<std::uint8_t> ToBytes(const MeshImport& import) {
  Writer out;
  PassImport(out, const_cast<MeshImport&>(import));  // a writer changes nothing
  return out.Take();
}

MeshImport ImportFromBytes(std::span<const std::uint8_t> bytes) {
  Reader in(bytes);
  MeshImport import;
  PassImport(in, import);
  return import;
}

}  // namespace sim
