# vobench_public_library(vobench_NAME [HEADERS file...]): a library that others may link as vobench::NAME, from this build or installed.
# Its folder's headers, or those named and the project's headers that they include, go to include/vobench under their usual path, so that
# #include "vo/odometry.h" is right in both.
# Compiled for any address: the Python module is made of it.
function(vobench_public_library target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS")
  string(REPLACE "vobench_" "" name ${target})
  add_library(vobench::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/vobench>)

  # An export of its own for each: whoever wants the judge needs no Embree.
  install(TARGETS ${target} EXPORT vobench-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT vobench-${name} NAMESPACE vobench:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vobench COMPONENT development)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set(destination ${CMAKE_INSTALL_INCLUDEDIR}/vobench)
  if(NOT arg_HEADERS)
    install(DIRECTORY ./ DESTINATION ${destination}/${folder} COMPONENT development FILES_MATCHING PATTERN "*.h")
  endif()
  list(TRANSFORM arg_HEADERS PREPEND ${folder}/)
  set(public "")
  while(arg_HEADERS)
    list(POP_FRONT arg_HEADERS header)
    if(NOT header IN_LIST public)
      list(APPEND public ${header})
      file(STRINGS ${PROJECT_SOURCE_DIR}/${header} included REGEX "^#include \"")
      list(TRANSFORM included REPLACE "^#include \"([^\"]+)\".*" "\\1")
      list(APPEND arg_HEADERS ${included})
      cmake_path(GET header PARENT_PATH inside)
      install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${destination}/${inside} COMPONENT development)
    endif()
  endwhile()
endfunction()

# vobench_embed(HEADER NAMESPACE NAME=FILE...): HEADER, below the build's folder `embedded` and this folder's path in the project, has
# the text of each file as the constant kNAME.
function(vobench_embed header namespace)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set(text "// Made by the build; do not edit.\n#pragma once\n\nnamespace ${namespace} {\n")
  foreach(pair IN LISTS ARGN)
    string(REGEX MATCH "^([^=]+)=(.+)$" _ ${pair})
    file(READ ${CMAKE_MATCH_2} content)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_MATCH_2})
    string(APPEND text "inline constexpr char k${CMAKE_MATCH_1}[] = R\"embedded(${content})embedded\";\n")
  endforeach()
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/embedded/${folder}/${header} CONTENT "${text}}  // namespace ${namespace}\n")
endfunction()
