#include "sim/world/gltf_draco.h"

#include <draco/compression/decode.h>

#include <array>
#include <memory>
#include <stdexcept>

namespace sim {

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
