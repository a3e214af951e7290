# Fetches what package-lock.json names (npm ci) and bundles src/ into report.js; sets `script`. In the build folder: the sources
# stay as they are. Where there are tests, their tools come along.
set(without "To build without interactive diagrams: cmake -DVOBENCH_REPORT_SCRIPTS=OFF.")
find_program(NODE_PROGRAM NAMES node nodejs)
find_program(NPM_PROGRAM npm)
if(NOT NODE_PROGRAM OR NOT NPM_PROGRAM)
  message(FATAL_ERROR "The report's diagrams need Node.js 18 or later and npm, which are not on PATH. ${without}")
endif()
execute_process(COMMAND "${NODE_PROGRAM}" --version OUTPUT_VARIABLE node_version OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REGEX REPLACE "^v" "" node_version "${node_version}")
if(node_version VERSION_LESS 18)
  message(FATAL_ERROR "The report's diagrams need Node.js 18 or later, and ${NODE_PROGRAM} is ${node_version}. ${without}")
endif()

set(web "${CMAKE_CURRENT_BINARY_DIR}/web")
set(script "${CMAKE_CURRENT_BINARY_DIR}/report.js")
file(GLOB web_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/web/src/*.ts")
set(web_lists package.json package-lock.json .npmrc)
list(TRANSFORM web_lists PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/web/")
set(development --omit=dev)
if(VOBENCH_TESTS)
  set(development --include=dev)
endif()
add_custom_command(
  OUTPUT "${web}/installed"
  COMMAND ${CMAKE_COMMAND} -DNPM=${NPM_PROGRAM} "-DLISTS=${web_lists}" -DFOLDER=${web} -DDEVELOPMENT=${development}
          -P "${CMAKE_CURRENT_SOURCE_DIR}/web/install.cmake"
  DEPENDS ${web_lists} web/install.cmake
  COMMENT "Fetching the report's libraries (npm ci)"
  VERBATIM)
add_custom_command(
  OUTPUT "${script}"
  COMMAND ${CMAKE_COMMAND} -E rm -rf "${web}/src"
  COMMAND ${CMAKE_COMMAND} -E copy_directory "${CMAKE_CURRENT_SOURCE_DIR}/web/src" "${web}/src"
  COMMAND ${CMAKE_COMMAND} -E copy "${CMAKE_CURRENT_SOURCE_DIR}/web/build.mjs" "${CMAKE_CURRENT_SOURCE_DIR}/web/tsconfig.json" "${web}"
  COMMAND ${CMAKE_COMMAND} -E chdir "${web}" "${NODE_PROGRAM}" build.mjs "${script}"
  DEPENDS "${web}/installed" ${web_sources} web/build.mjs web/tsconfig.json
  COMMENT "Bundling the report's script"
  VERBATIM)
