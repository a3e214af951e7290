target_sources(vobench_sim PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/gl_context.cpp
  ${CMAKE_CURRENT_LIST_DIR}/gl_objects.cpp
  ${CMAKE_CURRENT_LIST_DIR}/packet_avx2.cpp
  ${CMAKE_CURRENT_LIST_DIR}/packet_avx512.cpp
  ${CMAKE_CURRENT_LIST_DIR}/packet_base.cpp
  ${CMAKE_CURRENT_LIST_DIR}/packet_kernel.cpp
  ${CMAKE_CURRENT_LIST_DIR}/placed_objects.cpp
  ${CMAKE_CURRENT_LIST_DIR}/raster_light.cpp
  ${CMAKE_CURRENT_LIST_DIR}/raster_scene.cpp
  ${CMAKE_CURRENT_LIST_DIR}/raster_view.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rasteriser.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ray_scene.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ray_scene_tables.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ray_tracer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/sample_pattern.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene_surroundings.cpp
  ${CMAKE_CURRENT_LIST_DIR}/surface_tracer.cpp)
# The inner loop, once per instruction set; PacketKernel() picks at run time. The two maths flags change no result that we
# use: they say that nobody reads errno or the floating-point exception flags, without which sqrt cannot be vector code.
set(packet_flags -O3 -fno-math-errno -fno-trapping-math)
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/packet_base.cpp PROPERTIES COMPILE_OPTIONS "${packet_flags}")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/packet_avx2.cpp PROPERTIES
    COMPILE_OPTIONS "${packet_flags};-mavx2;-mfma")
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/packet_avx512.cpp PROPERTIES
    COMPILE_OPTIONS "${packet_flags};-mavx2;-mfma;-mavx512f;-mavx512dq;-mavx512bw;-mavx512vl;-mprefer-vector-width=512")
endif()
# The rasteriser opens libEGL and libOSMesa when it is made: only their headers are needed here.
target_link_libraries(vobench_sim PRIVATE ${CMAKE_DL_LIBS})
