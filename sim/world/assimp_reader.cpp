#include <assimp/DefaultIOSystem.h>
#include <assimp/GltfMaterial.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "sim/world/fbx_text.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture_file.h"
#include "sim/world/xml_text.h"
#include "tools/base/files.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

// Input file with a bound on reads past its end: assimp's PLY importer (5.2) never ends on a truncated header.
class BoundedStream : public Assimp::IOStream {
 public:
  explicit BoundedStream(std::unique_ptr<Assimp::IOStream> stream) : stream_(std::move(stream)) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    const std::size_t read = stream_->Read(buffer, size, count);
    constexpr int kPatience = 1000;
    if (read == 0 && ++empty_reads_ > kPatience) throw std::runtime_error("the file ends too early");
    return read;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override { return stream_->Seek(offset, origin); }
  std::size_t Tell() const override { return stream_->Tell(); }
  std::size_t FileSize() const override { return stream_->FileSize(); }
  void Flush() override {}

 private:
  std::unique_ptr<Assimp::IOStream> stream_;
  int empty_reads_ = 0;
};

// File access of importers, which silently skip side files that cannot be opened.
class ImporterFiles : public Assimp::DefaultIOSystem {
 public:
  ImporterFiles(MeshFiles& files, MeshImport& import) : files_(files), import_(import) {}
  bool Exists(const char* file) const override { return files_.MayOpen(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    std::unique_ptr<Assimp::IOStream> stream(mode[0] == 'r' && files_.MayOpen(file) ? DefaultIOSystem::Open(file, mode)
                                                                                    : nullptr);
    if (stream == nullptr) {
      files_.Missing(file);
      return nullptr;
    }
    files_.Opened(file, stream->FileSize());
    if (LowerExtension(file) == ".dae") return Rewritten(file, ColladaForAssimp);
    if (LowerExtension(file) == ".x3d") return Rewritten(file, X3dForAssimp);
    return new BoundedStream(std::move(stream));  // Close() deletes it
  }

 private:
  Assimp::IOStream* Rewritten(const fs::path& file, std::string rewrite(std::string_view, std::vector<std::string>&)) {
    import_.warnings.clear();  // assimp opens the file several times
    try {
      return Memory(rewrite(base::ReadFile(file).value_or(""), import_.warnings));
    } catch (const std::runtime_error& error) {
      import_.problem = std::string("cannot be read: ") + error.what();
      return nullptr;
    }
  }

  static Assimp::IOStream* Memory(const std::string& text) {
    auto* bytes = new std::uint8_t[text.size() + 1];
    std::ranges::copy(text, bytes);
    return new Assimp::MemoryIOStream(bytes, text.size(), true);  // owns them
  }

  MeshFiles& files_;
  MeshImport& import_;
};

// FBX states its unit in centimetres and its axes; assimp (5.2) converts neither.
aiMatrix4x4 FbxToMetres(const aiScene& scene) {
  double unit = 1;
  int axis[3] = {0, 1, 2}, sign[3] = {1, 1, 1};  // of what becomes x, y, z
  if (scene.mMetaData != nullptr) {
    float single = 1;
    if (!scene.mMetaData->Get("UnitScaleFactor", unit) && scene.mMetaData->Get("UnitScaleFactor", single))
      unit = single;
    constexpr const char* kNames[] = {"CoordAxis", "UpAxis", "FrontAxis"};
    for (int i = 0; i < 3; ++i) {
      scene.mMetaData->Get(kNames[i], axis[i]);
      scene.mMetaData->Get(std::string(kNames[i]) + "Sign", sign[i]);
    }
  }
  const bool is_permutation = std::set<int>(axis, axis + 3) == std::set<int>{0, 1, 2};
  aiMatrix4x4 to_metres;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) {
      const bool here = is_permutation ? axis[row] == static_cast<int>(column) : row == column;
      to_metres[row][column] =
          here ? static_cast<float>(0.01 * unit * (is_permutation && sign[row] < 0 ? -1 : 1)) : 0.0f;
    }
  }
  return unit > 0 ? to_metres : aiMatrix4x4();
}

constexpr int kDeepestNode = 1000;

std::size_t BytesOf(const aiTexture& texture) {
  return texture.mHeight == 0 ? texture.mWidth : sizeof(aiTexel) * texture.mWidth * texture.mHeight;
}

// Nodes below and with this one; false where they go too deep.
bool CountNodes(const aiNode& node, int depth, std::uint64_t& nodes) {
  ++nodes;
  for (unsigned i = 0; depth <= kDeepestNode && i < node.mNumChildren; ++i)
    if (!CountNodes(*node.mChildren[i], depth + 1, nodes)) return false;
  return depth <= kDeepestNode;
}

