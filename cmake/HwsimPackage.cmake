# `cpack --preset` or `cpack -G DEB` in the build folder: hwsim.deb, the program and its Python package, and hwsim-dev.deb,
# the library. Debian's own tools find out which packages the built files depend on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hwsim)
set(CPACK_PACKAGE_VENDOR "The hwsim authors")
set(CPACK_PACKAGE_CONTACT "The hwsim authors <hwsim@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME hwsim)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME hwsim-dev)
# What find_package(hwsim) and hwsim.pc look for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "hwsim (= ${PROJECT_VERSION}), libglm-dev, libhwy-dev, libtinygltf-dev, libtbb-dev, libembree-dev, nlohmann-json3-dev, libtomlplusplus-dev, libceres-dev, libfmt-dev, libsqlite3-dev, libnlopt-dev, libturbojpeg0-dev, zlib1g-dev")
if(HWSIM_PYTHON)
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "python3, python3-numpy")
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "python3-pandas, python3-tqdm")
endif()
include(CPack)
