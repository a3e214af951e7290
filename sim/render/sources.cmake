target_sources(vobench_sim PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/ray_tracer.cpp)
