# `cmake --install`: the program, its image module and configs, and a package for find_package(hwsim).
# Headers lie in include/hwsim, so that "pipeline/" and "algos/" do not become names of the whole system.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(hwsim_include_dir ${CMAKE_INSTALL_INCLUDEDIR}/hwsim)
set(hwsim_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hwsim)

# What the headers were compiled with.
target_compile_definitions(hwsim_pipeline INTERFACE
  $<INSTALL_INTERFACE:GLM_FORCE_DEPTH_ZERO_TO_ONE> $<INSTALL_INTERFACE:GLM_FORCE_RADIANS>
  $<INSTALL_INTERFACE:GLM_FORCE_XYZW_ONLY>)

install(TARGETS hwsim_hwsim hwsim_pipeline hwsim_algos hwsim_cost_models hwsim_lab EXPORT hwsimTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS hwsim_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS hwsim_image_io LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
# A line is a header, or a folder with a slash behind it.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/public_headers.txt public_headers REGEX "^[a-z]")
foreach(header IN LISTS public_headers)
  if(header MATCHES "/$")
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${hwsim_include_dir}/${header}
            FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE)
  else()
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${hwsim_include_dir}/${folder})
  endif()
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/hwsim)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR})  # values' sources name its pages

install(EXPORT hwsimTargets NAMESPACE hwsim:: DESTINATION ${hwsim_package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/hwsimConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/hwsimConfig.cmake INSTALL_DESTINATION ${hwsim_package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/hwsimConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hwsimConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/hwsimConfigVersion.cmake
        DESTINATION ${hwsim_package_dir})
