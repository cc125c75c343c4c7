# TRESS_SUNDIALS_SOURCE: a folder with the sources of SUNDIALS, which are built in Release when
# CMake configures for the first time. For systems without the script cmake/sundials.sh, which
# needs Debian's package sources.
set(TRESS_SUNDIALS_SOURCE "" CACHE PATH "Sources of SUNDIALS, to build where TRESS_SUNDIALS_ROOT is empty")
if(TRESS_SUNDIALS_SOURCE AND NOT TRESS_SUNDIALS_ROOT)
  set(built ${PROJECT_BINARY_DIR}/sundials)
  if(NOT EXISTS ${built}/lib/cmake/sundials/SUNDIALSConfig.cmake)
    message(STATUS "Building SUNDIALS from ${TRESS_SUNDIALS_SOURCE}")
    get_filename_component(klu_folder ${KLU_LIBRARY} DIRECTORY)
    # As in cmake/sundials.sh.
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${TRESS_SUNDIALS_SOURCE} -B ${PROJECT_BINARY_DIR}/sundials_build
      -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON
      -DCMAKE_INSTALL_PREFIX=${built} -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_STATIC_LIBS=ON
      -DBUILD_SHARED_LIBS=OFF -DEXAMPLES_ENABLE_C=OFF -DEXAMPLES_ENABLE_CXX=OFF
      -DEXAMPLES_INSTALL=OFF -DENABLE_KLU=ON -DKLU_INCLUDE_DIR=${KLU_INCLUDE_DIR}
      -DKLU_LIBRARY_DIR=${klu_folder} -DSUNDIALS_INDEX_SIZE=64
      OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${PROJECT_BINARY_DIR}/sundials_build --target install --parallel
      OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  endif()
  set(TRESS_SUNDIALS_ROOT ${built} CACHE PATH "Release build of SUNDIALS" FORCE)
endif()
