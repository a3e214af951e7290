target_sources(vobench_sim PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/bake.cpp
  ${CMAKE_CURRENT_LIST_DIR}/cache.cpp
  ${CMAKE_CURRENT_LIST_DIR}/path_tracer.cpp)
