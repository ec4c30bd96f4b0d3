# Run at build time: writes OUTPUT from INPUT with a hash of COMPILER and of the files below FOLDER that LIST names (one a
# line); unchanged text leaves the file alone.
file(STRINGS ${LIST} files)
set(hashes "${COMPILER}\n")
foreach(file IN LISTS files)
  file(SHA256 ${FOLDER}/${file} hash)
  string(APPEND hashes "${file} ${hash}\n")
endforeach()
string(SHA256 DIGEST "${hashes}")
string(SUBSTRING ${DIGEST} 0 32 DIGEST)
configure_file(${INPUT} ${OUTPUT} @ONLY)