std::string CountProblem(const aiScene& scene) {
  MeshCounts counts;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    counts.vertices += scene.mMeshes[i]->mNumVertices;
    for (unsigned f = 0; f < scene.mMeshes[i]->mNumFaces; ++f)
      counts.corners += scene.mMeshes[i]->mFaces[f].mNumIndices;
  }
  for (unsigned i = 0; i < scene.mNumTextures; ++i) counts.picture_bytes += BytesOf(*scene.mTextures[i]);
  counts.meshes = scene.mNumMeshes, counts.materials = scene.mNumMaterials;
  const bool deep = scene.mRootNode != nullptr && !CountNodes(*scene.mRootNode, 0, counts.nodes);
  return deep ? "has nodes more than " + std::to_string(kDeepestNode) + " deep" : counts.Problem();
}

// An array that may be missing.
template <class To, class From>
std::vector<To> Copied(const From* values, unsigned count) {
  std::vector<To> copy;
  for (unsigned i = 0; values != nullptr && i < count; ++i) {
    To& to = copy.emplace_back();
    for (int k = 0; k < To::length(); ++k) to[k] = values[i][static_cast<unsigned>(k)];
  }
  return copy;
}

class Converter {
 public:
  Converter(const aiScene& from, std::string extension, MeshImport& import)
      : from_(from), extension_(std::move(extension)), import_(import), to_(import.scene) {}

  void Convert() {
    for (unsigned i = 0; i < from_.mNumMaterials; ++i) AppendMaterial(*from_.mMaterials[i]);
    for (unsigned i = 0; i < from_.mNumTextures; ++i) {
      const aiTexture& texture = *from_.mTextures[i];
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(texture.pcData);
      to_.pictures.push_back({texture.mWidth, texture.mHeight, {bytes, bytes + BytesOf(texture)}});
    }
    if (from_.mRootNode != nullptr) Place(*from_.mRootNode, glm::mat4(1));
    for (unsigned i = 0; i < from_.mNumMeshes; ++i) AppendMesh(i);
    if (from_.mRootNode == nullptr) return;
    AppendNode(*from_.mRootNode, -1);
    if (extension_ == ".amf")
      import_.warnings.push_back("its unit is not read: a number is a metre (scale: 0.001 makes it a millimetre)");
    if (extension_ == ".fbx") {
      glm::mat4& root = to_.nodes[0].transform;
      root = ToGlm(FbxToMetres(from_) * from_.mRootNode->mTransformation);
    }
  }

 private:
  static glm::mat4 ToGlm(const aiMatrix4x4& m) {  // assimp is row-major, GLM column-major
    return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
  }

  void AppendNode(const aiNode& node, int parent) {
    const auto index = static_cast<int>(to_.nodes.size());
    to_.nodes.push_back({parent, ToGlm(node.mTransformation), {node.mMeshes, node.mMeshes + node.mNumMeshes}});
    for (unsigned i = 0; i < node.mNumChildren; ++i) AppendNode(*node.mChildren[i], index);
  }

