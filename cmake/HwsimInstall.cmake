# `cmake --install`: the program, its image module, configs and manual pages; and the library, for find_package(hwsim) and
# pkg-config. HwsimPackage.cmake makes a Debian package of each of the two components.
# Headers lie in include/hwsim, so that "pipeline/" and "algos/" do not become names of the whole system.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(hwsim_include_dir ${CMAKE_INSTALL_INCLUDEDIR}/hwsim)
set(hwsim_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hwsim)

# The image module is opened by name: who links the library finds it where that is installed.
target_link_options(hwsim_pipeline INTERFACE
  "$<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CMAKE_INSTALL_LIBDIR}>")
# What the headers were compiled with.
target_compile_definitions(hwsim_pipeline INTERFACE
  $<INSTALL_INTERFACE:GLM_FORCE_DEPTH_ZERO_TO_ONE> $<INSTALL_INTERFACE:GLM_FORCE_RADIANS>
  $<INSTALL_INTERFACE:GLM_FORCE_XYZW_ONLY>)

install(TARGETS hwsim_hwsim hwsim_pipeline hwsim_algos hwsim_cost_models hwsim_lab EXPORT hwsimTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(TARGETS hwsim_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(TARGETS hwsim_image_io LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/hwsim.h DESTINATION ${hwsim_include_dir} COMPONENT development)
# A line is a header, or a folder with a slash behind it.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/public_headers.txt public_headers REGEX "^[a-z]")
foreach(header IN LISTS public_headers)
  if(header MATCHES "/$")
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${hwsim_include_dir}/${header}
            COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE)
  else()
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${hwsim_include_dir}/${folder} COMPONENT development)
  endif()
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/hwsim COMPONENT runtime)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)  # values' sources name its pages
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

install(EXPORT hwsimTargets NAMESPACE hwsim:: DESTINATION ${hwsim_package_dir} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/hwsimConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/hwsimConfig.cmake INSTALL_DESTINATION ${hwsim_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/hwsimConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hwsimConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/hwsimConfigVersion.cmake
        DESTINATION ${hwsim_package_dir} COMPONENT development)

file(RELATIVE_PATH hwsim_prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_CURRENT_LIST_DIR}/hwsim.pc.in ${CMAKE_CURRENT_BINARY_DIR}/hwsim.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hwsim.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
include(HwsimManual)
include(HwsimPackage)
