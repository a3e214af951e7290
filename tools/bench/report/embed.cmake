# Writes OUTPUT: web.cpp.in with the files of WEB, a style and scripts, put in as they are.
list(POP_FRONT WEB style_file)
file(READ "${style_file}" style)
set(script "")
foreach(file IN LISTS WEB)
  file(READ "${file}" part)
  string(APPEND script "${part}\n")
endforeach()
configure_file("${CMAKE_CURRENT_LIST_DIR}/web.cpp.in" "${OUTPUT}" @ONLY)