  void Place(const aiNode& node, const glm::mat4& parent) {
    const glm::mat4 to_root = parent * ToGlm(node.mTransformation);
    to_root_.try_emplace(node.mName.C_Str(), to_root);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) mesh_to_root_.try_emplace(node.mMeshes[i], to_root);
    for (unsigned i = 0; i < node.mNumChildren; ++i) Place(*node.mChildren[i], to_root);
  }

  // Vertices of a skin where its joints are: sum of w N^-1 J B v, with the joint's inverse bind matrix B.
  void Pose(const aiMesh& in, const glm::mat4& N, ImportedMesh& out) const {
    const glm::mat4 from_root = glm::inverse(N);
    std::vector<glm::mat4> sum(in.mNumVertices, glm::mat4(0));
    std::vector<float> weight(in.mNumVertices, 0);
    for (unsigned b = 0; b < in.mNumBones; ++b) {
      const aiBone& bone = *in.mBones[b];
      const auto J = to_root_.find(bone.mName.C_Str());
      if (J == to_root_.end()) return;
      const glm::mat4 M = from_root * J->second * ToGlm(bone.mOffsetMatrix);
      for (unsigned k = 0; k < bone.mNumWeights; ++k) {
        const auto& [vertex, w] = bone.mWeights[k];
        if (vertex >= in.mNumVertices) return;
        sum[vertex] += w * M;
        weight[vertex] += w;
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (!(weight[i] > 0)) continue;
      const glm::mat4 A = sum[i] / weight[i];
      out.positions[i] = A * glm::vec4(out.positions[i], 1);
      if (!out.normals.empty()) out.normals[i] = glm::inverseTranspose(glm::mat3(A)) * out.normals[i];
    }
  }

  void AppendMesh(unsigned index) {
    const aiMesh& in = *from_.mMeshes[index];
    ImportedMesh& out = to_.meshes.emplace_back();
    out.material = in.mMaterialIndex;
    if ((in.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) return;
    out.name = in.mName.C_Str();
    out.positions = Copied<glm::vec3>(in.mVertices, in.mNumVertices);
    out.normals = Copied<glm::vec3>(in.mNormals, in.mNumVertices);
    out.colors = Copied<glm::vec4>(in.mColors[0], in.mNumVertices);
    if (extension_ == ".amf" && std::ranges::all_of(out.colors, [](const glm::vec4& c) { return c == glm::vec4(0); }))
      out.colors.clear();  // assimp's, of a file without colours
    if (!out.colors.empty() && (extension_ == ".amf" || extension_ == ".x3d"))
      to_.materials[in.mMaterialIndex].base_color = glm::vec4(1);  // assimp's 0.6; they take the colour's place
    if (const auto N = mesh_to_root_.find(index); in.HasBones() && N != mesh_to_root_.end()) Pose(in, N->second, out);
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set) {
      if (!in.HasTextureCoords(set)) continue;
      out.uvs.resize(set + 1);
      out.uvs[set] = Copied<glm::vec2>(in.mTextureCoords[set], in.mNumVertices);
    }
    for (unsigned i = 0; i < in.mNumFaces; ++i) {
      const aiFace& face = in.mFaces[i];
      if (face.mNumIndices == 3) out.triangles.emplace_back(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
    }
  }

  void AppendMaterial(const aiMaterial& in) {
    ImportedMaterial& out = to_.materials.emplace_back();
    out.name = in.GetName().C_Str();
    const auto has = [&](aiTextureType type) { return in.GetTextureCount(type) > 0; };
    const aiTextureType base = has(aiTextureType_BASE_COLOR) ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE;
    const aiTextureType glow =
        has(aiTextureType_EMISSION_COLOR) ? aiTextureType_EMISSION_COLOR : aiTextureType_EMISSIVE;
    aiColor4D color(1, 1, 1, 1);
    if (in.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) {
      aiColor3D diffuse;
      // A texture takes the colour's place; in glTF 1.0, where assimp gives black, too.
      static constexpr std::array kReplacing{".fbx", ".3ds", ".ase", ".x3d", ".gltf", ".glb"};
      const bool is_replaced = has(base) && std::ranges::find(kReplacing, extension_) != kReplacing.end();
      // The names of Maya's and 3ds Max' physical materials in FBX; of a missing colour assimp makes black.
      static constexpr const char* kNames[] = {"$clr.diffuse", "$raw.Maya|baseColor",
                                               "$raw.3dsMax|Parameters|base_color"};
      const bool is_found = !is_replaced && std::ranges::any_of(kNames, [&](auto name) {
        return in.Get(name, 0, 0, diffuse) == AI_SUCCESS;
      });
      if (!is_found) diffuse = {1, 1, 1};
      if (!is_found && !is_replaced && !has(base)) import_.warnings.push_back("a material without a colour is white");
      color = {diffuse.r, diffuse.g, diffuse.b, 1};
    }
    out.base_color = {color.r, color.g, color.b, color.a};
    aiColor3D emission(0, 0, 0);
    in.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
    out.emission = {emission.r, emission.g, emission.b};
    in.Get(AI_MATKEY_OPACITY, out.opacity);
    aiString mode;
    if (in.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == AI_SUCCESS) out.alpha_mode = mode.C_Str();
    in.Get(AI_MATKEY_GLTF_ALPHACUTOFF, out.alpha_cutoff);
    in.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), out.normal_scale);
    in.Get(AI_MATKEY_METALLIC_FACTOR, out.metallic);
    in.Get(AI_MATKEY_ROUGHNESS_FACTOR, out.roughness);
    out.color_map = MapOf(in, base);
    out.opacity_map = MapOf(in, aiTextureType_OPACITY);
    out.emission_map = MapOf(in, glow);
    out.normal_map = MapOf(in, aiTextureType_NORMALS);
    for (const aiTextureType gloss :
         {aiTextureType_UNKNOWN, aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_METALNESS, aiTextureType_SHININESS}) {
      if (has(gloss)) out.gloss_map = MapOf(in, gloss);
    }
    out.has_bumps = has(aiTextureType_HEIGHT) && !has(aiTextureType_NORMALS);
  }

  ImportedMap MapOf(const aiMaterial& in, aiTextureType type) const {
    ImportedMap map;
    aiString path;
    if (in.Get(AI_MATKEY_TEXTURE(type, 0), path) != AI_SUCCESS) return map;
    map.picture = path.C_Str();
    if (map.picture.empty()) import_.warnings.push_back("a texture without a name (RelativeFilename) is left out");
    map.embedded = from_.GetEmbeddedTextureAndIndex(path.C_Str()).second;
    int channel = 0;
    in.Get(AI_MATKEY_UVWSRC(type, 0), channel);
    map.uv.channel = static_cast<unsigned>(std::max(channel, 0));
    for (const std::size_t axis : {0u, 1u}) {
      int mode = aiTextureMapMode_Wrap;
      in.Get(axis == 0 ? "$tex.mapmodeu" : "$tex.mapmodev", type, 0, mode);
      if (extension_ == ".x3d") mode = mode == 0 ? aiTextureMapMode_Clamp : aiTextureMapMode_Wrap;  // it is repeatS, T
      if (mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal) map.uv.wrap[axis] = UvWrap::clamp;
      if (mode == aiTextureMapMode_Mirror) map.uv.wrap[axis] = UvWrap::mirror;
    }
    aiUVTransform t;
    if (in.Get(AI_MATKEY_UVTRANSFORM(type, 0), t) != AI_SUCCESS) return map;
    // assimp's: v up; scaled, then turned about (0.5, 0.5), then moved.
    const double c = std::cos(t.mRotation), s = std::sin(t.mRotation);
    const glm::dmat3 flip(1, 0, 0, 0, -1, 0, 0, 1, 1), scale(t.mScaling.x, 0, 0, 0, t.mScaling.y, 0, 0, 0, 1),
        turn(c, s, 0, -s, c, 0, 0.5 - 0.5 * c + 0.5 * s, 0.5 - 0.5 * s - 0.5 * c, 1),
        move(1, 0, 0, 0, 1, 0, t.mTranslation.x, t.mTranslation.y, 1);
    map.uv.transform = glm::dmat3x2(flip * move * turn * scale * flip);
    return map;
  }

  const aiScene& from_;
  const std::string extension_;
  MeshImport& import_;
  ImportedScene& to_;
  std::map<std::string, glm::mat4> to_root_;    // of each node
  std::map<unsigned, glm::mat4> mesh_to_root_;  // of each mesh's first node
};

}  // namespace

