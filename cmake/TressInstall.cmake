# `cmake --install` and `find_package(tress)`. Headers keep their paths below include/tress,
# so that #include "contract/system.h" reads the same inside and outside this repository.
# Nothing installed names a folder of the build: the libraries that static linking needs are
# found again by tressConfig.cmake, and Eigen is used in our .cpp files only. Components:
# development (libraries, headers, CMake files) and programs (the command tress, programs,
# scenes, the page).
include(CMakePackageConfigHelpers)

set(tress_rooms math contract linear models integrators)
if(TARGET tress_simulation)
  list(APPEND tress_rooms simulation)
endif()
list(TRANSFORM tress_rooms PREPEND tress_ OUTPUT_VARIABLE tress_libraries)
if(TARGET tress_simulation)
  list(APPEND tress_libraries tress_plugin)
  install(FILES ${PROJECT_BINARY_DIR}/generated/simulation/plugin/interface_facts.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tress/simulation/plugin COMPONENT development)
endif()
install(TARGETS ${tress_libraries} EXPORT tressTargets COMPONENT development)
install(DIRECTORY ${tress_rooms} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tress
        COMPONENT development FILES_MATCHING PATTERN "*.h")

install(FILES ${PROJECT_BINARY_DIR}/generated/models/head/long_packs.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tress/models/head COMPONENT development)

set(tress_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tress)
# A package has its copy of SUNDIALS in Release, for Debian's is compiled at -O0.
set(own_sundials OFF)
if(TRESS_SUNDIALS_SOURCE)
  set(own_sundials ON)
endif()
option(TRESS_INSTALL_SUNDIALS "Install the static libraries of TRESS_SUNDIALS_ROOT as well"
       ${own_sundials})
if(TRESS_INSTALL_SUNDIALS AND TRESS_SUNDIALS_ROOT)
  set(tress_sundials_dir ${CMAKE_INSTALL_LIBDIR}/tress/sundials)
  install(DIRECTORY ${TRESS_SUNDIALS_ROOT}/ DESTINATION ${tress_sundials_dir}
          COMPONENT development)
  set(tress_sundials_hint "\${PACKAGE_PREFIX_DIR}/${tress_sundials_dir}")
else()
  set(tress_sundials_hint "${TRESS_SUNDIALS_ROOT}")
endif()
install(EXPORT tressTargets NAMESPACE tress:: DESTINATION ${tress_config_dir}
        COMPONENT development)
configure_package_config_file(cmake/tressConfig.cmake.in ${PROJECT_BINARY_DIR}/tressConfig.cmake
  INSTALL_DESTINATION ${tress_config_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tressConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tressConfig.cmake
              ${PROJECT_BINARY_DIR}/tressConfigVersion.cmake
              cmake/FindKLU.cmake cmake/FindHDF5C.cmake
        DESTINATION ${tress_config_dir} COMPONENT development)

# The command `tress`: share/tress has the files of a clone that commands and programs read,
# at the same paths (contract/shipped_file.h, python/tress_command/place.py).
if(TRESS_EXPERIMENTS)
  set(tress_share ${CMAKE_INSTALL_DATADIR}/tress)
  file(RELATIVE_PATH tress_programs /${tress_share} /${CMAKE_INSTALL_LIBEXECDIR}/tress)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/installed.json CONTENT
       "{\"version\": \"${PROJECT_VERSION}\", \"programs\": \"${tress_programs}\"}\n")
  file(RELATIVE_PATH tress_command /${CMAKE_INSTALL_BINDIR}
       /${tress_share}/python/tress_command)
  configure_file(cmake/installed_tress.in ${PROJECT_BINARY_DIR}/installed/tress @ONLY)
  install(PROGRAMS ${PROJECT_BINARY_DIR}/installed/tress
          DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  install(FILES ${PROJECT_BINARY_DIR}/installed.json DESTINATION ${tress_share}
          COMPONENT programs)
  install(FILES ${PROJECT_BINARY_DIR}/experiments/list.txt
                ${PROJECT_BINARY_DIR}/experiments/left_out.txt
          DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/tress COMPONENT programs)
  install(FILES contract/renamed.h DESTINATION ${tress_share}/contract COMPONENT programs)
  install(DIRECTORY scenes DESTINATION ${tress_share} COMPONENT programs)
  install(DIRECTORY experiments/calibrate/data DESTINATION ${tress_share}/experiments/calibrate
          COMPONENT programs FILES_MATCHING PATTERN "*.csv")
  install(DIRECTORY experiments/report/dist DESTINATION ${tress_share}/experiments/report
          COMPONENT programs)
  install(FILES experiments/report/answers.mjs experiments/report/plain_page.mjs
          DESTINATION ${tress_share}/experiments/report COMPONENT programs)
  set(tress_answers csv format input pace tables)  # modules of answers.mjs
  list(TRANSFORM tress_answers REPLACE "(.+)" "experiments/report/src/\\1.mjs")
  install(FILES ${tress_answers} DESTINATION ${tress_share}/experiments/report/src
          COMPONENT programs)
  install(DIRECTORY python/tress_command DESTINATION ${tress_share}/python COMPONENT programs
          FILES_MATCHING PATTERN "*.py")
endif()
