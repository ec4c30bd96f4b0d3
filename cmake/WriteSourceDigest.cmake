# Run at build time: writes OUTPUT from INPUT with a hash of the files listed in LIST (one a line); unchanged text leaves
# the file alone.
file(STRINGS ${LIST} files)
set(hashes "")
foreach(file IN LISTS files)
  file(SHA256 ${file} hash)
  get_filename_component(name ${file} NAME)
  string(APPEND hashes "${name} ${hash}\n")
endforeach()
string(SHA256 HWSIM_SOURCE_DIGEST "${hashes}")
string(SUBSTRING ${HWSIM_SOURCE_DIGEST} 0 32 HWSIM_SOURCE_DIGEST)
configure_file(${INPUT} ${OUTPUT} @ONLY)
