# Writes OUTPUT, web.cpp.in with STYLE and, where it is given, SCRIPT put in as they are.
file(READ "${STYLE}" style)
set(script "")
if(SCRIPT)
  file(READ "${SCRIPT}" script)
endif()
configure_file("${CMAKE_CURRENT_LIST_DIR}/web.cpp.in" "${OUTPUT}" @ONLY)
