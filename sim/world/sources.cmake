target_sources(vobench_sim PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/gltf_draco.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf_file.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gltf_reader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/image_file.cpp
  ${CMAKE_CURRENT_LIST_DIR}/light.cpp
  ${CMAKE_CURRENT_LIST_DIR}/material_library.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_builder.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_import.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_loader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_material.cpp
  ${CMAKE_CURRENT_LIST_DIR}/mesh_serialization.cpp
  ${CMAKE_CURRENT_LIST_DIR}/obj_reader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ply_reader.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene.cpp
  ${CMAKE_CURRENT_LIST_DIR}/sky.cpp
  ${CMAKE_CURRENT_LIST_DIR}/texture.cpp
  ${CMAKE_CURRENT_LIST_DIR}/texture_file.cpp)
