#include "sim/world/mesh_file.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sim/world/image_file.h"
#include "sim/world/srgb.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

// A file that cannot be read past its end for ever: assimp's PLY importer (5.2) does so when a header is cut off.
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

// Importers quietly do without a side file (an OBJ's materials, say) that cannot be opened: this remembers which.
class NotingFiles : public Assimp::DefaultIOSystem {
 public:
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    std::unique_ptr<Assimp::IOStream> stream(DefaultIOSystem::Open(file, mode));
    if (stream == nullptr) {
      missing_.insert(fs::path(file).filename().string());
      return nullptr;
    }
    return new BoundedStream(std::move(stream));  // Close() deletes it
  }
  const std::set<std::string>& missing() const { return missing_; }

 private:
  std::set<std::string> missing_;
};

std::string LowerExtension(const fs::path& file) {
  std::string text = file.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

glm::dmat4 ToGlm(const aiMatrix4x4& m) {  // assimp is row-major, GLM column-major
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

bool IsFinite(const aiVector3D& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string ToText(const aiVector3D& v) {
  std::ostringstream text;
  text << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return text.str();
}

class FileReader {
 public:
  FileReader(const MeshDescription& description, Scene& scene, TextureCache& textures,
             std::vector<std::string>& problems)
      : file_(description.file), scene_(scene), textures_(textures), problems_(problems) {
    world_from_file_ = glm::mat4_cast(description.orientation);
    for (int c = 0; c < 3; ++c) world_from_file_[c] *= description.scale;
    world_from_file_[3] = glm::dvec4(description.position, 1.0);
  }

  void Read() {
    std::error_code error;
    if (!fs::exists(file_, error)) return Problem("no such file");
    if (!fs::is_regular_file(file_, error)) return Problem("not a file");

    Assimp::Importer importer;
    auto* files = new NotingFiles;  // the importer owns it
    importer.SetIOHandler(files);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                           aiProcess_ValidateDataStructure;
    ai_ = importer.ReadFile(file_.string(), steps);
    if (ai_ == nullptr) {
      const std::string reason = importer.GetErrorString();
      const bool only_lines = reason.find("No meshes remaining") != std::string::npos;  // the importer's words for it
      return Problem(only_lines ? "has no triangles" : "cannot be read: " + reason);
    }
    for (const std::string& missing : files->missing()) {
      scene_.warnings.push_back(file_.string() + ": names " + missing + ", which cannot be opened");
    }

    material_of_.assign(ai_->mNumMaterials, -1);
    const std::size_t problems_before = problems_.size(), meshes_before = scene_.meshes.size();
    if (ai_->mRootNode != nullptr) AppendNode(*ai_->mRootNode, world_from_file_);
    if (problems_.size() == problems_before && scene_.meshes.size() == meshes_before) Problem("has no triangles");
  }

 private:
  void Problem(const std::string& what) { problems_.push_back(file_.string() + ": " + what); }

  void AppendNode(const aiNode& node, const glm::dmat4& world_from_parent) {
    const glm::dmat4 world_from_node = world_from_parent * ToGlm(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) AppendMesh(*ai_->mMeshes[node.mMeshes[i]], world_from_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) AppendNode(*node.mChildren[i], world_from_node);
  }

  void AppendMesh(const aiMesh& in, const glm::dmat4& world_from_node) {
    if ((in.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) return;
    Mesh out;
    out.name = in.mName.length > 0 ? in.mName.C_Str() : "mesh " + std::to_string(scene_.meshes.size());
    const std::string label = "mesh '" + out.name + "': ";
    const glm::dmat3 linear(world_from_node);
    const glm::dmat3 normal_transform = glm::transpose(glm::inverse(linear));
    if (!(std::abs(glm::determinant(linear)) > 0))
      return Problem(label + "its node's transform is singular or not finite");

    out.positions.reserve(in.mNumVertices);
    for (unsigned i = 0; i < in.mNumVertices; ++i) {
      const aiVector3D& v = in.mVertices[i];
      const glm::vec3 x(world_from_node * glm::dvec4(v.x, v.y, v.z, 1.0));
      if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z)) {
        return Problem(label + "vertex " + std::to_string(i) + " is not finite: " + ToText(v));
      }
      out.positions.push_back(x);
    }
    AppendNormals(in, normal_transform, label, out);
    if (in.HasVertexColors(0)) {
      const std::string extension = LowerExtension(file_);
      const bool coded = extension != ".gltf" && extension != ".glb";
      const auto linear_of = [&](float c) { return coded ? static_cast<float>(SrgbToLinear(c)) : c; };
      for (unsigned i = 0; i < in.mNumVertices; ++i) {
        const aiColor4D& c = in.mColors[0][i];
        out.colors.emplace_back(linear_of(c.r), linear_of(c.g), linear_of(c.b));
        if (!(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b))) {
          return Problem(label + "the colour of vertex " + std::to_string(i) + " is not finite");
        }
      }
    }
    for (unsigned i = 0; i < in.mNumFaces; ++i) {
      const aiFace& face = in.mFaces[i];
      if (face.mNumIndices != 3) continue;
      const glm::uvec3 t(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
      if (std::max({t.x, t.y, t.z}) >= in.mNumVertices) {
        return Problem(label + "triangle " + std::to_string(i) + " names a vertex that does not exist");
      }
      out.triangles.push_back(t);
    }
    if (out.triangles.empty()) return;
    const int uv_channel = AppendMaterial(in.mMaterialIndex, out);
    AppendUvs(in, uv_channel, label, out);
    scene_.meshes.push_back(std::move(out));
  }

  void AppendNormals(const aiMesh& in, const glm::dmat3& transform, const std::string& label, Mesh& out) {
    if (!in.HasNormals()) return;
    for (unsigned i = 0; i < in.mNumVertices; ++i) {
      const aiVector3D& v = in.mNormals[i];
      const glm::dvec3 n = transform * glm::dvec3(v.x, v.y, v.z);
      const double length = glm::length(n);
      if (!(length > 0) || !std::isfinite(length)) {
        scene_.warnings.push_back(file_.string() + ": " + label + "the normal of vertex " + std::to_string(i) + " is " +
                                  ToText(v) + "; flat normals are used");
        out.normals.clear();
        return;
      }
      out.normals.emplace_back(n / length);
    }
  }

  void AppendUvs(const aiMesh& in, int channel, const std::string& label, Mesh& out) {
    Material& material = scene_.materials[static_cast<std::size_t>(out.material)];
    if (material.texture < 0) return;
    if (!in.HasTextureCoords(static_cast<unsigned>(channel))) {
      const std::string& texture = scene_.textures[static_cast<std::size_t>(material.texture)].name();
      scene_.warnings.push_back(file_.string() + ": " + label + "no texture coordinates for texture " + texture +
                                "; the base colour is used");
      Material plain = material;
      plain.texture = -1;
      out.material = static_cast<int>(scene_.materials.size());
      scene_.materials.push_back(std::move(plain));
      return;
    }
    for (unsigned i = 0; i < in.mNumVertices; ++i) {
      const aiVector3D& uv = in.mTextureCoords[channel][i];
      if (!IsFinite(uv)) {
        return Problem(label + "the texture coordinate of vertex " + std::to_string(i) +
                       " is not finite: " + ToText(uv));
      }
      out.uvs.emplace_back(uv.x, 1.0f - uv.y);  // assimp has v up in all formats
    }
  }

  // Sets out.material; returns the channel of texture coordinates that its texture wants.
  int AppendMaterial(unsigned index, Mesh& out) {
    const aiMaterial& in = *ai_->mMaterials[index];
    const aiTextureType type =
        in.GetTextureCount(aiTextureType_BASE_COLOR) > 0 ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE;
    int channel = 0;
    in.Get(AI_MATKEY_UVWSRC(type, 0), channel);

    int& known = material_of_[index];
    if (known < 0) {
      Material material;
      material.name = in.GetName().C_Str();
      aiColor3D color(1, 1, 1);
      if (in.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) in.Get(AI_MATKEY_COLOR_DIFFUSE, color);
      aiColor3D emission(0, 0, 0);
      in.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
      for (const float c : {color.r, color.g, color.b, emission.r, emission.g, emission.b}) {
        if (!std::isfinite(c) || c < 0) {
          Problem("material '" + material.name + "': a colour is negative or not finite: " + std::to_string(c));
          break;
        }
      }
      material.base_color = {color.r, color.g, color.b};
      material.emission = {emission.r, emission.g, emission.b};
      aiString path;
      if (in.Get(AI_MATKEY_TEXTURE(type, 0), path) == AI_SUCCESS && path.length > 0) {
        material.texture = TextureIndex(path.C_Str(), material.name);
        aiUVTransform transform;
        if (in.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == AI_SUCCESS) {
          scene_.warnings.push_back(file_.string() + ": material '" + material.name + "': the transform of texture " +
                                    path.C_Str() + " is not applied");
        }
      }
      known = static_cast<int>(scene_.materials.size());
      scene_.materials.push_back(std::move(material));
    }
    out.material = known;
    return channel;
  }

  int TextureIndex(const std::string& name, const std::string& material) {
    std::string text = name;
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path path = fs::path(text).lexically_normal();
    const aiTexture* embedded = ai_->GetEmbeddedTexture(name.c_str());
    const fs::path file = embedded != nullptr ? file_ / name : (file_.parent_path() / path).lexically_normal();
    const auto [entry, is_new] = textures_.try_emplace(file.string(), -1);
    if (!is_new) return entry->second;  // a bad one has been reported
    const auto bad = [&](const std::string& what) {
      problems_.push_back(file.string() + ": texture of material '" + material + "' in " + file_.string() + ": " +
                          what);
      return -1;
    };
    try {
      DecodedImage image;
      if (embedded != nullptr) {
        image = DecodeEmbedded(*embedded);
      } else {
        const bool has_drive = text.size() > 1 && text[1] == ':';
        if (path.is_absolute() || has_drive || (!path.empty() && *path.begin() == "..")) {
          entry->second = -1;
          problems_.push_back(file_.string() + ": material '" + material + "': the texture path '" + name +
                              "' must be relative and stay inside the mesh file's folder");
          return -1;
        }
        if (!fs::exists(file)) return bad("no such file");
        std::ifstream stream(file, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
        if (!stream.is_open() || stream.bad()) return bad("cannot be opened");
        image = DecodeImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      }
      scene_.textures.emplace_back(file.string(), image.width, image.height, image.rgb);
    } catch (const std::exception& error) {
      return bad(error.what());
    }
    return entry->second = static_cast<int>(scene_.textures.size()) - 1;
  }

  static DecodedImage DecodeEmbedded(const aiTexture& texture) {
    if (texture.mHeight == 0) {  // a file of mWidth bytes
      return DecodeImage({reinterpret_cast<const std::uint8_t*>(texture.pcData), texture.mWidth});
    }
    DecodedImage image{static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), {}};
    for (std::size_t i = 0; i < std::size_t{texture.mWidth} * texture.mHeight; ++i) {
      const aiTexel& texel = texture.pcData[i];
      image.rgb.insert(image.rgb.end(), {texel.r, texel.g, texel.b});
    }
    return image;
  }

  fs::path file_;
  glm::dmat4 world_from_file_{1.0};
  const aiScene* ai_ = nullptr;
  std::vector<int> material_of_;  // scene's index of each of the file's materials; -1: not used yet
  Scene& scene_;
  TextureCache& textures_;
  std::vector<std::string>& problems_;
};

}  // namespace

void AppendMeshFile(const MeshDescription& description, Scene& scene, TextureCache& textures,
                    std::vector<std::string>& problems) {
  FileReader(description, scene, textures, problems).Read();
}

}  // namespace sim
