# Writes OUTPUT, a header with a digest of the content of all FILES: another simulator is another word.
set(text "")
foreach(file IN LISTS FILES)
  file(SHA256 "${file}" digest)
  string(APPEND text "${digest}")
endforeach()
string(SHA256 digest "${text}")
file(WRITE "${OUTPUT}" "#define VOBENCH_SIMULATOR_DIGEST \"${digest}\"\n")