void ReadByAssimp(MeshFiles& files, MeshImport& import) {
  const std::string extension = LowerExtension(files.mesh());
  if (extension == ".fbx") import.warnings = FbxWarnings(files.Read(files.mesh()).value_or(""));
  Assimp::Importer importer;
  importer.SetIOHandler(new ImporterFiles(files, import));              // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);  // which would stand for joints
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(files.mesh().string(), aiProcess_ValidateDataStructure);
  if (scene != nullptr) import.problem = CountProblem(*scene);  // too large a scene is not processed
  if (scene != nullptr && import.problem.empty()) {
    // assimp (5.2) joins vertices of different colours.
    const bool has_colors = std::any_of(scene->mMeshes, scene->mMeshes + scene->mNumMeshes,
                                        [](const aiMesh* mesh) { return mesh->HasVertexColors(0); });
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                         (has_colors ? 0U : unsigned{aiProcess_JoinIdenticalVertices}));
    if (scene != nullptr) import.problem = CountProblem(*scene);
  }
  if (scene == nullptr && import.problem.empty()) {
    const std::string reason = importer.GetErrorString();
    const bool only_lines = reason.find("No meshes remaining") != std::string::npos;  // the importer's message
    const bool too_much = reason.find("bad_alloc") != std::string::npos;              // the library's
    const bool nothing = reason.find("mNumMeshes is 0") != std::string::npos;         // its validation's
    const bool unknown = reason.find("No suitable reader") != std::string::npos;
    import.problem = only_lines ? "has no triangles: points and lines are not rendered"
                     : unknown  ? "is of a kind that is not read: export it as .glb, .obj or .ply"
                     : nothing  ? "holds no mesh that the importer (assimp) knows: export it as .glb, .obj or .ply"
                     : too_much ? "cannot be read: the importer (assimp) needs more memory than a file of this size may"
                                : "cannot be read by the importer (assimp): " + reason +
                                      " (.glb, .obj and .ply have readers of their own)";
  }
  if (!import.problem.empty()) return;
  Converter(*scene, extension, import).Convert();
}

}  // namespace sim
