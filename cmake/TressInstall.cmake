# `cmake --install` and `find_package(tress)`. Headers keep their paths below include/tress,
# so that #include "contract/system.h" reads the same inside and outside this repository.
# Nothing installed names a folder of the build: the libraries that static linking needs are
# found again by tressConfig.cmake, and Eigen is used in our .cpp files only.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(tress_rooms math contract linear models integrators)
if(TARGET tress_simulation)
  list(APPEND tress_rooms simulation)
endif()
list(TRANSFORM tress_rooms PREPEND tress_ OUTPUT_VARIABLE tress_libraries)
if(TARGET tress_simulation)
  list(APPEND tress_libraries tress_plugin)
  install(FILES ${PROJECT_BINARY_DIR}/generated/simulation/plugin/interface_facts.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tress/simulation/plugin)
endif()
install(TARGETS ${tress_libraries} EXPORT tressTargets)
install(DIRECTORY ${tress_rooms} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tress
        FILES_MATCHING PATTERN "*.h")

set(tress_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tress)
install(EXPORT tressTargets NAMESPACE tress:: DESTINATION ${tress_config_dir})
configure_package_config_file(cmake/tressConfig.cmake.in ${PROJECT_BINARY_DIR}/tressConfig.cmake
  INSTALL_DESTINATION ${tress_config_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tressConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tressConfig.cmake
              ${PROJECT_BINARY_DIR}/tressConfigVersion.cmake
              cmake/FindKLU.cmake cmake/FindHDF5C.cmake
        DESTINATION ${tress_config_dir})
